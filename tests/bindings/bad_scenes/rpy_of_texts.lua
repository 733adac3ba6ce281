-- expect: rpy_of_texts.lua:4: object.rpy_deg[3]: expected a number, got "90"
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, rpy_deg = {0, 0, "90"} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
