-- A right hand of four fingers, of the project's own design: 16 joints, longer links and larger tips
-- than the Shadow Hand's.
return hand{
  name = "four_finger",
  urdf = "four_finger.urdf",
  palm = {link = "palm"},
  fingers = {  -- from the thumb
    {joints = {"T_ROT", "T_FLEX", "T_MCP", "T_IP"}, tip = {p = {0, 0, 0.027}, r = 0.0125}},
    {joints = {"I_ABD", "I_MCP", "I_PIP", "I_DIP"}, tip = {p = {0, 0, 0.024}, r = 0.0110}},
    {joints = {"M_ABD", "M_MCP", "M_PIP", "M_DIP"}, tip = {p = {0, 0, 0.024}, r = 0.0110}},
    {joints = {"R_ABD", "R_MCP", "R_PIP", "R_DIP"}, tip = {p = {0, 0, 0.024}, r = 0.0110}},
  },
  posture = {  -- at ease
    I_ABD = -0.05, I_MCP = 0.30, I_PIP = 0.40, I_DIP = 0.25,
    M_ABD = 0.00, M_MCP = 0.35, M_PIP = 0.45, M_DIP = 0.25,
    R_ABD = 0.05, R_MCP = 0.40, R_PIP = 0.45, R_DIP = 0.25,
    T_ROT = 0.30, T_FLEX = 0.60, T_MCP = 0.25, T_IP = 0.35,
  },
  forearm = {r = 0.016, from = 0.032, to = 0.20},
}
