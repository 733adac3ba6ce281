-- expect: same_name_twice.lua:5: environment[1].name: expected a name no other body has, got "object"
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { { name = "object", shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } },
}
