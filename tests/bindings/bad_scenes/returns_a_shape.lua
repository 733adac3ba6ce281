-- expect: returns_a_shape.lua: expected "return scene { .. }" at its end, got a Shape
return box{1, 1, 1}
