-- 6. A picture strip for a lesson: the same camera, a caption of your own, every step under its id.
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
s:record { dir = "out/strip", pictures = "key" }
local camera = { p = { 0.25, -0.35, 0.2 }, look_at = { -0.05, 0, 0 } }
local function show(sim, caption)
  sim:shot { caption = caption, camera = camera, size = { 640, 360 },
    overlay = { "forces", "cones", "ghost", "fingers" } }
end

local sim = s:simulate()
sim:touch { finger = "index", p_OC = { 0.11, 0, 0.0015 } }
show(sim, "The finger touches, and does not press yet.")
sim:move { finger = "index", by = { 0, 0, -0.012 }, seconds = 0.4 }
show(sim, "It presses: the table carries more.")
s:break_when "slip"
local slipped = sim:move { finger = "index", by = { 0.3, 0, 0 }, seconds = 0.6 }
show(sim, "Too fast: it slips.")
print(slipped and ("slipped at %.3f s: %s"):format(s.stopped.t, s.stopped.text) or "it never slipped")
print("pictures and log: " .. s:save())
