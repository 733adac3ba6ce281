-- expect: unknown_key_of_object.lua:4: object: unknown key "fricton" (did you mean "friction"?)
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, fricton = 0.3, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
