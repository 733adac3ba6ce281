-- A marker lies in the narrow compartment of a pencil box, deeper than it is thick, one end at the box's
-- wall: no finger fits beside it, only in the free 6 cm at its other end.
return scene {
  name = "marker",
  object = {
    name = "marker", shape = cylinder{0.009, 0.140}, mass = 0.02, friction = 0.3, p = {0, 0, 0.009},
    rpy_deg = {0, 90, 0},
  },
  environment = {
    -- The floor's top is z = 0; the marker lies along x.
    { name = "floor", shape = box{0.221, 0.060, 0.004}, friction = 0.3, p = {0.0295, 0, -0.002} },
    { name = "left", shape = box{0.201, 0.003, 0.020}, friction = 0.3, p = {0.0295, -0.012, 0.010} },
    { name = "right", shape = box{0.201, 0.003, 0.020}, friction = 0.3, p = {0.0295, 0.012, 0.010} },
    { name = "stop", shape = box{0.010, 0.060, 0.025}, friction = 0.3, p = {-0.076, 0, 0.0125} },
    { name = "front", shape = box{0.010, 0.060, 0.020}, friction = 0.3, p = {0.135, 0, 0.010} },
  },
}
