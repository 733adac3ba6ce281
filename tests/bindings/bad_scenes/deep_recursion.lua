-- expect: deep_recursion.lua:2: not enough memory
local function f() return 1 + f() end
return f()
