-- The ruler dragged over the edge.
local poses = {}
for i, d in ipairs { 0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07 } do
  poses[i] = { p = { -0.160 + d, 0, 0.0015 }, press = { finger = "index", p_OC = { 0.110, 0, 0.0015 } } }
end
return ladder { scene = "scenes/ruler.lua", poses = poses }
