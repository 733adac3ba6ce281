// wrench{..} and ik{..} in the real machine.
#include <gtest/gtest.h>

#include <string>

#include "bindings/script.h"
#include "tests/bindings/lua_text.h"

namespace pregrasp {
namespace {

// What a script prints that has the program's API as pg.
std::string RunText(const std::string& body) {
  const TestFolder folder;
  const auto file = folder.Write("test.lua", "local pg = require 'pregrasp'\n" + body);
  ScriptConfig config;
  config.output = folder.path() / "out";
  testing::internal::CaptureStdout();
  try {
    RunScript(file, {}, config);
  } catch (...) {
    testing::internal::GetCapturedStdout();
    throw;
  }
  return testing::internal::GetCapturedStdout();
}

std::string ErrorOf(const std::string& body) {
  try {
    RunText(body);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(WrenchCallTest, APinchHoldsWhatFrictionAllowsAndNoMore) {
  // Two fingers of at most 1 N each and friction 0.5 carry 1 N.
  const std::string pinch =
      "local function hold(mass) return pg.wrench{ p = {{0.02,0,0}, {-0.02,0,0}}, n = {{-1,0,0}, "
      "{1,0,0}}, mu = 0.5, mass = mass, f_min = 0.1, f_max = 1 } end\n";
  EXPECT_EQ(RunText(pinch + "print(hold(0.101).feasible, hold(0.103).feasible)"), "true\tfalse\n");
  EXPECT_EQ(RunText(pinch + "local w = hold(0.05) print(#w.forces, w.status, w.closed)"),
            "2\tfeasible\tfalse\n");
  EXPECT_EQ(RunText(pinch + "print(hold(0.2).status)"), "weight not balanced\n");
}

TEST(WrenchCallTest, BadInputSaysWhat) {
  EXPECT_NE(ErrorOf("pg.wrench{ p = {{0,0,0}}, n = {} }"), "");
  EXPECT_NE(ErrorOf("pg.wrench{ p = {{0,0,0}}, n = {{0,0,0}} }"), "");
  EXPECT_NE(ErrorOf("pg.wrench{ p = {{0,0,0}}, n = {{0,0,1}}, mue = 1 }").find("\"mu\""),
            std::string::npos);
}

// A carton that stands on a table.
const char* const kCarton =
    "local s = pg.open(pg.scene{ name = 'carton', object = { shape = pg.box{0.05, 0.06, 0.12}, "
    "mass = 0.2, p = {0, 0, 0.06} }, environment = { { name = 'table', shape = pg.box{0.8, 0.8, "
    "0.04}, p = {0, 0, -0.02} } } })\n"
    "local function reach(sign, z) return pg.ik{ scene = s, seed = 3, contacts = {\n"
    "  thumb = { p = {0, -0.03, z}, n = {0, sign, 0} },\n"
    "  index = { p = {0.011, 0.03, z}, n = {0, -sign, 0} },\n"
    "  middle = { p = {-0.011, 0.03, z}, n = {0, -sign, 0} } } } end\n";

TEST(IkCallTest, SolvesAPinchAmongTheScenesBodies) {
  EXPECT_EQ(RunText(std::string(kCarton) +
                    "local r = reach(1, 0.09)\n"
                    "print(r.status, r.solved, r.tip_error < 2e-3, r.clearance >= 0, #r.X_WH.p, "
                    "r.q.FFJ3 ~= nil)"),
            "solved\ttrue\ttrue\ttrue\t3\ttrue\n");
}

TEST(IkCallTest, TheObjectSaysWhichSideOfAContactIsOutside) {
  EXPECT_EQ(
      RunText(std::string(kCarton) + "print(reach(1, 0.09).q.FFJ2 == reach(-1, 0.09).q.FFJ2)"),
      "true\n");
}

TEST(IkCallTest, NearTheLastAnswerTheHandDoesNotJump) {
  EXPECT_EQ(RunText(std::string(kCarton) + R"(
    local function at(z, near) return pg.ik{ scene = s, seed = 3, near = near, contacts = {
      thumb = { p = {0, -0.03, z}, n = {0, 1, 0} }, index = { p = {0.011, 0.03, z}, n = {0, -1, 0} } } } end
    local last, largest = at(0.09), 0
    for i = 1, 20 do
      local r = at(0.09 - 0.0005 * i, last)
      assert(r.solved)
      for name, angle in pairs(r.q) do largest = math.max(largest, math.abs(angle - last.q[name])) end
      last = r
    end
    print(largest < 0.1))"),
            "true\n");
}

TEST(IkCallTest, ContactsInTheTableAreNotReached) {
  EXPECT_EQ(RunText(std::string(kCarton) + "print(reach(1, 0.001).solved)"), "false\n");
}

TEST(IkCallTest, BadInputSaysWhat) {
  EXPECT_NE(ErrorOf("pg.ik{ contacts = {} }").find("at least one contact"), std::string::npos);
  EXPECT_NE(ErrorOf("pg.ik{ contacts = { thumb = { p = {0,0,0}, n = {0,0,1} } }, near = {} }")
                .find("near.X_WH"),
            std::string::npos);
  EXPECT_NE(ErrorOf("pg.ik{ contacts = { tumb = {} } }").find("thumb"), std::string::npos);
  EXPECT_NE(ErrorOf("pg.ik{ contacts = { thumb = { p = {0,0,0}, n = {0,0,0} } } }").find("thumb.n"),
            std::string::npos);
}

}  // namespace
}  // namespace pregrasp
