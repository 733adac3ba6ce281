-- expect: runs_a_program.lua:2: unknown variable "os"
os.execute("touch escaped")
return 1
