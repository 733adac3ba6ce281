-- expect: memory_bomb.lua:3: not enough memory: a script has 64 MB, a string 16 MB
local t = {}
for i = 1, 1e9 do t[i] = {i} end
