-- expect: huge_position.lua:4: object.p: expected a number from -1000 to 1000 m, got 1e+18
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 1e18} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
