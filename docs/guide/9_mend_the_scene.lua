-- 9. Why was no grasp feasible, and what mends the scene?
local pg = require "pregrasp"

-- A ruler hangs over the edge of a table, with a shelf so many metres under the table's top.
local function shelf(gap)
  return pg.scene {
    name = "shelf",
    object = { name = "ruler", shape = pg.box { 0.3, 0.03, 0.003 }, mass = 0.025, friction = 0.3,
      p = { -0.1, 0, 0.0015 } },
    environment = {
      { name = "table", shape = pg.box { 0.8, 0.6, 0.04 }, friction = 0.3, p = { -0.4, 0, -0.02 } },
      { name = "shelf", shape = pg.box { 0.3, 0.6, 0.02 }, friction = 0.3, p = { 0.15, 0, -gap - 0.01 } },
    },
  }
end

local function attempt(gap)
  local s = pg.open(shelf(gap))
  local g = s:graph { triangles = 24, samples = 3 }
  g:score()
  g:prune { top_percent = 5 }
  local o = g:paths { stages = 1 }:next():optimize { samples = 6, iterations = 1 }
  o:run()
  local t = o:certify()
  print(t:why())
  return t:grasps { samples = 6, max_solves = 4, search_sets = 0 }
end

-- 5 mm are too few: a fingertip is 18 mm thick, so that all fingers are above, and push one way.
for _, gap in ipairs { 0.005, 0.19 } do
  print(("with %.0f mm of room under the table's top:"):format(1000 * gap))
  local grasps = attempt(gap)
  print(grasps:why())
  print("the first: " .. grasps[1]:why().text)
  if grasps:best() then print("and not the best: " .. grasps[1]:why_not().text) end
end
