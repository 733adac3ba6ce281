-- expect: negative_size.lua:4: object.shape.r: expected a number from 1e-06 to 100 m, got -0.02
return scene {
  name = "bad",
  object = { shape = cylinder{-0.02, 0.1}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
