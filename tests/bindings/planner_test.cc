// The planner's stages from scripts, in the real machine. The networks' weights are random: what
// is found is poor, how it is stepped is not.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "bindings/script.h"
#include "tests/bindings/planner_script.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

TEST_F(PlannerScriptTest, AGraphIsMeshedScoredAndPrunedStepByStep) {
  EXPECT_EQ(Script(R"(
    local g = graph()
    print(g, g.stage, g.step_id, g.num_triangles, g.num_nodes, #g.kept, #g.mesh.triangles)
    g:score() print(g.stage, g.step_id)
    while g:prune_step() do print(g.stage, g.step_id, #g.initial) end
    print(#g.kept >= #g.initial, g.num_edges > #g.kept, g.top_percent))"),
            "Graph(meshed, 144 nodes)\tmeshed\tgraph.mesh\t12\t144\t0\t12\nscored\tgraph.score\n"
            "pruned_context\tgraph.prune.1\t8\npruned_free\tgraph.prune.2\t8\n"
            "connected\tgraph.prune.3\t8\ntrue\ttrue\t5.0\n");
}

TEST_F(PlannerScriptTest, PruningANodeAtATimeEndsAsThreeStepsDo) {
  EXPECT_EQ(Script(R"(
    local g = graph() g:score()
    local whole = g:fork() whole:prune()
    g:prune_step(1) print(g.stage, g.step_id, #g.initial)
    g:prune_step(2) print(g.stage, g.step_id, #g.initial)
    while g:prune_step(1) do end
    local same = g.num_edges == whole.num_edges and #g.kept == #whole.kept
    for i = 1, #g.kept do same = same and g.kept[i] == whole.kept[i] end
    print(g.stage, #g.initial, same))"),
            "scored\tgraph.prune.1~2\t1\nscored\tgraph.prune.2~2\t3\nconnected\t8\ttrue\n");
}

TEST_F(PlannerScriptTest, PruningTakesAnotherPercentageAndGoesBackExactly) {
  EXPECT_EQ(Script(R"(
    local g = graph() g:score()
    local fork = g:fork()
    g:prune{ top_percent = 10 } fork:prune{ top_percent = 50 }
    print(#g.initial, #fork.initial, fork.top_percent)
    local kept = g.kept
    g:back(3) print(g.stage, #g.kept, #fork.kept > #kept)
    g:prune{ top_percent = 10 } print(g.stage, #g.kept == #kept, g.kept[1] == kept[1]))"),
            "15\t72\t50.0\nscored\t0\ttrue\nconnected\ttrue\ttrue\n");
}

TEST_F(PlannerScriptTest, ANodeSaysWhyItIsThereOrNot) {
  EXPECT_EQ(Script(R"(
    local g = pruned()
    local best = g:top(3)
    print(#best, best[1].rank_c, best[1].s_c >= best[2].s_c, best[1].id == best[1].thumb * 12 + best[1].index)
    local why = g:why(best[1].id)
    print(why.kept, why.verdict:find("^kept_by") ~= nil, why.node.rank_c, why.node.s_c >= why.threshold_c)
    print(tostring(why) == why.text, why.text:find("rank 1 of 144", 1, true) ~= nil)
    local out for id = 0, 143 do if not g:node(id).kept then out = id break end end
    local why_not = g:why_not(out)
    print(why_not.verdict, why_not.id == out, why_not.text:find("is pruned", 1, true) ~= nil)
    print(#g:neighbors(best[1].id) >= 1, #g:neighbors(out)))"),
            "3\t1\ttrue\ttrue\ntrue\ttrue\t1\ttrue\ntrue\ttrue\npruned\ttrue\ttrue\ntrue\t0\n");
}

TEST_F(PlannerScriptTest, PathsComeBestFirstByNextByTopAndByNumber) {
  EXPECT_EQ(Script(R"(
    local paths = pruned():paths{ stages = 3, order = "paper" }
    local top = paths:top(5)
    print(#top, paths.stages, paths.count > 100, top[1].step_id == "")
    for i = 1, 4 do assert(top[i].score >= top[i + 1].score and top[i].rank == i) end
    local p = paths:next()
    print(p.rank, p.step_id, #p.nodes, p.score == top[1].score, paths[1].score == p.score, paths[2].rank)
    print(paths:next().rank, paths[2].nodes[1].id == top[2].nodes[1].id)
    local sum = 0 for _, term in ipairs(p.terms) do sum = sum + term end
    print(math.abs(sum - p.score) < 1e-12, p.terms[1] == p.nodes[1].s_c, p.terms[3] == p.nodes[3].s_n)
    for _, s in ipairs(p.siblings) do
      assert(s.score <= p.score and math.abs(p.score - s.score - s.behind) < 1e-12)
      assert(s.nodes[1] == p.nodes[1].id and s.nodes[2] == p.nodes[2].id and s.nodes[3] ~= p.nodes[3].id)
    end
    print(#p.siblings <= 5))"),
            "5\t3\ttrue\ttrue\n1\tpaths.rank.1\t3\ttrue\ttrue\t2\n2\ttrue\n"
            "true\ttrue\ttrue\ntrue\n");
  EXPECT_EQ(Script(R"(
    local paths, n = pruned():paths{ stages = 1 }, 0
    while paths:next() do n = n + 1 end
    print(n == paths.count, paths:next(), paths[n + 1], paths[n].rank == n))"),
            "true\tnil\tnil\ttrue\n");
}

TEST_F(PlannerScriptTest, PathsThatExploreComeByTheirValueAndBeginWhereAFingertipFits) {
  EXPECT_EQ(Script(R"(
    local g = pruned()
    local paths, papers = g:paths(), g:paths{ order = "paper" }
    print(paths.order, papers.order, papers[1].value == papers[1].score, papers[1].repeats)
    local top = paths:top(8)
    for i, p in ipairs(top) do
      assert(p.nodes[1].thumb_fits or p.nodes[1].index_fits)
      assert(i == 1 or p.value <= top[i - 1].value)
    end
    print(top[1].repeats, top[8].repeats > 0, top[1].value)
    for id = 0, 143 do
      local node = g:node(id)
      if not (node.thumb_fits or node.index_fits) then
        assert(g:why(id).text:find("no path begins", 1, true))
      end
    end)"),
            "explore\tpaper\ttrue\t0.0\n0.0\ttrue\t1.0\n");
}

TEST_F(PlannerScriptTest, ScreeningTellsWhatAPathIsWorthAndStepsGoOnFromThere) {
  EXPECT_EQ(Script(R"(
    local o = optimizer()
    local first = o:screen{ samples = 4, iterations = 1 }
    local second = o:screen()
    print(first.round, first.iterations, first.rollouts, first.step_id, second.round, second.step_id)
    print(second.value >= first.value, second.score_scale == first.score_scale, second.rest_reward <= 3)
    print(o.iteration, o.best_cost, #o.best_history)
    o:step()  -- where plans are tried in other worlds, too, which takes of what they gain
    local lost = o.settings.fragility * math.max(second.best.reward - second.rest_reward, 0)
    print(o.iteration, o.best_cost <= second.best.total + lost, o.score_scale == first.score_scale, #o.best_history)
    print(second.best.room >= 0, second.best.hold >= 0, second.best.reward >= second.best.final_score)
    local _, refusal = pcall(o.screen, o)
    print(refusal:find("expected a path that is not being optimised yet", 1, true) ~= nil))"),
            "1\t1\t4\tpath.1.screen.1\t2\tpath.1.screen.2\ntrue\ttrue\ttrue\n0\tnil\t0\n"
            "1\ttrue\ttrue\t1\ntrue\ttrue\ttrue\n"
            "true\n");
}

TEST_F(PlannerScriptTest, AnOptimisationIsSteppedTakenBackAndForkedExactly) {
  EXPECT_EQ(Script(R"(
    local o = optimizer()
    print(o, o.iteration, o.best_cost, o.mean_cost, #o:rollouts())
    while o:step() do end
    print(o.iteration, o.converged, #o.best_history, #o:rollouts(), o.best_cost == o.best.total, o.step_id)
    local last, cost = o:rollouts(), o.best_cost
    o:back(2) print(o.iteration, o.step_id, o.converged)
    local other, twin = o:fork{ sigma = 0.3 }, o:fork()
    run(o) run(other) run(twin)
    print(same(last, o:rollouts()), same(last, twin:rollouts()), same(last, other:rollouts()), o.best_cost == cost)
    print(o:step(), o.iteration)
    local r = last[1]
    print(r.cost == r.terms.total, #r.terms.stage_scores, r.weight >= 0, #r.X_WO.p))"),
            "Optimizer(path 1, iteration 0)\t0\tnil\tnil\t0\n4\tfalse\t4\t6\ttrue\tpath.1.mppi.4\n"
            "2\tpath.1.mppi.2\tfalse\ntrue\ttrue\tfalse\ttrue\nfalse\t4\ntrue\t2\ttrue\t3\n");
}

TEST_F(PlannerScriptTest, ATrajectoryIsCertifiedAndItsGraspsHaveReasons) {
  EXPECT_EQ(
      Script(R"(
    local t = run(optimizer()):certify{ hold_seconds = 0.5 }
    print(t.step_id, t.certified == (#t.reasons == 0), t.num_steps > 100, #t.stages, #t.object.p, t.seconds > 2)
    assert(#t.waits == #t.stages and t.waits[1] == 0 and not (t.certified and t.out_of_reach_t))
    for _, stage in ipairs(t.stages) do
      if stage.thumb.on then assert(#stage.thumb.p_WTargets == 4 and #stage.thumb.nhat_O == 3) end
    end
    local gr = t:grasps{ samples = 3, max_solves = 1, starts = 2, search_sets = 0 }
    print(gr.count, gr[1].step_id, gr[4], gr.r_suc == gr.num_feasible / 3, gr.r_suc_raw <= gr.r_suc)
    local n = 0
    for i, x in gr:all() do
      n = n + 1
      assert(x.sample == i and x.feasible == (x.reason == "feasible") and #x.text > 10)
      assert(#x.contacts == #x.fingers and (x.lift == nil) == not x.feasible)
    end
    print(n, gr:best() == nil or gr:best().feasible))"),
      "path.1.certify\ttrue\ttrue\t2\t3\ttrue\n3\tpath.1.grasp.1\tnil\ttrue\ttrue\n3\ttrue\n");
}

TEST_F(PlannerScriptTest, AFingerThatIsKeptStaysOnItsTriangle) {
  EXPECT_EQ(Script(R"(
    local kept, others = 0, 0
    local paths = pruned():paths{ stages = 2 }
    for i = 1, 12 do
      local path = paths:next()
      local o = path:optimize{ samples = 4, iterations = 1 }
      o:step()
      for _, finger in ipairs { "thumb", "index" } do
        local first, second = o.nominal[1][finger], o.nominal[2][finger]
        if second.kept then
          kept = kept + 1
          assert(second.triangle == first.triangle)
          if path.nodes[2][finger] ~= first.triangle then others = others + 1 end
        end
      end
    end
    print(kept > 0, others > 0))"),
            "true\ttrue\n");
}

TEST_F(PlannerScriptTest, APlanMadeByHandIsCertified) {
  EXPECT_EQ(Script(R"(
    local o = optimizer()
    local drag = { { index = { p_OC = {0, 0, 0.002}, p_WTargets = {} } } }
    for k = 1, 4 do drag[1].index.p_WTargets[k] = {-0.16 + 0.06 * k / 4, 0, -0.007} end
    local t = o:certify({}, drag)
    local index = t.stages[1].index
    print(t.step_id, t.certified, #t.stages, t.stages[1].thumb.on, index.on, ("%.4f"):format(index.p_OC[3]))
    print(("%.3f"):format(t.object.p[1] + 0.16))
    local again = o:certify({}, t.stages)
    print(again.step_id, ("%.6f"):format(again.object.p[1] - t.object.p[1]))
    drag[2] = { index = { p_WTargets = { {-0.07, 0, -0.007} } } }
    local on = o:certify({}, drag)
    print(#on.stages, on.stages[2].index.kept, on.object.p[1] > t.object.p[1] + 0.02))"),
            "path.1.certify\ttrue\t1\tfalse\ttrue\t0.0015\n0.054\n"
            "path.1.certify~2\t0.000000\n2\ttrue\ttrue\n");
}

// A light cube on a post can be grasped from most sides: of the first seeds, whatever the networks
// say, the first one with a feasible grasp.
const char* const kCube = R"(
    local s, gr
    for seed = 1, 8 do
      s = pg.open(pg.scene{ name = "cube",
        object = { shape = pg.box{0.065, 0.065, 0.065}, mass = 0.05, friction = 0.6, p = {0, 0, 0.3325} },
        environment = { { name = "post", shape = pg.box{0.03, 0.03, 0.3}, p = {0, 0, 0.15}, friction = 0.6 } } },
        { seed = seed })
      local o = pruned(s):paths{ stages = 1 }:next():optimize{ samples = 6, iterations = 2 }
      gr = run(o):certify{ hold_seconds = 0.1 }:grasps{ samples = 4, points = 100, pairs = 300,
        max_refinement = 0.05, max_solves = 20, starts = 3, search_sets = 0 }
      if gr:best() then break end
    end
    local quick = { keyframe_starts = 3, frame_starts = 1, smoothing_iterations = 3, fps = 5 }
)";

TEST_F(PlannerScriptTest, AFeasibleGraspHasForcesAPoseAndALift) {
  EXPECT_EQ(Script(kCube + std::string(R"(
    print(gr.count, gr.num_feasible >= 1, gr.r_suc == gr.num_feasible / 4, gr.r_lift <= gr.r_suc)
    local best = gr:best()
    print(best.feasible, best.wrench.feasible, best.ik.solved, #best.wrench.forces == #best.contacts, best.ik.tip_error < 2e-3)
    print(type(best.lift.held), best.lift.direction_W[3] > 0.5, best.moved_mm <= 50)
    for _, x in gr:all() do if x.feasible then
      assert(x.lift.held == best.lift.held or best.lift.held)
      assert(x.lift.held ~= best.lift.held or x.lift.pushes <= best.lift.pushes)
      assert(x.lift.held == (#x.lift.reasons == 0) and #x.lift.text > 0)
    else
      assert(x.lift == nil and not pcall(x.motion, x))
    end end)")),
            "4\ttrue\ttrue\ttrue\ntrue\ttrue\ttrue\ttrue\ttrue\nboolean\ttrue\ttrue\n");
}

TEST_F(PlannerScriptTest, AGraspSaysWhyItIsNotAnother) {
  EXPECT_EQ(Script(kCube + std::string(R"(
    local best, others = gr:best(), 0
    for _, x in gr:all() do
      local why, back = x:why_not(best), best:why_not(x)
      assert(why.text == x:why_not().text)
      if x.step_id == best.step_id then
        assert(why.verdict == "same")
      else
        others = others + 1
        assert(why.verdict == "behind" and back.verdict == "before", why.text)
        assert(x.feasible or why.text:find(x.text, 1, true))
      end
      local number = {}
      for _, item in ipairs(why.items) do number[item.name] = item end
      assert(number.margin.other == best.wrench.margin)
      if x.feasible then
        assert(number.margin.value == x.wrench.margin)
        assert(number.lift_slip.value == x.lift.slip_mm and number.lift_slip.other == best.lift.slip_mm)
      end
      if number.pushes then assert(number.pushes.value == x.lift.pushes and number.pushes.other == best.lift.pushes) end
    end
    print(others)
    local come = {}
    for _, item in ipairs(s:why().items) do come[item.name] = item.value end
    print(come.plans, come.feasible == gr.num_feasible, come.lifting == gr.num_lifting, s:why().text:find("Path 1 came to", 1, true) ~= nil))")),
            "3\n1.0\ttrue\ttrue\ttrue\n");
}

TEST_F(PlannerScriptTest, APlanSaysWhyItIsNotAnotherAndGivesItsWholeTrajectory) {
  EXPECT_EQ(Script(R"(
    local o = run(optimizer())
    local t, other = o:certify{ hold_seconds = 0.05 }, o:certify{ hold_seconds = 0.15 }
    local why = t:why_not(other)
    local item = why.items[1]
    print(item.name, item.value == t.hold_shift_mm, item.other == other.hold_shift_mm, item.limit)
    print(why.text:find(t.step_id, 1, true) ~= nil, why.text:find(other.step_id, 1, true) ~= nil)
    local rank = { worse = -1, alike = 0, better = 1 }
    print(rank[why.verdict] == -rank[other:why_not(t).verdict], t:why_not(t).verdict)
    local rows = t:trace(1)
    print(type(rows), #rows == t.num_steps + 1, #t:trace() < #rows, rows[1].t)
    local last = rows[#rows]
    print(last.X_WO.p[1] == t.object.p[1], last.X_WO.p[3] == t.object.p[3], math.abs(last.t - t.seconds) < 1e-9)
    print((pcall(t.trace, t, 0))))"),
            "hold_shift\ttrue\ttrue\t10.0\ntrue\ttrue\ntrue\talike\nuserdata\ttrue\ttrue\t0.0\n"
            "true\ttrue\ttrue\nfalse\n");
}

TEST_F(PlannerScriptTest, NumbersOfThePlannerAreInTheUnitsThatTheManualSays) {
  EXPECT_EQ(Script(kCube + std::string(R"(
    local function near(what, a, b, share)
      if math.abs(a - b) > (share or 1e-9) * math.max(math.abs(a), math.abs(b), 1e-9) then print(what, a, b) end
    end
    local best, number = gr:best(), {}
    for _, item in ipairs(best:why().items) do number[item.name] = item print(item.name, item.unit) end
    near("tip_error", number.tip_error.value, 1000 * best.ik.tip_error)
    near("clearance", number.clearance.value, 1000 * best.ik.clearance)
    near("height", number.lift_height.value, 1000 * best.lift.height)
    near("slip_mm", number.lift_slip.value, best.lift.slip_mm)
    local m = best:motion(quick) m:finish()
    local joints, wrist, worst, least, last = 0, 0, 0, 1e9, nil
    for frame in m:frames() do
      worst, least = math.max(worst, frame.tip_error_mm), math.min(least, frame.clearance_mm)
      if last then
        local dt = frame.t - last.t
        for name, angle in pairs(frame.q) do joints = math.max(joints, math.abs(angle - last.q[name]) / dt) end
        local way = 0
        for i = 1, 3 do way = way + (frame.X_WH.p[i] - last.X_WH.p[i])^2 end
        wrist = math.max(wrist, math.sqrt(way) / dt)
      end
      last = frame
    end
    near("max_joint_speed", m.summary.max_joint_speed, joints, 0.02)
    near("max_wrist_speed", m.summary.max_wrist_speed, wrist, 0.02)
    near("max_tip_error_mm", m.summary.max_tip_error_mm, worst)
    near("min_clearance_mm", m.summary.min_clearance_mm, least)
    local t = run(optimizer()):certify{ hold_seconds = 0.5 }
    local rows, fastest, force, hold = t:trace(1), 0, 0, nil
    for i, row in ipairs(rows) do
      if not hold and row.t >= t.seconds - 0.5 - 1e-9 then hold = row.X_WO.p end
      for _, f in ipairs(row.fingers) do
        force = math.max(force, math.sqrt(f.f_W[1]^2 + f.f_W[2]^2 + f.f_W[3]^2))
      end
      if i > 1 then
        local a, b = rows[i - 1], row
        local way = 0 for k = 1, 3 do way = way + (b.X_WO.p[k] - a.X_WO.p[k])^2 end
        fastest = math.max(fastest, math.sqrt(way) / (b.t - a.t))
      end
    end
    near("max_speed", t.max_speed, fastest, 0.1)
    near("max_force_N", t.max_force_N, force, 1e-6)
    near("seconds", t.seconds, rows[#rows].t)
    local way = 0 for k = 1, 3 do way = way + (rows[#rows].X_WO.p[k] - hold[k])^2 end
    near("hold_shift_mm", t.hold_shift_mm, 1000 * math.sqrt(way), 0.05))")),
            "margin\t\nmin_normal\tN\ntip_error\tmm\nclearance\tmm\nmoved\tmm\nlift_"
            "height\tmm\nlift_shift\tmm\n"
            "lift_turn\tdeg\nlift_slip\tmm\n");
}

TEST_F(PlannerScriptTest, AllNodesWithTheirScoresAreAView) {
  EXPECT_EQ(Script(R"(
    local g = graph()
    local before = g.nodes
    print(type(before), #before, before[1].s_c)
    g:score()
    local nodes = g.nodes
    for id = 0, 143 do
      local node, same = nodes[id + 1], g:node(id)
      assert(node.id == id and node.s_c == same.s_c and node.s_n == same.s_n and node.rank_n == same.rank_n)
    end
    print(nodes[145], before[1].s_c, #nodes:table(), nodes))"),
            "userdata\t144\t0.0\nnil\t0.0\t144\tArray(144 ContactState)\n");
}

TEST_F(PlannerScriptTest, WhatTheSearchFindsComesAfterTheSamplesAndSaysSo) {
  EXPECT_EQ(Script(kCube + std::string(R"(
    local t = run(pruned(s):paths{ stages = 1 }:next():optimize{ samples = 6, iterations = 2 }):certify{ hold_seconds = 0.1 }
    local both = t:grasps{ samples = 2, points = 100, pairs = 300, max_solves = 1, starts = 2, search_found = 1 }
    local feasible, searched = 0, 0
    for i, x in both:all() do
      local found = i > 2
      assert(x.source == (found and "search" or "generator") and x.sample == (found and i - 2 or i))
      assert(x.step_id:find(found and "^path%.1%.search%.%d" or "^path%.1%.grasp%.%d"), x.step_id)
      assert(x.feasible or not found)
      if found then searched = searched + 1 elseif x.feasible then feasible = feasible + 1 end
    end
    print(searched >= 1, both.count == 2 + searched, both.num_feasible == feasible + searched, both.r_suc == feasible / 2))")),
            "true\ttrue\ttrue\ttrue\n");
}

TEST_F(PlannerScriptTest, AHandMotionIsSolvedKeyByKeyAndFrameByFrame) {
  EXPECT_EQ(Script(kCube + std::string(R"(
    local m = gr:best():motion(quick)
    print(m.order, m.num_solved, m.summary, m.finished)
    local times = {}
    for key in m:keyframes() do
      times[#times + 1] = key.t
      assert(key.step_id:find("^motion%.key%.%d+$") and key.q.THJ4 and #key.X_WH.q == 4 and key.clearance_mm)
    end
    print(#times == m.num_keyframes, times[1] > times[2], times[#times] == 0, m:step())
    local again = 0 for _ in m:keyframes() do again = again + 1 end
    print(again == #times)
    local n, last, failed = 0, -1, 0
    for frame in m:frames() do
      n = n + 1
      assert(frame.number == n and frame.t > last and frame.failed == (frame.loosened == "failed"))
      last = frame.t
      failed = failed + (frame.failed and 1 or 0)
    end
    print(n == m.num_frames, m.finished, m.summary.frames == n, m.summary.failed == failed)
    m:back() print(m.finished, m.num_solved == #times) m:back(1 + #times) print(m.num_solved)
    quick.order = "forward"
    local f = gr:best():motion(quick) f:step() f:step() print(f.order, f.num_solved)
    print(gr:best():motion{}.num_frames > n))")),
            "reverse\t0\tnil\tfalse\ntrue\ttrue\ttrue\tfalse\ntrue\ntrue\ttrue\ttrue\ttrue\n"
            "false\ttrue\n0\nforward\t2\ntrue\n");
}

TEST_F(PlannerScriptTest, AFrameAndAMotionSayWhyTheyAreNotOthers) {
  EXPECT_EQ(Script(kCube + std::string(R"(
    local m, keys = gr:best():motion(quick), {}
    for key in m:keyframes() do keys[#keys + 1] = key end
    local why = keys[1]:why_not(keys[2])
    print(why.items[1].name, why.items[1].value == keys[1].tip_error_mm, why.items[1].other == keys[2].tip_error_mm)
    print(keys[1]:why_not(keys[1]).verdict, why.text:find(keys[2]:why().text, 1, true) ~= nil)
    print((pcall(m.why_not, m, m)))
    m:finish()
    quick.order = "forward"
    local f = gr:best():motion(quick)
    f:finish()
    local against = f:why_not(m)
    print(against.items[1].name, against.items[1].value == f.summary.failed, against.items[1].other == m.summary.failed)
    print(m:why_not(m).verdict))")),
            "tip_error\ttrue\ttrue\nalike\ttrue\nfalse\nfailed\ttrue\ttrue\nalike\n");
}

TEST_F(PlannerScriptTest, AFinishedMotionIsTheRuns) {
  Script(kCube + std::string(R"(
    s:record{ dir = "out/cube", pictures = "none" }
    local m = gr:best():motion(quick)
    for key in m:keyframes() do key:shot{} end
    for _ in m:frames() do end
    s:save())"));
  const LoadedRun run = LoadRun(folder_.path() / "out/cube");
  int failed = 0, resting = 0, lifting = 0;
  double simulated_t = 0.0;
  for (const StepFacts& step : run.steps) {
    if (const auto* grasp = std::get_if<GraspFacts>(&step.details)) {
      const bool collides = grasp->status == "collision" || grasp->status == "not_certified";
      EXPECT_TRUE(grasp->colliding.empty() || (collides && grasp->colliding.size() == 2))
          << step.id;
    }
    const auto* frame = std::get_if<FrameFacts>(&step.details);
    if (frame == nullptr || step.command.verb != Verb::kFrame) continue;
    failed += frame->failed ? 1 : 0;
    EXPECT_GE(frame->simulated_t, simulated_t);  // while it stands still, only the hand moves
    simulated_t = frame->simulated_t;
    if (frame->phase == "approach" || frame->phase == "contact") {
      ++resting;
      EXPECT_FALSE(step.contacts.empty()) << step.id;  // with what it lies on
    }
    if (frame->phase != "lift") continue;
    ++lifting;
    double upward = 0.0;
    for (const FingerFacts& finger : step.fingers) {
      EXPECT_TRUE(finger.on || finger.f_W.isZero());
      upward += finger.f_W.z();
    }
    EXPECT_GT(upward, 0.0) << step.id;
  }
  EXPECT_GT(resting, 0);
  EXPECT_GT(lifting, 0);
  EXPECT_GT(simulated_t, 1.0);
  EXPECT_EQ(run.summary.motion.failed, failed);
  EXPECT_EQ(run.summary.grasps.tried, 4);
  EXPECT_GT(run.summary.wrench.min_normal_N, 0.49);
  EXPECT_EQ(run.manifest["configuration"]["motion"]["fps"], 5.0);
  EXPECT_TRUE(fs::exists(folder_.path() / "out/cube/motion.csv"));
  // A summary of a plan has the start's verdict, asked for or not.
  EXPECT_EQ(run.steps.back().id, "scene.verdict");
  EXPECT_EQ(run.summary.status, "start_graspable");
  EXPECT_EQ(run.steps[run.steps.size() - 2].id,
            "motion.frame." + std::to_string(*run.summary.motion.frames));
}

TEST_F(PlannerScriptTest, EachStepIsInTheRunDirectoryWithItsPicture) {
  EXPECT_EQ(Script(R"(
    local s = session()
    s:record{ dir = "out/lesson", pictures = "key" }
    local o = optimizer(s)
    o:step()
    local small = { size = { 64, 36 }, quality = "draft" }
    o:shot(small) o:step() o:back() o:shot(small)
    o:certify{ hold_seconds = 0.2 }:shot(small)
    local g = graph(s)
    g:shot{ "graph", overlay = { "mesh", "scores" }, size = { 64, 36 }, quality = "draft", file = "out/g.png" }
    print(s:save()))"),
            (folder_.path() / "out/lesson").string() + "\n");
  std::vector<std::string> ids;
  const LoadedRun run = LoadRun(folder_.path() / "out/lesson");
  for (const StepFacts& step : run.steps) ids.push_back(step.id);
  EXPECT_EQ(ids,
            (std::vector<std::string>{"scene.start", "graph.mesh", "graph.score", "graph.prune.1",
                                      "graph.prune.2", "graph.prune.3", "paths.rank.1",
                                      "path.1.mppi.1", "path.1.mppi.2", "path.1.certify"}));
  // No grasp was tried: what comes of a certified plan is not known.
  const bool certified = std::get<CertifyFacts>(run.steps.back().details).certified;
  EXPECT_EQ(run.summary.status.has_value(), !certified);
  EXPECT_FALSE(VerifyManifest(folder_.path() / "out/lesson").has_value());
  EXPECT_EQ(run.manifest["configuration"]["mppi"]["samples"], 6);
  EXPECT_EQ(run.summary.counts.rollouts, 12);
  EXPECT_TRUE(fs::exists(folder_.path() / "out/g.png"));
  EXPECT_TRUE(fs::exists(folder_.path() / "out/lesson/frames/0008_path-1-mppi-1.png"));
}

TEST_F(PlannerScriptTest, TheSameSeedGivesTheSameStepsForAnyThreads) {
  std::string first;
  for (const int threads : {1, 2}) {
    config_.threads = threads;
    const std::string text = Script(R"(
      local o = run(optimizer())
      for _, r in ipairs(o:rollouts()) do print(("%a %a"):format(r.cost, r.weight)) end
      for _, x in o:certify{ hold_seconds = 0.2 }:grasps{ samples = 2, max_solves = 1, starts = 2, search_sets = 4096 }:all() do
        print(x.reason, x.moved_mm)
      end)");
    if (first.empty()) first = text;
    EXPECT_EQ(text, first);
  }
  EXPECT_GT(first.size(), 100U);
}

TEST_F(PlannerScriptTest, WhatMakesNoSenseIsOneLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"session():graph{ triangle = 40 }",
       "graph: unknown key \"triangle\" (did you mean \"triangles\"?)"},
      {"session():graph{ samples = 'x' }",
       "graph: samples: expected a whole number from 1 to 100, got \"x\""},
      {"session():graph{ triangles = 13 }",
       "graph: triangles: expected an even number from 12 to 200, got 13"},
      {"session():graph{ top_percent = math.huge }",
       "graph: top_percent: expected a number from 0.01 to 100, got inf"},
      {"session():graph{ convex_share = -(0 / 0) }",
       "graph: convex_share: expected a number from 0.01 to 1, got nan"},
      {"session():graph{ samples = {} }",
       "graph: samples: expected a whole number from 1 to 100, got a table"},
      {"session():mesh{ triangles = 14.5 }", "mesh: triangles: expected a whole number"},
      {"session():mesh{ triangles = 202 }",
       "mesh: triangles: expected an even number from 12 to 200, got 202"},
      {"session():cloud{ points = 5000 }",
       "cloud: points: expected a whole number from 1 to 4096, got 5000"},
      {"graph():prune()",
       "prune: expected a graph with scores, got one without: call score() first"},
      {"local g = graph() g:score() g:score()",
       "score: expected a graph without scores, got one that has them"},
      {"graph():paths()",
       "paths: expected a graph that has been pruned, got one that has not: call prune() first"},
      {"graph():back()", "back: steps: expected 0 to 0 steps, got 1"},
      {"graph():why(144)", "why: "},
      {"pruned():prune{ top_percent = 1 }",
       "prune: top_percent: expected a graph that is not pruned yet, got one that is"},
      {"pruned():paths{ stages = 9 }", "paths: stages: expected a whole number from 1 to 8, got 9"},
      {"pruned():paths():next():optimize{ sampels = 9 }",
       "optimize: unknown key \"sampels\" (did you mean \"samples\"?)"},
      {"pruned():paths():next():optimize{ samples = 1 }",
       "optimize: samples: expected a whole number from 4 to 4096, got 1"},
      {"pruned():paths():next():optimize{ samples = 4096, knots = 100 }",
       "optimize: mppi.samples: expected at most 414 with paths.stages 2 and mppi.knots 100"},
      {"optimizer():certify{ hold_seconds = -1 }", "certify: "},
      {"optimizer():certify()", "certify: expected at least one step(), got none"},
      {"optimizer():certify({}, {})",
       "certify: stages: expected a list of 1 to 8 stages, got one of 0"},
      {"optimizer():certify({}, { { index = { p_WTargets = { {0, 0, 0} } } } })",
       "certify: stages[1].index.p_OC: expected a point on the object, got nothing"},
      {"optimizer():certify({}, { { thumb = { p_OC = {0, 0, 0}, p_WTargets = { {0, 0, 0}, {0, 0, "
       "0} } "
       "} } })",
       "certify: stages[1].thumb.p_WTargets: expected a list of one point, or of 4, one a knot, "
       "got "
       "one of 2"},
      {"optimizer():certify({}, { { ring = {} } })", "certify: plan[1]: unknown key \"ring\""},
      {"local o = optimizer() o:step() o:fork{ knots = 7 }",
       "fork: knots: expected 4, as before, got 7"},
      {"optimizer().best_csot()",
       "Optimizer: unknown key \"best_csot\" (did you mean \"best_cost\"?)"},
      {"local x = pruned():paths().rank", "Paths: unknown key \"rank\""},
      {"graph():shot{ overlay = { 'meshes' } }",
       "shot: overlay: expected some of forces, cones, contacts, trace, ghost, fingers, axes, "},
      {"pruned():paths()[0]()", "[]: number: expected 1 to 100000, got 0"},
  };
  for (const auto& [line, expected] : cases) {
    EXPECT_EQ(Failure(line).find(expected), 0U) << line << "\n  " << Failure(line);
  }
}

TEST_F(PlannerScriptTest, MissingWeightsAreOneLineThatNamesTheFile) {
  config_.weights = folder_.path() / "nowhere";
  const std::string failure = Failure("session():graph()");
  EXPECT_EQ(failure.find("graph: " + (folder_.path() / "nowhere/score.safetensors").string()), 0U)
      << failure;
}

}  // namespace
}  // namespace pregrasp
