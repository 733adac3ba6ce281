-- expect: syntax_error.lua:3: 
return scene {
  name = = "bad",
}
