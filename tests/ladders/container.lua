-- The container raised on the near side; it turns about its lower far edge.
local poses = {}
for i, angle in ipairs { 0, -3, -6, -9, -12, -15, -18, -20 } do
  local a = math.rad(angle)
  local c, s = math.cos(a), math.sin(a)
  local x, z = 0.100, 0  -- from the edge that it turns about to the origin of its frame
  poses[i] = {
    p = { -0.100 + x * c + z * s, 0, z * c - x * s }, rpy_deg = { 0, angle, 0 },
    press = { finger = "index", p_OC = { 0.100, 0, 0.030 } },
  }
end
return ladder { scene = "scenes/container.lua", poses = poses }
