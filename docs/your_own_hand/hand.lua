-- The Allegro Hand's joints with shapes of our own: an example of docs/your_own_hand.md.
local pad = {along = {0, 0, 1}, palmar = {1, 0, 0}}  -- of the palm and of every last link

local function finger(first, length)
  local joints = {}
  for i = first, first + 3 do joints[#joints + 1] = "joint_" .. i .. ".0" end
  return {joints = joints, tip = {p = {0, 0, length}, r = 0.012, along = pad.along, palmar = pad.palmar}}
end

local function bar(y)  -- of the palm's box, from the wrist to the knuckles
  return {from = {-0.0093, y, -0.0745}, to = {-0.0093, y, -0.0205}, r = 0.0205}
end

return hand{
  name = "allegro_right",
  urdf = "allegro.urdf",
  palm = {link = "palm_link", p = {0, 0, -0.095}, along = pad.along, palmar = pad.palmar},
  fingers = {finger(12, 0.0423), finger(0, 0.0267), finger(4, 0.0267), finger(8, 0.0267)},
  capsules = {  -- in place of the URDF's boxes
    palm_link = {bar(-0.036), bar(-0.012), bar(0.012), bar(0.036)},
    ["link_12.0"] = {{from = {-0.010, 0.001, 0.012}, to = {-0.022, 0.003, 0.030}, r = 0.016}},
  },
  may_touch = {{"palm_link", "link_13.0"}},  -- the thumb's root lies within the palm
  posture = {
    ["joint_12.0"] = 0.9, ["joint_13.0"] = 0.3, ["joint_14.0"] = 0.3, ["joint_15.0"] = 0.4,
    ["joint_1.0"] = 0.35, ["joint_2.0"] = 0.4, ["joint_3.0"] = 0.3,
    ["joint_5.0"] = 0.4, ["joint_6.0"] = 0.4, ["joint_7.0"] = 0.3,
    ["joint_9.0"] = 0.45, ["joint_10.0"] = 0.4, ["joint_11.0"] = 0.3,
  },
}
