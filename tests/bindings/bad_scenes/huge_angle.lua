-- expect: huge_angle.lua:4: object.rpy_deg: expected a number from -3600 to 3600 deg, got 1e+300
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, rpy_deg = {0, 0, 1e300} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
