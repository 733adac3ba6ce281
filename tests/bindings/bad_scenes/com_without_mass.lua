-- expect: com_without_mass.lua:5: environment[1].mass: expected a mass beside com, got nothing
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { shape = box{1, 1, 0.02}, com = {0, 0, 0}, p = {0, 0, -0.01} } },
}
