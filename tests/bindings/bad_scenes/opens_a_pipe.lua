-- expect: opens_a_pipe.lua:2: unknown variable "io"
io.popen("touch escaped")
return 1
