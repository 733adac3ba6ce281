-- expect: environment_with_gap.lua:2: scene: environment: expected a list of bodies, got
return scene {
  name = "bad",
  object = { shape = box{0.1, 0.1, 0.1}, mass = 0.2, p = {0, 0, 0.05} },
  environment = { nil, { shape = box{1, 1, 0.02} } },
}
