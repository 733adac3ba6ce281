-- The book pulled straight out by its top.
local poses = {}
for i, d in ipairs { 0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08 } do
  poses[i] = { p = { -0.0875 + d, 0, 0.115 }, press = { finger = "index", p_OC = { 0.050, 0, 0.115 } } }
end
return ladder { scene = "scenes/book.lua", poses = poses }
