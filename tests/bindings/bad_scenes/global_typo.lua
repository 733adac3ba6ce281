-- expect: global_typo.lua:4: unknown variable "bx" (did you mean "box"?)
return scene {
  name = "bad",
  object = { shape = bx{0.1, 0.1, 0.1}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
