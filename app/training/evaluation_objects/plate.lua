-- Stands for the object of the scene "plate" until that scene is here.
return scene {
  name = "plate",
  object = { shape = cylinder{0.130, 0.025}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
