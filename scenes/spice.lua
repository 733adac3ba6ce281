-- The middle one of three spice tins in a rack that they fill: 2 mm of air on each side and behind. The
-- tins are square, so that no fingertip fits between them.
local function tin(name, y)
  return {
    name = name, mass = 0.14, friction = 0.3, p = {-0.034, y, 0.055},
    shape = box{0.048, 0.048, 0.110},  -- the lid is let in: fingers could close on the edge of one that stands out
  }
end

return scene {
  name = "spice",
  object = tin("tin", 0),
  environment = {
    -- The rack's front edge is x = 0, its floor z = 0.
    { name = "rack", shape = box{0.080, 0.300, 0.015}, friction = 0.3, p = {-0.040, 0, -0.0075} },
    { name = "back", shape = box{0.015, 0.300, 0.150}, friction = 0.3, p = {-0.0675, 0, 0.060} },
    tin("left_tin", -0.050),
    tin("right_tin", 0.050),
    { name = "left", shape = box{0.060, 0.015, 0.100}, friction = 0.3, p = {-0.030, -0.0835, 0.050} },
    { name = "right", shape = box{0.060, 0.015, 0.100}, friction = 0.3, p = {-0.030, 0.0835, 0.050} },
  },
}
