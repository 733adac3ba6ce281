-- 2. A scene of your own: a box in a corner between a wall and a heavier box.
local pg = require "pregrasp"

local function box_at(name, size, x, y, more)
  local body = { name = name, shape = pg.box(size), p = { x, y, size[3] / 2 }, friction = 0.4 }
  for key, value in pairs(more) do body[key] = value end
  return body
end

local size, gap = { 0.16, 0.06, 0.12 }, 0.001
local scene = pg.scene {
  name = "corner",
  object = box_at("parcel", size, 0, 0, { mass = 0.3 }),
  environment = {
    { name = "floor", shape = pg.box { 1, 1, 0.02 }, p = { 0, 0, -0.01 }, friction = 0.4 },
    box_at("wall", { 0.5, 0.02, 0.3 }, 0, size[2] / 2 + gap + 0.01, {}),
    box_at("crate", { 0.14, 0.1, 0.2 }, -(size[1] + 0.14) / 2 - gap, (size[2] - 0.1) / 2, { mass = 2 }),
  },
}
print(pg.check(scene))

local s = pg.open(scene, { seed = 1 })
print("left alone it moves " .. ("%.3f mm"):format(s:settle { seconds = 0.5 }.moved_mm))
local g = s:graph { triangles = 24 }
g:score()
g:prune { top_percent = 5 }
local best = g:triangles { finger = "index", count = 1 }[1]
print(("the index finger would rather be on triangle %d, at (%.0f, %.0f, %.0f) mm"):format(best.triangle,
  1000 * best.p_OCentre[1], 1000 * best.p_OCentre[2], 1000 * best.p_OCentre[3]))

local o = g:paths():next():optimize { samples = 8, iterations = 2 }
o:run()
print(o.step_id, ("best cost %.3f"):format(o.best_cost))
g:shot { "corner", file = "out/corner.png", size = { 640, 360 } }
