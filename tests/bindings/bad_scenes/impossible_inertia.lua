-- expect: impossible_inertia.lua:4: object.inertia: expected the inertia of a rigid body in kg m^2, got principal moments
return scene {
  name = "bad",
  object = { shape = sphere{0.05}, mass = 0.2, inertia = {1, 1, 5}, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
