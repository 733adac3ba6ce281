-- A sheet of cardboard lies flat on a shelf, a wall 5 mm behind it, its front 3 cm inboard of the edge.
return scene {
  name = "cardboard",
  object = {
    name = "cardboard", shape = box{0.200, 0.250, 0.003}, mass = 0.03, friction = 0.3, p = {-0.130, 0, 0.0015},
  },
  environment = {
    -- The shelf's front edge is x = 0, its top z = 0.
    { name = "shelf", shape = box{0.235, 0.700, 0.020}, friction = 0.3, p = {-0.1175, 0, -0.010} },
    { name = "wall", shape = box{0.020, 0.700, 0.250}, friction = 0.3, p = {-0.245, 0, 0.105} },
  },
}
