-- expect: no_mass.lua:4: object.mass: expected a number from 1e-06 to 1e+06 kg, got none
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
