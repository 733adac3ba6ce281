-- expect: mass_is_text.lua:4: object.mass: expected a number, got "0.2"
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = "0.2" },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
