-- expect: cloud_with_nan.lua:4: object.shape: expected finite coordinates, got "nan.ply", whose vertex 61 is not finite
return scene {
  name = "bad",
  object = { shape = cloud{"nan.ply"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
