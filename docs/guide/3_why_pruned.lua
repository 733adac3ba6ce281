-- 3. Why was this node pruned? And what would change that?
local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
local g = s:graph { triangles = 24, samples = 3 }
g:score()
g:prune { top_percent = 5 }

local id = g:node { thumb = 0, index = 3 }.id
print(g:why_not(id))
print(g:why(g.kept[1]))
for _, t in ipairs(g:triangles { finger = "thumb", count = 3 }) do
  print(("thumb on triangle %2d: at best %.3f, kept in %d nodes"):format(t.triangle, t.best, t.kept))
end

-- What if the edge were nearer: the same graph on a table that ends 2 cm further in.
local nearer = g:what_if { set = { ["environment.table.p"] = { -0.42, 0, -0.02 } } }
local comparison = pg.compare(g, nearer)
print(comparison.scene.field, comparison.scene.a, comparison.scene.b)
local change = comparison.scores[1]
print(("node %d changes most: %.3f here, %.3f there"):format(change.id, change.a, change.b))
print("kept here: " .. tostring(g:why(change.id).kept) .. ", there: " .. tostring(nearer:why(change.id).kept))
