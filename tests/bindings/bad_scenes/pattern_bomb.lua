-- expect: pattern_bomb.lua:2: out of time after 2 s of Lua
(("a"):rep(40)):find(("a?"):rep(40) .. ("a"):rep(40) .. "b")
