-- expect: endless_loop_in_pcall.lua:2: out of time after 2 s of Lua
while true do pcall(function() while true do end end) end
