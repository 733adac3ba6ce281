-- expect: cloud_with_nan.lua:4: object.shape: expected a cloud of the points that were seen, with the others left out, got "nan.ply", with 1 of 121 points not finite
return scene {
  name = "bad",
  object = { shape = cloud{"nan.ply"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
