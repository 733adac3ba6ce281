-- expect: unknown_key.lua:2: unknown key "gravty" (did you mean "gravity"?)
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
  gravty = {0, 0, -9.81},
}
