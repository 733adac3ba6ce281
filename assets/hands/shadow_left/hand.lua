-- The left Shadow Dexterous Hand: the right one mirrored.
return hand{
  name = "shadow_left",
  urdf = "../shadow_right/shadow_right.urdf",
  mirror = true,
  palm = {link = "palm"},
  fingers = {  -- from the thumb
    {joints = {"THJ5", "THJ4", "THJ3", "THJ2", "THJ1"}, tip = {p = {0, 0, 0.024}, r = 0.0109}},
    {joints = {"FFJ4", "FFJ3", "FFJ2", "FFJ1"}, tip = {p = {0, 0, 0.0209}, r = 0.0090}},
    {joints = {"MFJ4", "MFJ3", "MFJ2", "MFJ1"}, tip = {p = {0, 0, 0.0209}, r = 0.0090}},
    {joints = {"RFJ4", "RFJ3", "RFJ2", "RFJ1"}, tip = {p = {0, 0, 0.0209}, r = 0.0090}},
    {joints = {"LFJ5", "LFJ4", "LFJ3", "LFJ2", "LFJ1"}, tip = {p = {0, 0, 0.0209}, r = 0.0090}},
  },
  posture = {  -- at ease
    FFJ4 = -0.05, FFJ3 = 0.30, FFJ2 = 0.40, FFJ1 = 0.25,
    MFJ4 = 0.00, MFJ3 = 0.35, MFJ2 = 0.45, MFJ1 = 0.25,
    RFJ4 = -0.05, RFJ3 = 0.40, RFJ2 = 0.45, RFJ1 = 0.25,
    LFJ5 = 0.10, LFJ4 = -0.10, LFJ3 = 0.40, LFJ2 = 0.45, LFJ1 = 0.25,
    THJ5 = 0.30, THJ4 = 0.60, THJ3 = 0.00, THJ2 = 0.25, THJ1 = 0.35,
  },
  forearm = {r = 0.015, from = 0.032, to = 0.20},
}
