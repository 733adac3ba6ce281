-- The marker pushed at its free end against the box's wall, and turned up.
local poses = { { p = { 0, 0, 0.009 }, rpy_deg = { 0, 90, 0 } } }  -- where it lies at the start
for i, angle in ipairs { 0, -6, -12, -18, -24, -32, -40 } do
  local a = math.rad(angle)
  local c, s = math.cos(a), math.sin(a)
  local x, z = 0.070, 0.009  -- from the edge that it turns about to the origin of its frame
  poses[i + 1] = {
    p = { -0.071 - 0.018 * s + x * c + z * s, 0, z * c - x * s }, rpy_deg = { 0, 90 + angle, 0 },
    press = { finger = "index", p_OC = { 0, 0, 0.070 } },
  }
end
return ladder { scene = "scenes/marker.lua", poses = poses }
