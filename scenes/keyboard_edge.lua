-- A computer keyboard lies near the edge of a shelf, its front 1 cm inboard, a wall 1 cm behind it. Flat on
-- the shelf, longer than a hand spans, and too near the wall for a finger behind it.
local parts = { { shape = box{0.130, 0.440, 0.0185}, p = {0, 0, -0.00075} } }
for row = 0, 5 do  -- rows of keys, 1.5 mm high: too low to pinch by
  local x = -0.049 + 0.0195 * row
  for _, block in ipairs { { -0.074, 0.276 }, { 0.0955, 0.056 }, { 0.170, 0.076 } } do
    parts[#parts + 1] = { shape = box{0.0165, block[2], 0.0015}, p = {x, block[1], 0.00925} }
  end
end

return scene {
  name = "keyboard_edge",
  object = { name = "keyboard", shape = union(parts), mass = 0.7, friction = 0.4, p = {-0.075, 0, 0.010} },
  environment = {
    -- The shelf's front edge is x = 0, its top z = 0.
    { name = "shelf", shape = box{0.150, 0.900, 0.020}, friction = 0.3, p = {-0.075, 0, -0.010} },
    { name = "wall", shape = box{0.020, 0.900, 0.300}, friction = 0.3, p = {-0.160, 0, 0.130} },
  },
}
