-- expect: cloud_of_garbage.lua:4: object.shape: expected a PLY file, got "garbage.ply", which does not begin with "ply"
return scene {
  name = "bad",
  object = { shape = cloud{"garbage.ply"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
