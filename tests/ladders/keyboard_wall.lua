-- The keyboard pushed against the wall and turned up about its lower back edge.
local poses = { { p = { -0.225, 0, 0.010 } } }  -- where it stands at the start
for i, angle in ipairs { 0, -4, -8, -12, -17, -22, -26, -30 } do
  local a = math.rad(angle)
  local c, s = math.cos(a), math.sin(a)
  local x, z = 0.065, 0.010  -- from the edge that it turns about to the origin of its frame
  poses[i + 1] = {
    p = { -0.300 - 0.020 * s + x * c + z * s, 0, z * c - x * s }, rpy_deg = { 0, angle, 0 },
    press = { finger = "index", p_OC = { 0.065, 0, -0.002 } },
  }
end
return ladder { scene = "scenes/keyboard_wall.lua", poses = poses }
