-- expect: returns_nothing.lua: expected "return scene { .. }" at its end, got nothing
local x = 1
