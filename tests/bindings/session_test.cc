// Scripts in the real machine, one claim at a time. Scenes are built in the script.
#include <gtest/gtest.h>

#include <pthread.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <string>
#include <thread>

#include "app/core/interrupt.h"
#include "app/geometry/point_cloud.h"
#include "bindings/script.h"
#include "tests/bindings/lua_text.h"
#include "tests/geometry/write_mesh.h"

namespace pregrasp {
namespace {

using ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStdout;

// A 0.2 kg cube on a table, and a movable neighbour.
const char* const kSessionPrelude = R"(local pg = require "pregrasp"
local table_body = { name = "table", shape = pg.box{1, 1, 0.1}, p = {0, 0, -0.05}, friction = 0.4 }
local function cube(name, x)
  return { name = name, shape = pg.box{0.1, 0.1, 0.1}, mass = 0.2, p = {x, 0, 0.05}, friction = 0.4 }
end
local function open(options)
  return pg.open(pg.scene{ name = "cube", object = cube("cube", 0), environment = { table_body, cube("left", 0.2) } }, options)
end
)";

ScriptConfig ConfigIn(const TestFolder& folder) {
  ScriptConfig config;
  config.output = folder.path() / "out";
  return config;
}

// What the script prints.
std::string RunIn(const TestFolder& folder, const std::string& body, ScriptConfig config) {
  const auto file = folder.Write("test.lua", kSessionPrelude + body);
  CaptureStdout();
  try {
    RunScript(file, {}, config);
  } catch (...) {
    GetCapturedStdout();
    throw;
  }
  return GetCapturedStdout();
}

std::string Script(const std::string& body) {
  const TestFolder folder;
  return RunIn(folder, body, ConfigIn(folder));
}

// The line with which the script's last line fails, after "test.lua:9: ".
std::string Failure(const std::string& line) {
  try {
    Script(line);
  } catch (const InputError& error) {
    const std::string message = error.what();
    const std::string marker = "test.lua:9: ";
    const std::size_t at = message.find(marker);
    return at == std::string::npos ? "not of the line: " + message
                                   : message.substr(at + marker.size());
  }
  return "no failure";
}

TEST(SessionBindingTest, ReadsTheSceneAndItsStart) {
  EXPECT_EQ(
      Script("local s = open() print(s, s.name, s.seed, #s.bodies, s.bodies[3], s.object.p[3], "
             "s:body('left').p[1], s.step_id, s.file == '', #s.departures)"),
      "Session(cube)\tcube\t1\t3\tleft\t0.05\t0.2\tscene.start\ttrue\t0\n");
}

TEST(SessionBindingTest, SettlesAndSaysHowFarThingsWent) {
  EXPECT_EQ(Script("local s = open() local r = s:settle{seconds = 0.5}\n"
                   "print(r.at_rest, r.moved_mm < 0.01, r.rotated_deg < 0.01, s.step_id)"),
            "true\ttrue\ttrue\tscene.settle\n");
}

TEST(SimulationBindingTest, APushMovesTheObjectAndGivesItsForces) {
  // The cube weighs 1.96 N: the table holds it with up to 0.78 N, the finger pushes with 50 N/m.
  EXPECT_EQ(Script(R"(
    local sim = open():simulate()
    sim:touch{ finger = "index", p_OC = {-0.05, 0, -0.02} }
    sim:move{ finger = "index", by = {0.010, 0, 0}, seconds = 0.5 }
    print(math.abs(sim.object.p[1]) < 1e-4, sim.fingers.index.touching, sim.fingers.thumb.on)
    print(("%.2f"):format(sim.fingers.index.force_N))
    sim:move{ finger = "index", by = {0.050, 0, 0}, seconds = 1 }
    print(sim.object.p[1] > 0.03, sim.object.p[1] < 0.05, sim.step_id, #sim.contacts >= 4)
    for _, c in ipairs(sim.contacts) do assert(c.force_N >= 0 and c.a and c.b and c.gap_mm < 1) end
    sim:lift{ finger = "index" } print(sim.fingers.index.on))"),
            "true\ttrue\tfalse\n0.50\ntrue\ttrue\tsim.3\ttrue\nfalse\n");
}

TEST(SimulationBindingTest, TellsOverlapAndEnergiesWhereATraceIsAskedFor) {
  EXPECT_EQ(Script(R"(
    local s = open()
    print(s:simulate().trace, s:simulate{ trace = true }.trace)
    local sim = s:simulate{ trace = true }
    sim:step(240)
    print(("%.4f"):format(sim.trace.potential_J / 9.81 / sim.object.p[3]), sim.trace.kinetic_J < 1e-9)
    print(sim.trace.max_penetration_mm < 0.05)
    local plain = s:simulate() plain:step() print(plain.trace))"),
            "nil\tnil\n0.4000\ttrue\ntrue\nnil\n");
}

TEST(SimulationBindingTest, GoesBackExactlyAndForksGoTheirOwnWay) {
  EXPECT_EQ(Script(R"(
    local sim = open():simulate()
    sim:touch{ finger = "index", p_OC = {-0.05, 0, 0} }
    sim:move{ finger = "index", by = {0.03, 0, 0}, seconds = 0.5 }
    local t, x, steps = sim.t, sim.object.p[1], sim.num_steps
    local fork = sim:fork()
    fork:move{ finger = "index", by = {0.02, 0, 0}, seconds = 0.3 }
    print(sim.t == t, sim.object.p[1] == x, fork.object.p[1] > x, fork.num_steps > steps)
    fork:back(fork.num_steps - steps)
    print(fork.t == t, fork.object.p[1] == x, fork.step_id)
    local again = sim:fork()
    sim:step(30) again:step(30)
    print(sim.object.p[1] == again.object.p[1], sim.num_steps == steps + 30)
    sim:back(sim.num_steps) print(sim.t, sim.num_steps, sim.step_id))"),
            "true\ttrue\ttrue\ttrue\ntrue\ttrue\tsim.2\ntrue\ttrue\n0.0\t0\tsim.1\n");
}

TEST(SimulationBindingTest, SimulationsStandStillWhileBreakWhensFunctionIsAsked) {
  EXPECT_EQ(Script(R"(
    local s, other = open(), open()
    local x, y, z = s:simulate(), s:simulate(), other:simulate()
    x:step(20)
    local refused
    s:break_when(function(ev)
      refused = not pcall(x.back, x, 5) and not pcall(y.step, y) and not pcall(x.fork(x).step, y)
      z:step(2)  -- of another session: nothing to do with this one
      return true
    end)
    print(x:step(3), refused, x.num_steps, y.num_steps, z.num_steps)
    s:break_when(function(ev) s:break_when(nil) return ev.num_steps == 23 end)
    print(x:step(5), x.num_steps, x:step(1), x.num_steps))"),
            "true\ttrue\t21\t0\t2\ntrue\t23\tfalse\t24\n");
}

TEST(SimulationBindingTest, GoingBackIntoAnActionIsTheActionStoppedThere) {
  EXPECT_EQ(Script(R"(
    local s = open()
    local a, b = s:simulate(), s:simulate()
    a:step(20) b:step(50)
    b:back(30) print(a.object.p[1] == b.object.p[1], b.num_steps, b.step_id)
    a:back(20) print(a.num_steps, a.step_id)
    b:step(30) print(b.num_steps, b.step_id))"),
            "true\t20\tsim.1~3\n0\tscene.start\n50\tsim.2~3\n");
}

TEST(SimulationBindingTest, BreakWhenEndsAnActionAtTheStepItAsksFor) {
  EXPECT_EQ(Script(R"(
    local s = open()
    s:record{ dir = "out/run", pictures = "none" }
    local sim = s:simulate()
    sim:touch{ finger = "index", p_OC = {-0.05, 0, -0.02} }
    local free = sim:fork()
    local kinds = {}
    s:break_when(function(ev)
      kinds[ev.kind] = (kinds[ev.kind] or 0) + 1
      assert((ev.penetration == nil) == (ev.kind ~= "contact") and (ev.finger == nil) == (ev.kind ~= "finger"))
      return ev.kind == "step" and ev.speed > 0.01
    end)
    print(sim:move{ finger = "index", by = {0.060, 0, 0}, seconds = 1 }, sim.step_id, sim.t < 0.9)
    print(kinds.step == sim.num_steps, kinds.contact > kinds.step, kinds.finger == kinds.step - 1)
    local speed = sim.object.v[1] print(speed > 0.01, speed < 0.012)
    local stopped = sim.num_steps
    s:break_when(nil)
    print(sim:wait{ seconds = 0.1 }, free:move{ finger = "index", by = {0.060, 0, 0}, seconds = 1 })
    free:back(free.num_steps - stopped) print(free.object.v[1] == speed)
    s:break_when(function(ev) return ev.kind == "finger" and ev.slip_mm > 1e9 end)
    print(sim:step(5))
    s:break_when(function(ev) error("no") end)
    print(pcall(sim.step, sim, 1)))")
                .find("true\tsim.2\ttrue\ntrue\ttrue\ttrue\ntrue\ttrue\nfalse\tfalse\ntrue\n"
                      "false\nfalse\t"),
            0U);
}

TEST(SessionBindingTest, APredicateThatNeverEndsIsStopped) {
  const TestFolder folder;
  ScriptConfig config = ConfigIn(folder);
  config.machine.seconds = 0.05;
  try {
    RunIn(folder,
          "local s = open() s:break_when(function() while true do end end) s:simulate():step()",
          config);
    FAIL() << "no failure";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("out of time"), std::string::npos) << error.what();
  }
}

TEST(SessionBindingTest, SetChangesValuesAndTheSeedIsTheSessions) {
  EXPECT_EQ(Script("local s = open{ seed = 7, set = { ['object.mass'] = 0.3, "
                   "['environment.left.p'] = {0.3, 0, 0.05} } }\n"
                   "print(s.seed, s:body('left').p[1])"),
            "7\t0.3\n");
}

TEST(SessionBindingTest, GivesCloudDistanceAndMesh) {
  EXPECT_EQ(Script(R"(
    local s = open()
    local cloud, mesh = s:cloud{ points = 100 }, s:mesh{ triangles = 40 }
    print(cloud.count, #cloud.points, #cloud.normals, mesh.num_triangles, #mesh.triangles, #mesh.vertices == mesh.num_vertices)
    local d = s:distance{0, 0, 0.3}
    print(("%.3f %.3f"):format(d.phi, d.nhat[3])))"),
            "100\t100\t100\t40\t40\ttrue\n0.250 0.800\n");
}

TEST(SessionBindingTest, OpensAnObjectAndAnEnvironmentThatAreClouds) {
  const TestFolder folder;
  const auto write = [&](const std::string& name, const Shape& shape) {
    const TriangleMesh points{SamplePointCloud(shape, 1500, Rng(1)).P, MatrixX3i(0, 3)};
    folder.Write(name, testing::PlyText(points, "binary_little_endian"));
  };
  write("can.ply", Cylinder{0.033, 0.1});
  write("slab.ply", Box{Vector3(0.2, 0.2, 0.03)});
  folder.Write("clouds.lua", R"(return scene {
    name = "clouds",
    object = { shape = cloud{"can.ply"}, mass = 0.2, p = {0, 0, 0.0501} },
    environment = { { name = "slab", shape = cloud{"slab.ply"}, p = {0, 0, -0.0151} } },
  })");
  EXPECT_EQ(RunIn(folder, R"(
    local s = pg.open "clouds.lua"
    local r = s:settle{ seconds = 0.2 }
    print(r.at_rest, s:cloud{ points = 64 }.count, s:mesh{ triangles = 40 }.num_triangles)
    print(math.abs(s:distance{ 0, 0, 0.02 }.phi - 0.02) < 0.002)
    s:record{ dir = "out/run", pictures = "key" }
    s:shot{}
    print(#s:save() > 0))",
                  ConfigIn(folder)),
            "true\t64\t40\ntrue\ntrue\n");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/run/frames"));
}

TEST(SessionBindingTest, TheSameScriptAndSeedGiveTheSameBytesForAnyThreads) {
  const TestFolder folder;
  const std::string body = R"(
    local s = open()
    s:record{ dir = "out/run", pictures = "none" }
    s:settle{ seconds = 0.2 }
    local sim = s:simulate()
    sim:touch{ finger = "thumb", p_OC = {-0.05, 0.01, 0} }
    sim:move{ finger = "thumb", by = {0.04 + 0.01 * math.random(), 0, 0}, seconds = 0.5 }
    s:save())";
  std::vector<std::vector<std::string>> runs;
  for (const int threads : {1, 2, 5}) {
    ScriptConfig config = ConfigIn(folder);
    config.threads = threads;
    config.output = folder.path() / ("out" + std::to_string(threads));
    RunIn(folder, body, config);
    std::vector<std::string> files;
    for (const char* name : {"scene.json", "steps.jsonl", "rollout.csv", "run.rawlog"}) {
      std::ifstream in(config.output / "run" / name, std::ios::binary);
      files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
      EXPECT_GT(files.back().size(), 100U) << name;
    }
    runs.push_back(files);
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0], runs[2]);
}

TEST(SessionBindingTest, ARecordingThatIsNotSavedIsFinishedAtTheEndAndAfterAFailure) {
  const TestFolder folder;
  const std::string body =
      "local s = open() s:record{ dir = 'out/run', pictures = 'none' } s:simulate():wait{ seconds "
      "= 0.1 }\n";
  RunIn(folder, body, ConfigIn(folder));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/run/summary.json"));
  std::filesystem::remove_all(folder.path() / "out");
  EXPECT_THROW(RunIn(folder, body + "error 'on purpose'", ConfigIn(folder)), InputError);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/run/summary.json"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out/run.partial"));
}

TEST(SessionBindingTest, WritesOnlyBelowTheOutputFolder) {
  for (const char* path : {"elsewhere", "/tmp/pregrasp_elsewhere", "out/../..", "out/../elsewhere",
                           "../out/x", "", "."}) {
    const std::string message = Failure(std::string("open():record{ dir = '") + path + "' }");
    EXPECT_EQ(message.find("record: "), 0U) << path << ": " << message;
    EXPECT_NE(message.find("expected a path in the output folder"), std::string::npos) << message;
  }
}

TEST(SessionBindingTest, WrongCallsSayWhatWasExpected) {
  const std::pair<const char*, const char*> cases[] = {
      {"pg.open()", "open: scene: expected a scene file's name or a scene, got nothing"},
      {"pg.open(3)", "open: scene: expected a scene file's name or a scene, got 3"},
      {"pg.open('nowhere.lua')", "open: nowhere.lua: expected a file, got nothing of that name"},
      {"pg.open('/etc/passwd')",
       "open: /etc/passwd: expected a file in the working directory, the script's folder or the "
       "assets, got one elsewhere"},
      {"open{ sed = 1 }", "not of the line: "},
      {"pg.opn('x')", "pregrasp: unknown key \"opn\" (did you mean \"open\"?)"},
      {"pg.seed = 2", "\"seed\" cannot be set: this table can only be read"},
      {"local s = open() s.nme = 1", "Session: unknown key \"nme\" (did you mean \"name\"?)"},
      {"local s = open() s.name = 'x'", "Session: \"name\" can only be read"},
      {"local s = open() return s.objet",
       "Session: unknown key \"objet\" (did you mean \"object\"?)"},
      {"local s = open() s.settle{}",
       "settle: expected a Session before a colon (x:settle), got a table"},
      {"open():settle{ second = 1 }", "settle: unknown key \"second\" (did you mean \"seconds\"?)"},
      {"open():settle{ seconds = '1' }", "settle: seconds: expected a number, got \"1\""},
      {"open():settle{ seconds = -1 }",
       "settle: seconds: expected above 0 and at most 300 s, got -1"},
      {"open():settle(1)", "settle: expected a table with seconds = .. and so on, got 1"},
      {"open():settle({}, 2)", "settle: expected (options), got 2 arguments"},
      {"open():simulate(1)", "simulate: expected a table with trace = .. and so on, got 1"},
      {"open():simulate():fork(1)", "fork: expected no arguments, got 1 arguments"},
      {"open():simulate():touch{ finger = 'toe', p_OC = {0, 0, 0} }",
       "touch: finger: expected a finger (thumb, index, middle, ring or little), got \"toe\""},
      {"open():simulate():touch{ finger = 'index' }",
       "touch: p_OC: expected three numbers {x, y, z}, got nothing"},
      {"open():simulate():move{ finger = 'index', by = {0, 0, 0} }",
       "move: finger: expected a finger that touches, got \"index\", which is off"},
      {"open():simulate():move{ finger = 'index' }",
       "move: by: expected either by = {..} or to = {..}, got neither"},
      {"open():simulate():back(1)", "back: steps: expected 0 to 0 steps, got 1"},
      {"open():simulate():step(1.5)", "step: steps: expected a whole number, got 1.5"},
      {"open():simulate():step(-1)", "step: steps: expected a count of at least 0, got -1"},
      {"open():simulate():wait{ seconds = 1e9 }", "wait: seconds: expected 0 to 300 s, got 1e+09"},
      {"open():simulate():body('lef')",
       "body: name: expected a body of the scene, got \"lef\" (did you mean \"left\"?)"},
      {"return open():simulate().object.movabel",
       "Body: unknown key \"movabel\" (did you mean \"movable\"?)"},
      {"open():simulate().fingers.index.on = true", "no failure"},
      {"open():simulate().fingers.index.slip = true",
       "Finger: unknown key \"slip\" (the keys are on, touching, slipping, force_N, "},
      {"open():shot{ quality = 'best' }",
       "shot: quality: expected \"draft\", \"normal\" or \"still\", got \"best\""},
      {"open():shot{ overlay = {'force'} }",
       "shot: overlay: expected some of forces, cones, contacts, trace, ghost, fingers, axes, "},
      {"open():shot{ file = 'out/x.jpg' }",
       "shot: file: expected the name of a picture, \"out/NAME.png\", got \"out/x.jpg\""},
      {"open():shot{ font_scale = 9 }", "shot: font_scale: expected a number from 0.3 to 4, got 9"},
      {"open():shot{ size = {1, 2, 3} }",
       "shot: size: expected {width, height} in pixels, got a table"},
      {"open():save()", "save: dir: expected a folder, as nothing is recorded, got nothing"},
      {"open():record{ dir = 'out/x', pictures = 'some' }",
       "record: pictures: expected \"none\", \"key\" or \"all\", got \"some\""},
      {"pg.open(pg.box{1, 1, 1})",
       "open: scene: expected a scene file's name or a scene, got a Shape"},
  };
  for (const auto& [line, expected] : cases) {
    EXPECT_EQ(Failure(line).find(expected), 0U) << line << "\n  " << Failure(line);
  }
}

TEST(SessionBindingTest, AScriptsErrorInASceneFileNamesBothLines) {
  const TestFolder folder;
  folder.Write("bad.lua", "return scene {\n  name = 'bad', objct = {} }");
  try {
    RunIn(folder, "pg.open('bad.lua')", ConfigIn(folder));
    FAIL() << "no failure";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("test.lua:9: open: "), std::string::npos) << message;
    EXPECT_NE(message.find("bad.lua:1: unknown key \"objct\" (did you mean \"object\"?)"),
              std::string::npos)
        << message;
  }
}

TEST(SessionBindingTest, AnInterruptEndsALoopOfSlowCallsAtOnce) {
  // Few instructions of Lua run between them: its hook would come after dozens.
  using Clock = std::chrono::steady_clock;
  Clock::time_point asked;
  std::thread interrupter([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    asked = Clock::now();
    RequestInterrupt();
  });
  EXPECT_THROW(Script("local s = open() while true do s:mesh{ triangles = 40 } end"), Interrupted);
  const double seconds = std::chrono::duration<double>(Clock::now() - asked).count();
  interrupter.join();
  ClearInterrupt();
  EXPECT_LT(seconds, 0.3);
}

// The thread's time from the interrupt, which comes after `delay`, to the script's end [s]. Not the
// clock's, which counts whatever else the machine does.
double SecondsToStop(const std::string& body, std::chrono::milliseconds delay) {
  clockid_t clock{};
  pthread_getcpuclockid(pthread_self(), &clock);
  const auto seconds = [&] {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double begin = seconds();
  double asked = 0.0;
  std::thread interrupter([&] {
    while (seconds() - begin < 1e-3 * static_cast<double>(delay.count())) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    asked = seconds();
    RequestInterrupt();
  });
  EXPECT_THROW(Script(body), Interrupted);
  const double ended = seconds();
  interrupter.join();
  ClearInterrupt();
  return ended - asked;
}

TEST(SessionBindingTest, AnInterruptEndsALongCallWithinAThirdOfASecond) {
  const std::string calls[] = {
      // the cloud's surface is reconstructed, points are spread
      "while true do pg.open('scenes/paper_roll_cloud.lua'):cloud{ points = 4096 } end",
      "while true do open():graph{ triangles = 200 }:score() end",
      "while true do open():verdict() end",
      "local s = open() while true do s:shot{ file = 'out/a.png', size = { 3840, 2160 } } end",
  };
  for (const std::string& call : calls) {
    for (const int milliseconds : {100, 500, 1000}) {
      EXPECT_LT(SecondsToStop(call, std::chrono::milliseconds(milliseconds)), 0.3)
          << call << ", " << milliseconds << " ms";
    }
  }
}

TEST(SessionBindingTest, BigListsAreViewsThatReadAsTables) {
  EXPECT_EQ(Script(R"(
    local s = open()
    local c = s:cloud{ points = 50 }
    local points = c.points
    print(type(points), points, #points, points.count, points[0], points[51], #points[1])
    local n, last = 0 for i, p in ipairs(points) do n, last = n + 1, p assert(i == n) end
    local m = 0 for i, p in pairs(points) do m = m + 1 assert(p[3] == points[i][3]) end
    print(n, m, last[1] == points[50][1])
    local copy = points:table()
    copy[1] = copy[2] table.sort(copy, function(a, b) return a[1] < b[1] end)
    print(#copy, #points, copy[1][1] <= copy[50][1])
    print(select(2, pcall(function() points[1] = {0, 0, 0} end)):match "Array.*")
    local mesh = s:mesh{ triangles = 12 }
    print(#mesh.vertices, #mesh.triangles, #mesh.normals, #mesh.areas, #mesh.centres, #mesh.neighbors)
    local area = 0 for _, a in ipairs(mesh.areas) do area = area + a end
    print(("%.4f"):format(area), table.concat(mesh.neighbors[1], ' ') ~= '', mesh.triangles[1][1] >= 1)
    -- a list is taken where a table is
    print(pg.wrench{ p = points, n = c.normals, mu = 0.5 }.status ~= '')
  )"),
            "userdata\tArray(50 Vector3)\t50\t50\tnil\tnil\t3\n50\t50\ttrue\n50\t50\ttrue\n"
            "Array: can only be read; x:table() is a copy to change\n"
            "8\t12\t12\t12\t12\t12\n0.0600\ttrue\ttrue\ntrue\n");
}

TEST(SessionBindingTest, ARowOfAViewIsOneToo) {
  EXPECT_EQ(Script(R"(
    local s = open()
    local mesh = s:mesh{ triangles = 12 }
    local vertices, triangles, copy = mesh.vertices, mesh.triangles, mesh.vertices:table()
    local row = vertices[2]
    for _, change in ipairs{ function() vertices[2][1] = 5 end, function() row[1] = 5 end, function() triangles[1][4] = 1 end } do
      print((select(2, pcall(change)):match "Array.*"))
    end
    print(row, triangles[1], math.type(triangles[1][1]), #row, row[4])
    print(table.concat(row, ' ') == table.concat(copy[2], ' '), select('#', table.unpack(row)))
    copy[2][1] = 5
    print(copy[2][1], row[1] == vertices[2][1], row:table()[3] == row[3])
    -- a row is taken where a vector is
    print(s:distance(row).phi == s:distance(row:table()).phi)
    local ok, refusal = pcall(s.what_if, s, { set = { ["object.p"] = row } })
    print(ok or not refusal:find "object.p")
    print((select(2, pcall(s.settle, s, { seconds = vertices })):match "settle.*"))
    print((select(2, pcall(vertices.table, 3)):match "table: .*"))
  )"),
            "Array: can only be read; x:table() is a copy to change\n"
            "Array: can only be read; x:table() is a copy to change\n"
            "Array: can only be read; x:table() is a copy to change\n"
            "Array(3 number)\tArray(3 integer)\tinteger\t3\tnil\ntrue\t3\n5\ttrue\ttrue\ntrue\n"
            "true\nsettle: seconds: expected a number, got an Array\n"
            "table: expected an Array before a colon (x:table), got 3\n");
}

TEST(SessionBindingTest, NanIsPrintedWithoutASign) {
  EXPECT_EQ(Script("local x = 0 / 0 print(x, -x, tostring(x), tostring(-x))"),
            "nan\tnan\tnan\tnan\n");
}

TEST(SessionBindingTest, WhatIsSetIsBlamedOnTheKeyThatWasTyped) {
  const std::pair<const char*, const char*> cases[] = {
      {"pg.open('scenes/ruler.lua', { set = { hand = 'nonsense' } })",
       "open: set: hand: expected the name of a hand ("},
      {"pg.open('scenes/ruler.lua', { set = { hand = 'nowhere/hand.lua' } })",
       "open: set: hand \"nowhere/hand.lua\": expected a file, got nothing of that name"},
      {"pg.open('scenes/ruler.lua', { set = { ['object.mass'] = -1 } })",
       "open: set: object.mass: expected a number from"},
      {"pg.open('scenes/ruler.lua', { set = { ['mppi.sigma'] = -1 } })",
       "open: set: mppi.sigma: expected a number from"},
      {"pg.open('scenes/ruler.lua', { set = { ['object.name'] = 'a b' } })",
       "open: set: object.name: expected a name of"},
      {"open():what_if{ set = { hand = 'nonsense' } }", "what_if: set: hand: expected the name of"},
      {"open():what_if{ set = { hand = '/etc/passwd/x.lua' } }",
       "what_if: set: hand \"/etc/passwd/x.lua\": expected a file, got nothing of that name"},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/ruler.lua' }, set = { hand = 'nonsense' } }",
       "eval: set: hand: expected the name of a hand ("},
      {"pg.eval{ dir = 'out/x', scenes = { 'scenes/ruler.lua' }, set = { foo = 1 } }",
       "eval: set: expected a key that can be set, as object.mass"},
      {"open():settle{ seconds = 0 / 0 }", "settle: seconds: expected a finite number, got nan"},
      {"open():strip{}",
       "strip: file: expected where the picture goes, as \"out/picture.png\", got"},
  };
  for (const auto& [code, expected] : cases) {
    EXPECT_EQ(Failure(code).find(expected), 0U) << code << ": " << Failure(code);
  }
}

TEST(SimulationBindingTest, NumbersAreInTheUnitsThatTheManualSays) {
  EXPECT_EQ(Script(R"(
    local function norm(v) return math.sqrt(v[1]^2 + v[2]^2 + v[3]^2) end
    local function near(what, a, b, share)
      if math.abs(a - b) > (share or 1e-9) * math.max(math.abs(a), math.abs(b)) then print(what, a, b) end
    end
    local s = open()
    local sim = s:simulate{ trace = true }
    sim:touch{ finger = "index", p_OC = { 0, 0, 0.05 } }
    sim:move{ finger = "index", by = { 0, 0, -0.02 }, seconds = 0.3 }
    local before = sim.fingers.index
    near("a spring of 50 N/m is deflected by 20 mm", before.normal_N, 1, 0.02)
    sim:move{ finger = "index", by = { 0.05, 0, 0 }, seconds = 0.5 }
    local f = sim.fingers.index
    near("force_N", f.force_N, norm(f.f_W))
    near("normal_N, friction_N", f.force_N^2, f.normal_N^2 + f.friction_N^2, 1e-6)
    near("limit_N", f.limit_N, 0.8 * f.normal_N)
    near("slip_mm", f.slip_mm, 1000 * (f.p_OC[1] - before.p_OC[1]), 0.02)
    print(f.slip_mm > 20)
    local up = 0
    for _, c in ipairs(sim.contacts) do
      near("a contact's force_N", c.force_N, norm(c.f_W))
      if c.a == "cube" or c.b == "cube" then up = up + (c.b == "cube" and 1 or -1) * c.f_W[3] end
    end
    near("the table carries weight and press", up, 0.2 * 9.81 + f.normal_N, 0.02)
    near("potential_J", sim.trace.potential_J, 2 * 0.2 * 9.81 * 0.05, 1e-3)
    local gaps, slips, deepest, fastest, force = 0, 0, 0, 0, 0
    s:break_when(function(e)
      if e.kind == "contact" then
        deepest, fastest = math.max(deepest, e.penetration), math.max(fastest, e.slip_speed)
      elseif e.kind == "finger" then
        force = e.force_N near("an event's slip_mm", e.slip_mm, f.slip_mm, 0.1)
      end
    end)
    sim:step(1)
    for _, c in ipairs(sim.contacts) do gaps, slips = math.max(gaps, -c.gap_mm), math.max(slips, c.slip_speed) end
    near("penetration", 1000 * deepest, gaps)
    near("slip_speed", fastest, slips)
    near("an event's force_N", force, sim.fingers.index.force_N)
    near("max_penetration_mm", sim.trace.max_penetration_mm, gaps)
    near("phi", s:distance{ -0.4, 0, 0.3 }.phi, 0.3)
    -- let fall from 2 mm
    local high = cube("cube", 0) high.p[3] = 0.052
    local fell = pg.open(pg.scene{ name = "high", object = high, environment = { table_body } })
    near("moved_mm", fell:settle{ seconds = 0.5 }.moved_mm, 2, 0.02)
    local turned = cube("cube", 0) turned.rpy_deg = { 0, 0, 30 }
    local body = pg.open(pg.scene{ name = "turned", object = turned, environment = { table_body } }).object
    near("rpy_deg", body.rpy_deg[3], 30) near("q", body.q[4], math.sin(math.pi / 12))
  )"),
            "true\n");
}

TEST(SessionBindingTest, ViewsCountAsTheScriptsMemory) {
  const TestFolder folder;
  ScriptConfig config = ConfigIn(folder);
  config.machine.bytes = 16U << 20U;
  EXPECT_EQ(
      RunIn(folder, "local s = open() for _ = 1, 60 do s:cloud{ points = 2000 } end print 'fine'",
            config),
      "fine\n");
  try {
    RunIn(folder,
          "local s, held = open(), {}\nfor i = 1, 200 do held[i] = s:cloud{ points = 2000 }.points "
          "end",
          config);
    FAIL() << "no failure";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
  }
}

TEST(SessionBindingTest, WhatIsOftenMistypedIsNamed) {
  EXPECT_EQ(Failure("open().simulate{}"),
            "simulate: expected a Session before a colon (x:simulate), got a table");
  EXPECT_EQ(Failure("open():simulate().step(3)"),
            "step: expected a Simulation before a colon (x:step), got 3");
  EXPECT_EQ(Failure("pg.open 'rulr'"),
            "open: rulr: expected a file, got nothing of that name (did you mean "
            "\"scenes/ruler.lua\"?)");
  EXPECT_EQ(Failure("pg.check 'no_such_thing'"),
            "check: no_such_thing: expected a file, got nothing of that name");
  EXPECT_EQ(Failure("open():plan{ set = { sigma = 0.3 } }"),
            "plan: set: expected a key that can be set, as object.mass or mppi.sigma (pregrasp "
            "info --settings lists the planner's), got \"sigma\"");
}

TEST(SessionBindingTest, ANameWithAZeroByteIsRefused) {
  EXPECT_EQ(Script(R"(
    local s, refused = open(), 0
    for _, call in ipairs{
      function() s:body("cube\0x") end, function() s:shot{ caption = "a\0b" } end,
      function() s:shot{ overlay = { "forces\0x" } } end, function() s:simulate{ ["trace\0x"] = true } end,
      function() s:simulate():touch{ finger = "index\0x", p_OC = {0, 0, 0} } end,
      function() pg.scene{ name = "a\0b" } end, function() pg.box{ ["x\0"] = 1, y = 1, z = 1 } end,
      function() pg.mesh{ "a\0.obj" } end, function() open{ set = { ["object.mass"] = "1\0" } } end,
      function() s:save("out/a\0b") end, function() s:simulate():step("1\0") end } do
      local ok, message = pcall(call)
      assert(not ok and not message:find("\0", 1, true), message)
      refused = refused + 1
    end
    print(refused))"),
            "11\n");
}

TEST(SessionBindingTest, OurCallsAreNotCountedAsTheScriptsTime) {
  const TestFolder folder;
  ScriptConfig config = ConfigIn(folder);
  config.machine.seconds = 0.05;
  EXPECT_EQ(RunIn(folder, "open():simulate():wait{ seconds = 100 } print 'done'", config),
            "done\n");
}

}  // namespace
}  // namespace pregrasp
