-- 1. First steps: open a scene, ask it, push its object, go back, and take a picture.
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
print(s:check())
for _, name in ipairs(s.bodies) do print("a body:", name) end

local sim = s:simulate()
sim:touch { finger = "index", p_OC = { 0.11, 0, 0.0015 } }  -- on top, near the end at the edge
sim:move { finger = "index", by = { 0, 0, -0.012 }, seconds = 0.5 }  -- press: 12 mm of spring are 0.6 N
sim:move { finger = "index", by = { 0.04, 0, 0 }, seconds = 1 }  -- and pull
local pulled = sim.object.p[1]
print(("pulled for %.2f s, the ruler is at x = %.1f mm"):format(sim.t, 1000 * pulled))
sim:shot { "pulled", file = "out/first_steps.png", size = { 640, 360 } }

sim:back(100)
print(("100 physics steps before it was at x = %.1f mm"):format(1000 * sim.object.p[1]))
sim:forward(100)
assert(sim.object.p[1] == pulled, "to the last bit")
