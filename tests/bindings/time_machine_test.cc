// Going about in time, asking why, whole runs and other scenes, from scripts. The networks' weights
// are random (planner_script.h).
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "app/recording/loaded_run.h"
#include "bindings/script.h"
#include "tests/bindings/planner_script.h"

namespace pregrasp {
namespace {

class TimeMachineTest : public PlannerScriptTest {};

TEST_F(TimeMachineTest, ForwardTakesAgainWhatBackTookBack) {
  EXPECT_EQ(Script(R"(
    local o = optimizer() for _ = 1, 3 do o:step() end
    local cost = o.best_cost
    o:back(2) print(o.step_id) o:forward() print(o.step_id) o:forward() print(o.step_id, o.best_cost == cost)
    o:back(1) o:set{ sigma = 0.2 } o:step() print(o.step_id, (pcall(o.forward, o)))
    local g = pruned() g:back(2) g:forward(1) print(g.stage) g:forward() print(g.stage)
    local sim = session():simulate() sim:touch{ finger = "index", p_OC = {0.11, 0, 0.0015} }
    sim:move{ finger = "index", by = {0, 0, -0.012}, seconds = 0.2 } sim:wait{ seconds = 0.1 }
    local p, n = sim.fingers.index.p_WF, sim.num_steps
    sim:back(30) sim:forward(10) sim:back(5) sim:forward(25)
    local q = sim.fingers.index.p_WF
    print(sim.num_steps == n, p[1] == q[1], p[3] == q[3], sim.step_id))"),
            "path.1.mppi.1\npath.1.mppi.2\npath.1.mppi.3\ttrue\n"
            "path.1.mppi.3~2\tfalse\npruned_free\nconnected\ntrue\ttrue\ttrue\tsim.3\n");
}

TEST_F(TimeMachineTest, EveryStepIsFoundAgainByItsIdAsTheObjectThatGoesOnFromIt) {
  EXPECT_EQ(Script(R"(
    local s = session() local o = optimizer(s) o:step() o:step()
    local t = o:certify{ hold_seconds = 0.05 }
    for _, id in ipairs(s.ids) do print(id, s:go(id)) end
    local again = s:go "path.1.mppi.1" again:step() print(again.step_id, again.best_cost == o.best_cost)
    print(s:step("path.1.mppi.2").details.iteration, s:step("scene.start").command.verb)
    local sim = s:simulate{ trace = true } sim:step(3) print(s:go("sim.1").trace.kinetic_J == sim.trace.kinetic_J))"),
            "scene.start\tSession(ruler)\ngraph.mesh\tGraph(meshed, 144 nodes)\n"
            "graph.score\tGraph(scored, 144 nodes)\n"
            "graph.prune.1\tGraph(pruned_context, 144 nodes)\n"
            "graph.prune.2\tGraph(pruned_free, 144 nodes)\n"
            "graph.prune.3\tGraph(connected, 144 nodes)\n" +
                Script("local p = pruned():paths{ stages = 2 }:next() print('paths.rank.1', p)") +
                "path.1.mppi.1\tOptimizer(path 1, iteration 1)\n"
                "path.1.mppi.2\tOptimizer(path 1, iteration 2)\n" +
                Script("local t = (function() local o = optimizer() o:step() o:step() return "
                       "o:certify{ hold_seconds = 0.05 } end)() print('path.1.certify', t)") +
                "path.1.mppi.2\ttrue\n2\topen\ntrue\n");
  EXPECT_EQ(Failure("session():go 'graph.msh'"),
            "go: id: expected the id of a step, got \"graph.msh\"");
}

TEST_F(TimeMachineTest, ASavedStateGoesOnInAnotherProcessToTheLastBit) {
  const std::string first = Script(R"(
    local s = session() local o = optimizer(s) o:step() o:step()
    local other = o:fork{ sigma = 0.3 } other:step()
    print(s:save_state("out/state", o))
    o:step() other:step() print(o.step_id, ("%.17g"):format(o.best_cost), other.step_id, ("%.17g"):format(other.mean_cost)))");
  const std::string second = Script(R"(
    local s, o = pg.load_state "out/state"
    print("out/state", #s.ids, o.step_id)
    local other = s:go "path.1.mppi.3"
    o:step() other:step() print(other.step_id))");
  EXPECT_EQ(second, "out/state\t10\tpath.1.mppi.2\npath.1.mppi.4\n");
  const std::string third = Script(R"(
    local s, o = pg.load_state "out/state"
    local other = s:go "path.1.mppi.3"
    o:step() other:step()
    print(pg.compare(o, other).verdict)
    local again = s:go "path.1.mppi.2" again:step()
    print(again.step_id, ("%.17g"):format(again.best_cost), other.step_id, ("%.17g"):format(other.mean_cost)))");
  const std::string numbers = first.substr(first.find('\n') + 1);
  EXPECT_NE(third.find(numbers), std::string::npos) << first << third;
  EXPECT_EQ(Failure("pg.load_state 'out/nothing'").substr(0, 11), "load_state:");
}

TEST_F(TimeMachineTest, AStateThatWasChangedIsRefused) {
  Script(R"(local s = session() local o = optimizer(s) o:step() s:save_state("out/state", o))");
  std::ofstream(folder_.path() / "out/state/journal.jsonl", std::ios::app) << "\n";
  EXPECT_NE(Failure("pg.load_state 'out/state'").find("journal.jsonl was changed"),
            std::string::npos);
}

TEST_F(TimeMachineTest, AStateCannotLeadOutOfTheSandbox) {
  Script(R"(local s = session() s:simulate():step() s:save_state("out/state"))");
  const auto state = folder_.path() / "out/state";
  const TestFolder elsewhere;
  std::filesystem::rename(state / "scene.json", elsewhere.path() / "scene.json");
  std::filesystem::create_symlink(elsewhere.path() / "scene.json", state / "scene.json");
  EXPECT_EQ(Failure("pg.load_state 'out/state'"),
            "load_state: dir: expected a run of plain files, got a link, scene.json");
  EXPECT_NE(Failure("pg.load_state '" + elsewhere.path().string() + "'").find("load_state:"),
            std::string::npos);
  EXPECT_NE(
      Failure("session():save_state '" + elsewhere.path().string() + "/x'").find("save_state:"),
      std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(elsewhere.path() / "x"));
}

TEST_F(TimeMachineTest, TwoForksSayWhatDiffersFirst) {
  EXPECT_EQ(
      Script(R"(
    local o = optimizer() o:step() local other = o:fork{ sigma = 0.3 }
    print(pg.compare(o, other).verdict)
    o:step() other:step()
    local c = pg.compare(o, other)
    print(c.verdict, c.common, c.a, c.b, c.same_noise, c.command.field, c.command.a, c.command.b)
    print(#c.settings, c.settings[1].field, c.first ~= nil, tostring(c) == c.text)
    o:step() print(pg.compare(o, o:fork()).verdict)
    local before = o:fork() before:back() print(pg.compare(before, o).verdict))"),
      "same\ndiffer\tpath.1.mppi.1\tpath.1.mppi.2\tpath.1.mppi.2~2\ttrue\tmppi.sigma\t1.2\t0.3\n"
      "1\tmppi.sigma\ttrue\ttrue\nsame\none_goes_on\n");
}

TEST_F(TimeMachineTest, AnotherSceneIsASessionOfItsOwn) {
  EXPECT_EQ(Script(R"(
    local s = session() local g = pruned(s)
    local w = g:what_if{ set = { ["environment.table.p"] = {-0.42, 0, -0.02} } }
    local c = pg.compare(g, w)
    print(w.stage, w.top_percent, c.verdict, c.scene.field, c.scene.b, #c.scores > 0, #s.ids)
    print(s:what_if{ set = { ["object.mass"] = 0.05 } }:body("ruler").movable)
    local sim = s:simulate() sim:touch{ finger = "index", p_OC = {0.11, 0, 0.0015} }
    sim:move{ finger = "index", by = {0, 0, -0.012}, seconds = 0.2 }
    local heavy = sim:what_if{ set = { ["object.mass"] = 0.05 } }
    print(heavy.num_steps == sim.num_steps, heavy.step_id, pg.compare(sim, heavy).scene.field))"),
            "connected\t20.0\tdiffer\ttable.p[0]\t-0.42\ttrue\t6\ntrue\ntrue\tsim.2\truler.mass\n");
  EXPECT_EQ(Failure("session():what_if{ set = { ['environment.table.mass'] = 1 } }"),
            "what_if: set: expected a mass for bodies that move, got one for table");
}

TEST_F(TimeMachineTest, WhyAnswersFromTheDecisionsOwnNumbers) {
  EXPECT_EQ(
      Script(R"(
    local g = pruned() local paths = g:paths{ stages = 2 } local p = paths:next()
    print(p:why().text == paths:why(1).text, p:why().items[1].name, p:why().items[1].value == p.value)
    local order = paths[2]:why_not(p) print(order.verdict, order.items[1].other == p.value)
    print(p:why_not(paths[2]).verdict, p:why_not(p).verdict)
    local o = p:optimize{ samples = 6, iterations = 4, patience = 9 } o:step()
    local rollouts, best = o:rollouts(), 1
    for i, r in ipairs(rollouts) do if r.cost < rollouts[best].cost then best = i end end
    local why = o:why() print(why.verdict, why.items[1].name, why.items[1].value == rollouts[best].cost)
    local sum = 0 for i = 2, #why.items do sum = sum + why.items[i].value end
    print(math.abs(sum - rollouts[best].cost) < 1e-9)
    local not_best = best % 6 + 1
    local against = o:why_not(not_best)
    print(against.items[1].value == rollouts[not_best].cost, against.items[1].other == rollouts[best].cost)
    local t = o:certify{ hold_seconds = 0.05 } print(t:why().verdict == (t.certified and "certified" or "not_certified"))
    for _, item in ipairs(t:why().items) do if item.name == "hold_shift" then print(item.value == t.hold_shift_mm, item.limit, item.unit, item.met == (item.value <= 10)) end end
    print((pcall(o.why, o, 7))))"),
      "true\tvalue\ttrue\nbehind\ttrue\nbefore\tsame\nbest\ttotal\ttrue\ntrue\ntrue\ttrue\ntrue\n"
      "true\t10.0\tmm\ttrue\nfalse\n");
}

TEST_F(TimeMachineTest, RolloutsTellTheirPlansAndTheirWay) {
  EXPECT_EQ(Script(R"(
    local o = optimizer() print(o.nominal, #o.plans, o.sigma, o.settings.samples) o:step()
    local elite = o:elite(3) print(#elite, elite[1].weight >= elite[2].weight)
    local r = o:rollout(elite[1].number)
    print(r.cost == elite[1].cost, #r.stages, #r.stages[1].thumb.knots == (r.stages[1].thumb.on and 4 or 0), elite[1].stages)
    local rows = o:trace(elite[1].number, 20)
    local d = 0 for i = 1, 3 do d = math.max(d, math.abs(rows[#rows].X_WO.p[i] - r.X_WO.p[i])) end
    print(d == 0, rows[1].t, #o:trace() > #rows)
    print(#o.plans > 0, o.plans[1].cost == o.best_cost, #o.nominal)
    o:set{ sigma = 0.5, final_sigma = 0.5 } print(o.sigma, o.settings.sigma) o:step() print(o.step_id, o.sigma)
    o:back() o:set_nominal(3) o:step() print(o.step_id) o:run() print(o.iteration)
    o:back(2) print(o:run(1), o.iteration))"),
            "nil\t0\t1.2\t6.0\n3\ttrue\ntrue\t2\ttrue\tnil\ntrue\t0.0\ttrue\ntrue\ttrue\t2\n"
            "0.5\t0.5\npath.1.mppi.2\t0.5\npath.1.mppi.2~2\n4\nfalse\t3\n");
  EXPECT_EQ(Failure("local o = optimizer() o:set_nominal(1)"),
            "set_nominal: number: expected a rollout of the last iteration, 1 to 0, or 0 for the "
            "mean, got 1");
}

TEST_F(TimeMachineTest, NodesTrianglesAndPathsAreFoundByWhatTheyAre) {
  EXPECT_EQ(Script(R"(
    local g = pruned()
    print(g:node{ thumb = 3, index = 5 }.id == 3 * 12 + 5, g:why{ thumb = 3, index = 5 }.id == 41)
    local t = g:triangles{ finger = "index", count = 2 }
    print(#t, t[1].best == g:top(1)[1].s_c, t[1].triangle == g:top(1)[1].index, t[1].node == g:top(1)[1].id)
    local m = g.mesh print(#m.normals, #m.areas, #m.centres, #m.neighbors[1], m.areas[1] > 0)
    local all = g:paths{ stages = 2 } print(#all == all.count)
    local last = all[3].nodes[2].id
    local some = g:paths{ stages = 2, filter = function(p) return p.nodes[2].id == last end }
    print(some[1].nodes[2].id == last, some:next().rank == some[1].rank, some:top(2)[1].rank == some[1].rank)
    local hand = g:path{ 5, { thumb = 1, index = 2 } }
    print(hand.rank, hand.step_id, hand.nodes[2].id, #hand.siblings, hand:why().verdict)
    local o = hand:optimize{ samples = 4, iterations = 1 } o:step() print(o.step_id)
    local count = 0 for _ in pairs(g:why(3)) do count = count + 1 end print(count))"),
            "true\ttrue\n2\ttrue\ttrue\ttrue\n12\t12\t12\t3\ttrue\ntrue\ntrue\ttrue\ttrue\n"
            "0\tpaths.hand\t14\t0\thand\npath.0.mppi.1\n9\n");
  EXPECT_EQ(Failure("local g = pruned() g:paths{ filter = 3 }"),
            "paths: filter: expected a function, got 3");
  EXPECT_EQ(Failure("local g = pruned() g:paths{ filter = function() error 'no' end }:next()"),
            "no");
}

TEST_F(TimeMachineTest, APathMadeByHandIsNotWithinTheRules) {
  Script(R"(
    local s = session() local o = pruned(s):path{ 5, 14 }:optimize{ samples = 4, iterations = 2 }
    o:step() s:save_state("out/hand", o))");
  EXPECT_EQ(LoadRun(folder_.path() / "out/hand").summary.within_rules, false);
  Script(R"(local s = session() local o = optimizer(s) o:step() s:save_state("out/own", o)
    o:set_nominal(2) o:step() s:save_state("out/picked", o))");
  EXPECT_EQ(LoadRun(folder_.path() / "out/own").summary.within_rules, true);
  EXPECT_EQ(LoadRun(folder_.path() / "out/picked").summary.within_rules, false);
}

TEST_F(TimeMachineTest, ReadyMadeConditionsStopPhysicsAndThePlanner) {
  EXPECT_EQ(Script(R"(
    local s = session() local sim = s:simulate() print(s.stopped)
    sim:touch{ finger = "index", p_OC = {0.11, 0, 0.0015} }
    s:break_when "contact_made" print(sim:move{ finger = "index", by = {0, 0, -0.012}, seconds = 0.2 }, s.stopped.by, s.stopped.text)
    s:break_when{ "slip", "contact_lost" } print(sim:move{ finger = "index", by = {0.3, 0, 0}, seconds = 0.6 }, s.stopped.by)
    s:break_when "new_best"
    local o = optimizer(s) print(o:run(), o.iteration, s.stopped.step_id, s.stopped.by)
    s:break_when(function(ev) return ev.kind == "iterate" and ev.step_id == "path.1.mppi.3" end)
    print(o:run(), o.iteration, s.stopped.by)
    s:break_when{ "certified", "certify_failed" } o:certify{ hold_seconds = 0.05 } print(s.stopped.step_id)
    s:break_when "search_ended" print(o:run(), o.iteration, s.stopped.text))"),
            "nil\ntrue\tcontact_made\tindex and ruler\ntrue\tslip\n"
            "true\t1\tpath.1.mppi.1\tnew_best\ntrue\t3\tfunction\npath.1.certify\n"
            "true\t4\tthe limit of iterations ends it\n");
  EXPECT_EQ(Failure("session():break_when 'contact_mode'"),
            "break_when: predicate: expected \"contact_made\", got \"contact_mode\"");
}

TEST_F(TimeMachineTest, AWholeRunIsTakenStepByStepBackAndForth) {
  const std::string options =
      R"({ paths = 1, set = { ["mesh.triangles"] = 12, ["graph.samples"] = 1, ["screen.paths"] = 1,
          ["mppi.samples"] = 6, ["mppi.iterations"] = 2, ["graph.top_percent"] = 20, ["grasps.samples"] = 1,
          ["grasps.search_sets"] = 0, ["grasps.max_solves"] = 1, ["grasps.starts"] = 1 } })";
  EXPECT_EQ(Script("local s = session() local plan = s:plan" + options + R"(
    print(plan, plan:why().verdict, plan:step(), plan.step_id)
    print(plan:step(2), plan.step_id, plan.num_steps)
    plan:run "path.1.mppi.1" print(plan.step_id, plan:object().best_cost ~= nil)
    local count = plan.num_steps
    plan:back(4) print(plan.num_steps == count - 4) plan:forward(4) print(plan.step_id)
    plan:run "graph.score" print(plan.num_steps, plan:run "path.1.mppi.1", plan.num_steps == count, plan.finished)
    print(select(2, pcall(plan.run, plan, "foo")):match("to: .*"), plan.num_steps == count)
    s:break_when "search_ended" print(plan:run(), plan.step_id)
    s:break_when(nil) plan:next_stage() plan:run()
    print(plan.finished, plan.status == plan:why().verdict, plan:step(), #plan.reasons)
    local whole = session():plan)" +
                   options + R"( whole:run()
    print(whole.num_steps == plan.num_steps, whole.end_id == plan.end_id, pg.compare(plan, whole).verdict)
    print(s:why().verdict == plan.status)
    local path = tonumber(plan.end_id:match "%d+")
    print(plan:why_not(path).verdict, plan:why_not(path).text == s:why_not(path).text)
    local never = plan:why_not(9999) print(never.verdict, never.text:find("Path 9999 was not tried", 1, true) ~= nil)
    print(never.items[1].value, never.items[#never.items].name, (pcall(plan.why_not, plan, 0))))"),
            "Plan(1 step)\topen\ttrue\tscene.verdict\ntrue\tgraph.score\t3\npath.1.mppi.1\ttrue\n"
            "true\npath.1.mppi.1\n3\tfalse\ttrue\tfalse\n"
            "to: expected the id of a step of a run, as \"path.1.mppi.3\", got \"foo\"\ttrue\n"
            "true\tpath.1.mppi.2\ntrue\ttrue\tfalse\t1\ntrue\ttrue\tsame\ntrue\n"
            "same\ttrue\nworse\ttrue\nnil\tlifting\tfalse\n");
}

TEST_F(TimeMachineTest, ACheckIsOfTheSceneAndOfOneThatCannotBeOpened) {
  EXPECT_EQ(Script(R"(
    print(session():check().clean, pg.check("scenes/ruler.lua").clean)
    local scene = pg.scene{ name = "in", object = { shape = pg.box{ 0.1, 0.1, 0.1 }, mass = 0.1, p = { 0, 0, 0.04 } },
      environment = { { name = "table", shape = pg.box{ 1, 1, 0.1 }, p = { 0, 0, -0.05 } } } }
    local check = pg.check(scene) print(check.clean, check.findings[1].severity, check.text:find("overlap") ~= nil))"),
            "true\ttrue\nfalse\terror\ttrue\n");
}

}  // namespace
}  // namespace pregrasp
