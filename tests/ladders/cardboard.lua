-- The cardboard dragged over the shelf's edge.
local poses = {}
for i, d in ipairs { 0, 0.02, 0.04, 0.05, 0.06, 0.07, 0.085, 0.10 } do
  poses[i] = { p = { -0.130 + d, 0, 0.0015 }, press = { finger = "index", p_OC = { 0.020, 0, 0.0015 } } }
end
return ladder { scene = "scenes/cardboard.lua", poses = poses }
