-- expect: mesh_without_file.lua:4: mesh: file: expected a text, got nothing
return scene {
  name = "bad",
  object = { shape = mesh{scale = 2}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
