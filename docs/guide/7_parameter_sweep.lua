-- 7. A parameter sweep: how does friction change where the finger gets the ruler?
local pg = require "pregrasp"
print("friction  pulled [mm]  slid over the ruler [mm]")
for _, friction in ipairs { 0.2, 0.4, 0.6, 0.8 } do
  local s = pg.open("scenes/ruler.lua", { set = { ["fingertips.friction"] = friction } })
  local sim = s:simulate()
  local start = sim.object.p[1]
  sim:touch { finger = "index", p_OC = { 0.11, 0, 0.0015 } }
  sim:move { finger = "index", by = { 0, 0, -0.012 }, seconds = 0.4 }
  sim:move { finger = "index", by = { 0.05, 0, 0 }, seconds = 0.8 }
  print(("%8.1f  %11.1f  %24.1f"):format(friction, 1000 * (sim.object.p[1] - start), sim.fingers.index.slip_mm))
end
