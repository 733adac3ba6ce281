-- expect: cloud_without_points.lua:4: object.shape: expected a cloud with points, got "empty.ply", which has none
return scene {
  name = "bad",
  object = { shape = cloud{"empty.ply"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
