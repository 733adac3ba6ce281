-- expect: infinite.lua:4: object.mass: expected a finite number, got inf
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = math.huge },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
