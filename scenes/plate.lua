-- A dinner plate on a table. Too wide to span; a fingertip fits under the rim, but a hand that would pinch
-- the rim finds no room above the table.
return scene {
  name = "plate",
  object = { name = "plate", shape = mesh{"assets/objects/plate.obj"}, mass = 0.28, friction = 0.3 },
  environment = {
    { name = "table", shape = box{0.800, 0.800, 0.040}, friction = 0.3, p = {0, 0, -0.020} },
  },
}
