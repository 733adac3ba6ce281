-- expect: error_without_value.lua:2: an error whose value is a nil
error()
