-- A computer keyboard lies deep in a shelf, with its back and both ends 1 cm from the walls: no finger fits
-- behind it, and its front edge is far from the shelf's. Pushed against the wall, it can be tipped up.
local parts = { { shape = box{0.130, 0.440, 0.0185}, p = {0, 0, -0.00075} } }
for row = 0, 5 do  -- rows of keys, 1.5 mm high: too low to pinch by
  local x = -0.049 + 0.0195 * row
  for _, block in ipairs { { -0.074, 0.276 }, { 0.0955, 0.056 }, { 0.170, 0.076 } } do
    parts[#parts + 1] = { shape = box{0.0165, block[2], 0.0015}, p = {x, block[1], 0.00925} }
  end
end

return scene {
  name = "keyboard_wall",
  object = { name = "keyboard", shape = union(parts), mass = 0.7, friction = 0.4, p = {-0.225, 0, 0.010} },
  environment = {
    -- The shelf's front edge is x = 0, its top z = 0.
    { name = "shelf", shape = box{0.300, 0.500, 0.020}, friction = 0.4, p = {-0.150, 0, -0.010} },
    { name = "back", shape = box{0.020, 0.500, 0.200}, friction = 0.3, p = {-0.310, 0, 0.080} },
    { name = "left", shape = box{0.300, 0.020, 0.180}, friction = 0.3, p = {-0.150, -0.240, 0.090} },
    { name = "right", shape = box{0.300, 0.020, 0.180}, friction = 0.3, p = {-0.150, 0.240, 0.090} },
  },
}
