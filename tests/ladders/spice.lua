-- The tin pulled out by its top.
local poses = {}
for i, d in ipairs { 0, 0.01, 0.02, 0.03 } do
  poses[i] = { p = { -0.034 + d, 0, 0.055 }, press = { finger = "index", p_OC = { 0.010, 0, 0.055 } } }
end
return ladder { scene = "scenes/spice.lua", poses = poses }
