-- expect: mesh_outside.lua:4: shape "/etc/passwd": expected a file in the working directory, the script's folder or the assets, got one elsewhere
return scene {
  name = "bad",
  object = { shape = mesh{"/etc/passwd"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
