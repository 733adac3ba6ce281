-- expect: wrong_camera.lua:2: camera.look_at: expected three numbers {x, y, z}, got nothing
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
  camera = { p = {1, 1, 1} },
}
