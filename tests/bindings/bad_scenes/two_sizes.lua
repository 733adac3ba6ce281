-- expect: two_sizes.lua:4: box: expected {x, y, z} in metres, got 2 numbers
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
