-- expect: two_scenes.lua:7: scene: expected one scene in a file, got a second one
local first = scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { name = "table", shape = box{0.8, 0.6, 0.04}, p = {0, 0, -0.02} } },
}
