-- expect: no_object.lua:2: object: expected a body {shape = .., ..}, got nothing
return scene {
  name = "bad",
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
