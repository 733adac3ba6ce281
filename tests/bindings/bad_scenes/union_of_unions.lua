-- expect: union_of_unions.lua:4: union: expected at most 1000 parts and 16 levels, got
local u = box{0.1, 0.1, 0.1}
for _ = 1, 100 do
  u = union{u, u}
end
