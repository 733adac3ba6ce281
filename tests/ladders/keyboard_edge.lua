-- The keyboard dragged over the shelf's edge.
local poses = {}
for i, d in ipairs { 0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07 } do
  poses[i] = { p = { -0.075 + d, 0, 0.010 }, press = { finger = "index", p_OC = { 0.0095, 0, 0.010 } } }
end
return ladder { scene = "scenes/keyboard_edge.lua", poses = poses }
