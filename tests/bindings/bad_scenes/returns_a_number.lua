-- expect: returns_a_number.lua: expected "return scene { .. }" at its end, got 42
return 42
