-- expect: error_is_a_table.lua:2: an error whose value is a table
error({ code = 1 })
