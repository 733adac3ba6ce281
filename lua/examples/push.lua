-- A ruler lies flat on a table, and no hand can get hold of it. One fingertip on top of it is
-- enough to change that: press, pull, and the ruler's end comes over the edge.
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
s:record { dir = "out/push", pictures = "key" }

local rest = s:settle { seconds = 1 }
print(("left alone, the ruler moves %.4f mm and turns %.4f degrees"):format(rest.moved_mm, rest.rotated_deg))

-- The fingertip is a spring: it pulls from the contact towards a target, 50 N for each metre.
local sim = s:simulate()
sim:touch { finger = "index", p_OC = { 0.11, 0, 0.0015 } }  -- near the end, on the top face
sim:move { finger = "index", by = { 0, 0, -0.012 }, seconds = 0.5 }  -- press: 12 mm are 0.6 N
sim:shot {}

for _ = 1, 4 do
  sim:move { finger = "index", by = { 0.0185, 0, 0 }, seconds = 0.6 }
  sim:shot {}
  local tip, ruler = sim.fingers.index, sim.object
  print(("%s  t = %.2f s  ruler at x = %6.1f mm  index presses %.2f N, slipped %.1f mm"):format(
    sim.step_id, sim.t, 1000 * ruler.p[1], tip.normal_N, tip.slip_mm))
end

sim:lift { finger = "index" }
sim:wait { seconds = 1 }
sim:shot {}

local edge, half = 0, 0.150  -- of the table and of the ruler [m]
print(("the ruler's end is %.1f mm over the edge"):format(1000 * (sim.object.p[1] + half - edge)))
print("pictures and log: " .. s:save())
