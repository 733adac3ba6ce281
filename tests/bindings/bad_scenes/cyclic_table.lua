-- expect: cyclic_table.lua:4: union: union[1]: unknown key "1"
local parts = {}
parts[1] = parts
return scene { name = "bad", object = { shape = union(parts) } }
