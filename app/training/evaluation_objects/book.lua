-- Stands for the object of the scene "book" until that scene is here.
return scene {
  name = "book",
  object = { shape = box{0.155, 0.030, 0.230}, mass = 0.1, p = {0, 0, 1} },
  environment = { { name = "table", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
