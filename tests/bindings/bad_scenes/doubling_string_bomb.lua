-- expect: doubling_string_bomb.lua:3: not enough memory: a script has 64 MB, a string 16 MB
local s = "x"
while true do s = s .. s end
