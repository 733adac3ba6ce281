-- The roll pulled out by its upper end.
local poses = {}
for i, d in ipairs { 0, 0.003, 0.006, 0.010, 0.014, 0.017, 0.020, 0.024 } do
  poses[i] = { p = { -0.030 + d, 0, 0 }, press = { finger = "index", p_OC = { 0.013, 0, 0.057 } } }
end
return ladder { scene = "scenes/paper_roll.lua", poses = poses }
