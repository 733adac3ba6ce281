-- expect: empty_union.lua:4: object.shape: expected at least one part, got an empty union
return scene {
  name = "bad",
  object = { shape = union{}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
