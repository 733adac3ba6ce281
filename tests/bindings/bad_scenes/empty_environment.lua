-- expect: empty_environment.lua:2: environment: expected at least one body, got none
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = {},
}
