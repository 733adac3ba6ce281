-- Stands for the object of the scene "marker" until that scene is here.
return scene {
  name = "marker",
  object = { shape = cylinder{0.009, 0.140}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
