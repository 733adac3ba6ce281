-- expect: negative_friction.lua:4: object.friction: expected a number from 0 to 10, got -0.1
return scene {
  name = "bad",
  object = { shape = sphere{0.05}, mass = 0.2, friction = -0.1, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
