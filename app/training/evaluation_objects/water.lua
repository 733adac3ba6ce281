-- Stands for the object of the scene "water" until that scene is here.
return scene {
  name = "water",
  object = { shape = box{0.070, 0.070, 0.200}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
