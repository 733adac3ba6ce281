-- The main job, one step at a time: a ruler lies flat on a table, at the edge, and a hand gets hold of it.
--
--   ./run.sh script docs/step_by_step.lua
--
-- Then look at out/step_by_step/frames in order: each step below has its picture there, under the name
-- that it has in the log and in `step_id`.
local pg = require "pregrasp"

local s = pg.open("scenes/ruler.lua", { seed = 1 })
s:record { dir = "out/step_by_step", pictures = "key" }

-- 1. The contact-state graph. A node is a pair of triangles of the ruler: the thumb somewhere on the
--    first, the index finger on the second.
local g = s:graph { triangles = 40 }
g:score()  -- the learned score of each node: among the surroundings (s_c), and alone (s_n)
g:prune_step()  -- stay: the best by s_c, with which a path may begin
g:prune_step()  -- stay too: the best by s_n
g:prune_step()  -- nodes that share a triangle are connected
print(("%d of %d nodes stay, with %d edges"):format(#g.kept, g.num_nodes, g.num_edges))

local paths = g:paths { stages = 2 }
local p = paths:next()
print(g:why(p.nodes[1].id).text)
print(g:why_not(0).text)
print("the next best ended otherwise and lost by " .. p.siblings[1].behind)

-- 2. The path's trajectory. Every iteration of MPPI is a value: three steps, two back and two again are
--    the same to the last bit.
local o = p:optimize { samples = 48 }
for _ = 1, 3 do o:step() end
local cost = o.best_cost
o:back(2)
o:step()
o:step()
assert(o.best_cost == cost, "going back is exact")

local calm = o:fork { sigma = 0.3 }  -- what if the noise were smaller from here on?
calm:step()
local branch = o:fork()
branch:step()
assert(calm.mean_cost ~= branch.mean_cost, "another sigma is another plan")

while o:step() do end
print(("%d iterations, best cost %.3f"):format(o.iteration, o.best_cost))

-- 3. The best plan through the full simulation, and again at half the time step.
local t = o:certify()
print(t.certified and "certified" or "not certified: " .. table.concat(t.reasons, "; "))
print(t.stays_when_released and "it stays when released" or "a finger must keep pressing")

-- 4. Twenty generated grasps, each with what stands in its way.
local grasps = t:grasps { samples = 20 }
for i, x in grasps:all() do print(i, x.text) end
print(("r_suc %.2f, without refinement %.2f"):format(grasps.r_suc, grasps.r_suc_raw))

-- 5. The hand: keyframes from the last to the first, then the frames between them.
local best = grasps:best()
if best then
  best:shot {}
  local m = best:motion { order = "reverse" }
  for key in m:keyframes() do key:shot {} end
  local worst = 0
  for frame in m:frames() do worst = math.max(worst, frame.tip_error_mm) end
  print(("%d frames, %d failed, tips within %.2f mm"):format(m.num_frames, m.summary.failed, worst))
end
print("pictures and log: " .. s:save())
