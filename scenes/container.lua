-- A food container on a table: upright sides, wider than a hand spans, and a lid that does not stand out.
return scene {
  name = "container",
  object = { name = "container", shape = mesh{"assets/objects/container.obj"}, mass = 0.5, friction = 0.3 },
  environment = {
    { name = "table", shape = box{0.800, 0.800, 0.040}, friction = 0.3, p = {0, 0, -0.020} },
  },
}
