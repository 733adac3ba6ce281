-- Lua 5.4; scene files have the constructors as globals, and so have ladders and hands.
std = "lua54"
max_line_length = 120
files["scenes"] = { read_globals = { "scene", "box", "cylinder", "capsule", "sphere", "mesh", "cloud", "union" } }
files["**/hand.lua"] = { read_globals = { "hand" } }
files["tests/ladders"] = { read_globals = { "ladder" } }
files["lua/meta"] = { ignore = { "212", "241", "631" } } -- annotations have empty bodies and long lines
