-- 5. Two forks side by side: the same noise under other settings.
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
local g = s:graph { triangles = 24, samples = 3 }
g:score()
g:prune { top_percent = 5 }
local wild = g:paths():next():optimize { samples = 12, iterations = 6 }
wild:run(2)
local calm = wild:fork { sigma = 0.2 }
wild:run(2)
calm:run(2)

print(pg.compare(wild, calm))
for i = 3, 4 do
  print(("iteration %d: mean cost %6.3f wild, %6.3f calm"):format(i, wild.mean_history[i], calm.mean_history[i]))
end
print(wild:why())
print(calm:why())
s:strip { wild, against = calm, file = "out/forks.png", size = { 1280, 960 } }
