-- expect: cloud_of_few.lua:4: object.shape: expected at least 100 points, got "few.ply", which has 20
return scene {
  name = "bad",
  object = { shape = cloud{"few.ply"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
