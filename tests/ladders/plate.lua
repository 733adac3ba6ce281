-- The plate raised on the near side by a finger under its rim; it turns about its foot.
local poses = {}
for i, angle in ipairs { 0, -4, -8, -12, -16, -20, -24, -28 } do
  local a = math.rad(angle)
  local c, s = math.cos(a), math.sin(a)
  local x, z = 0.075, 0  -- from the edge that it turns about to the origin of its frame
  poses[i] = {
    p = { -0.075 + x * c + z * s, 0, z * c - x * s }, rpy_deg = { 0, angle, 0 },
    press = { finger = "index", p_OC = { 0.118, 0, 0.0207 } },
  }
end
return ladder { scene = "scenes/plate.lua", poses = poses }
