-- The middle one of three half-full cartons of water that stand side by side in a shelf: 2 mm of air on each
-- side and behind.
local function carton(name, y)
  return { name = name, shape = box{0.070, 0.070, 0.200}, mass = 0.53, friction = 0.3, p = {-0.045, y, 0.100} }
end

return scene {
  name = "water",
  object = carton("carton", 0),
  environment = {
    -- The shelf's front edge is x = 0, its top z = 0.
    { name = "shelf", shape = box{0.100, 0.350, 0.015}, friction = 0.3, p = {-0.050, 0, -0.0075} },
    { name = "back", shape = box{0.015, 0.350, 0.260}, friction = 0.3, p = {-0.0895, 0, 0.115} },
    carton("left_carton", -0.072),
    carton("right_carton", 0.072),
    { name = "left", shape = box{0.082, 0.015, 0.150}, friction = 0.3, p = {-0.041, -0.1165, 0.075} },
    { name = "right", shape = box{0.082, 0.015, 0.150}, friction = 0.3, p = {-0.041, 0.1165, 0.075} },
  },
}
