-- expect: returns_a_plain_table.lua: expected "return scene { .. }" at its end, got a table
return { name = "bad" }
