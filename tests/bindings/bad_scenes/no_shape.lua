-- expect: no_shape.lua:2: object.shape: expected a shape (box, cylinder, capsule, sphere, mesh, cloud or union), got nothing
return scene {
  name = "bad",
  object = { mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
