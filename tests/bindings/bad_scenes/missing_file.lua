-- expect: missing_file.lua:4: shape "nowhere.stl": expected a file, got nothing of that name
return scene {
  name = "bad",
  object = { shape = mesh{"nowhere.stl"}, mass = 0.2 },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
