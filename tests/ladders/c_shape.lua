-- The C dragged over the edge.
local poses = {}
for i, d in ipairs { 0, 0.008, 0.016, 0.024, 0.032, 0.040, 0.050, 0.060 } do
  poses[i] = { p = { -0.0524 + d, 0, 0 }, press = { finger = "index", p_OC = { -0.046, 0, 0.003 } } }
end
return ladder { scene = "scenes/c_shape.lua", poses = poses }
