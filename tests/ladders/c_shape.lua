-- The C dragged over the edge.
local poses = {}
for i, d in ipairs { 0, 0.02, 0.04, 0.06 } do
  poses[i] = { p = { -0.0524 + d, 0, 0 }, press = { finger = "index", p_OC = { -0.046, 0, 0.003 } } }
end
return ladder { scene = "scenes/c_shape.lua", poses = poses }
