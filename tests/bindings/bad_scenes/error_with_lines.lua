-- expect: error_with_lines.lua:2: two lines  [31mred
error("two\nlines \27[31mred")
