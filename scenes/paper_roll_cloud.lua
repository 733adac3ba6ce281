-- The roll of paper_roll.lua, known only by points of its surface, as from a scanner.
return scene {
  name = "paper_roll_cloud",
  object = {
    name = "roll", shape = cloud{"assets/objects/paper_roll.ply"}, mass = 0.06, friction = 0.3, p = {-0.030, 0, 0},
  },
  environment = {
    -- The front edge is x = 0, the floor z = 0.
    { name = "floor", shape = box{0.061, 0.200, 0.010}, friction = 0.3, p = {-0.0305, 0, -0.005} },
    { name = "back", shape = box{0.010, 0.200, 0.080}, friction = 0.3, p = {-0.056, 0, 0.030} },
    { name = "left", shape = box{0.051, 0.010, 0.070}, friction = 0.3, p = {-0.0255, -0.026, 0.035} },
    { name = "right", shape = box{0.051, 0.010, 0.070}, friction = 0.3, p = {-0.0255, 0.026, 0.035} },
  },
}
