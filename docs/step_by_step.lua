-- The main job, one step at a time: a ruler flat on a table, at the edge, and how a hand gets hold
-- of it.  Run it with
--
--   ./run.sh script docs/step_by_step.lua
--
-- and look at out/step_by_step/frames in order: every step below has its picture there, under the
-- same name as in the log. `s`, `g`, `p`, `o`, .. are values: keep one, go on with another.
local pg = require "pregrasp"

local s = pg.open("scenes/ruler.lua", { seed = 1 })
s:record{ dir = "out/step_by_step", pictures = "key" }

-- 1. The contact-state graph. Each node is a pair of triangles: thumb on one, index on the other.
local g = s:graph{ triangles = 40 }
g:score()
g:prune_step()                        -- the best by score among the surroundings
g:prune_step()                        -- and the best without
g:prune_step()                        -- edges
print("nodes", #g.nodes, "kept", #g.kept)

-- Why is a node in, and another not?
local paths = g:paths{ stages = 2 }
local p = paths:next()
print(g:why(p.nodes[1]).sentence)
for id = 1, #g.nodes do
  if not g.nodes[id].kept then
    print(g:why_not(id).sentence)
    break
  end
end

-- 2. The path's trajectory, one MPPI iteration at a time. Three, two back, two again: the same.
local o = p:optimize{ samples = 48 }
for _ = 1, 3 do o:step() end
local cost = o.best_cost
o:back(2)
o:step()
o:step()
assert(o.best_cost == cost, "going back is exact")

-- A fork with wider noise goes its own way from here.
local wide = o:fork{ sigma = 1.2 }
wide:step()
while o:step() do print(o.iteration, o.best_cost) end

-- 3. The winner through the full simulation, and again at half the step.
local t = o:certify()
print("certified", t.certified)

-- 4. Five fingers close on it: 20 generated grasps, each with its reason.
local gr = t:grasps{ samples = 20 }
for i, x in gr:all() do print(i, x.feasible, x.reason) end

-- 5. The hand, last keyframe first.
local best = gr:best()
if best then
  local m = best:motion{ order = "reverse" }
  for key in m:keyframes() do key:shot{} end
  local frames = 0
  for _ in m:frames() do frames = frames + 1 end
  print("frames", frames, "failed", m.failed)
end
s:save("out/step_by_step")
