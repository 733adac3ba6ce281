-- expect: endless_loop.lua:2: out of time after 2 s of Lua
while true do end
