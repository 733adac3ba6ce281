-- The book tipped forward about its lower front edge, by a finger on its top.
local poses = {}
for i, angle in ipairs { 0, 3, 6, 9, 12, 16, 20, 24 } do
  local a = math.rad(angle)
  local c, s = math.cos(a), math.sin(a)
  local x, z = -0.0775, 0.115  -- from the edge that it turns about to the origin of its frame
  poses[i] = {
    p = { -0.010 + x * c + z * s, 0, z * c - x * s }, rpy_deg = { 0, angle, 0 },
    press = { finger = "index", p_OC = { 0.0625, 0, 0.115 } },
  }
end
return ladder { scene = "scenes/book.lua", poses = poses }
