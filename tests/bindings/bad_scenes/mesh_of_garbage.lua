-- expect: mesh_of_garbage.lua:4: object.shape: expected
return scene {
  name = "bad",
  object = { shape = mesh{"garbage.stl"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
