-- Stands for the object of the scene "cardboard" until that scene is here.
return scene {
  name = "cardboard",
  object = { shape = box{0.200, 0.250, 0.003}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
