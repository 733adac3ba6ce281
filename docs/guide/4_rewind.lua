-- 4. Rewind the planner, change sigma, and go on; then keep the state for another process.
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
local g = s:graph { triangles = 24, samples = 3 }
g:score()
g:prune { top_percent = 5 }
local o = g:paths():next():optimize { samples = 12, iterations = 6 }

for _ = 1, 4 do o:step() end
local cost = o.best_cost
print(("after iteration %d: best cost %.4f, sigma of the next %.3f"):format(o.iteration, cost, o.sigma))
o:back(2)
o:set { sigma = 0.2, final_sigma = 0.2 }
o:run(2)
print(("again from iteration 2 with sigma 0.2: %.4f, as %s"):format(o.best_cost, o.step_id))

local first = s:go "path.1.mppi.4"
assert(first.best_cost == cost, "what was, is there still")
s:save_state("out/rewind", first)
local s2, again = pg.load_state "out/rewind"
again:step()
first:step()
assert(again.best_cost == first.best_cost, "and goes on as it would have")
print(("%s, loaded, goes on to %s: %.4f"):format(s2, again.step_id, again.best_cost))
