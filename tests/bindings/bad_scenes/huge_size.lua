-- expect: huge_size.lua:4: object.shape: expected a number from 1e-06 to 100 m, got 1e+300
return scene {
  name = "bad",
  object = { shape = box{1e300, 0.1, 0.1}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
