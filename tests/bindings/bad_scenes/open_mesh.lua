-- expect: open_mesh.lua:4: object.shape: expected a closed mesh, got "open.obj"
return scene {
  name = "bad",
  object = { shape = mesh{"open.obj"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
