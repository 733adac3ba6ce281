-- expect: loads_bytecode.lua:2: attempt to load a binary chunk
assert(load("\27Lua"))
