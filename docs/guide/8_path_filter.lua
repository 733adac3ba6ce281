-- 8. Your own path filter: only paths that begin with a finger on the ruler's top; and one by hand.
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
local g = s:graph { triangles = 24, samples = 3 }
g:score()
g:prune { top_percent = 8 }
local normals = g.mesh.normals

local function on_top(path)
  local node = path.nodes[1]
  return normals[node.index + 1][3] > 0.9 and node.index_fits
end
local all, mine = g:paths { stages = 2 }, g:paths { stages = 2, filter = on_top }
print(("%d paths in all; the first is %s, mine %s"):format(#all, all[1], mine[1]))
local p = mine:next()
print(p:why())
print(mine[2]:why_not(p))

local hand = g:path { p.nodes[1].id, p.nodes[1].id }
print(hand, hand.step_id)
local o = hand:optimize { samples = 8, iterations = 1 }
o:run()
print(o.step_id, ("best cost %.3f"):format(o.best_cost))
