-- expect: cloud_in_a_plane.lua:4: object.shape: expected points all over a closed surface, got "flat.ply", which lie within 0.00 mm of a plane
return scene {
  name = "bad",
  object = { shape = cloud{"flat.ply"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
