-- Stands for the object of the scene "keyboard" until that scene is here.
return scene {
  name = "keyboard",
  object = { shape = box{0.130, 0.440, 0.020}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
