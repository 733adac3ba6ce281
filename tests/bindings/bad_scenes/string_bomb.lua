-- expect: string_bomb.lua:2: not enough memory: a script has 64 MB, a string 16 MB
local s = ("x"):rep(1e9)
