-- expect: unknown_key_of_environment.lua:5: environment[1]: unknown key "pos" (the keys are name, shape, p, rpy_deg, mass, friction, com, inertia)
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { shape = box{1, 1, 0.02}, pos = {0, 0, -0.01} } },
}
