-- Stands for the object of the scene "spice" until that scene is here.
return scene {
  name = "spice",
  object = { shape = box{0.048, 0.048, 0.110}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
