-- The carton pulled out by its top.
local poses = {}
for i, d in ipairs { 0, 0.005, 0.010, 0.015, 0.020, 0.025, 0.030, 0.036 } do
  poses[i] = { p = { -0.045 + d, 0, 0.100 }, press = { finger = "index", p_OC = { 0.020, 0, 0.100 } } }
end
return ladder { scene = "scenes/water.lua", poses = poses }
