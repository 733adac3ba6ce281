-- The tin pulled out by its top.
local poses = {}
for i, d in ipairs { 0, 0.004, 0.008, 0.013, 0.017, 0.021, 0.026, 0.030 } do
  poses[i] = { p = { -0.034 + d, 0, 0.055 }, press = { finger = "index", p_OC = { 0.010, 0, 0.055 } } }
end
return ladder { scene = "scenes/spice.lua", poses = poses }
