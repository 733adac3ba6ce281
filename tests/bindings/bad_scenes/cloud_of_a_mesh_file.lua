-- expect: cloud_of_a_mesh_file.lua:4: object.shape: expected a cloud in a .ply file, got "open.obj"
return scene {
  name = "bad",
  object = { shape = cloud{"open.obj"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
