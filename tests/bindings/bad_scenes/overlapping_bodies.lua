-- expect: overlapping_bodies.lua:4: error: "object" overlaps "table" by 10 mm
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.04} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
