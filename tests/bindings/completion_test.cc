// What the prompt offers and explains, in the real machine.
#include "bindings/completion.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bindings/help.h"
#include "bindings/manual.h"
#include "bindings/script.h"
#include "bindings/show.h"
#include "tests/bindings/lua_text.h"

namespace pregrasp {
namespace {

using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStdout;

// A prompt at which `s`, a session, and `sim`, a simulation that touches, are known.
class PromptTest : public testing::Test {
 protected:
  PromptTest() {
    machine().PushTypedEnvironment(L());
    lua_pushcfunction(L(), PrintHelp);
    lua_setfield(L(), -2, "help");
    lua_pop(L(), 1);
    Execute(R"(pg = require "pregrasp"
      s = pg.open "scenes/ruler.lua"
      sim = s:simulate()
      sim:touch{ finger = "index", p_OC = {0.11, 0, 0} } sim:step(3))");
  }

  Machine& machine() { return script_.machine(); }
  lua_State* L() { return machine().state(); }

  void Execute(const std::string& text) {
    machine().LoadTyped(text, 1);
    machine().Call(0, 0);
  }

  std::string Output(const std::string& text) {
    CaptureStdout();
    try {
      Execute(text);
    } catch (const InputError& error) {
      return GetCapturedStdout() + error.what();
    }
    return GetCapturedStdout();
  }

  std::string Show(const std::string& expression, int width = 200) {
    machine().LoadTyped("return " + expression, 1);
    machine().Call(0, 1);
    std::string text = ShowValue(L(), -1, width);
    lua_pop(L(), 1);
    return text;
  }

  // The words offered, and the word they stand for.
  std::string Complete(const std::string& line) {
    const Completion completion = CompleteLine(machine(), line);
    EXPECT_EQ(lua_gettop(L()), 0);
    std::string text = line.substr(completion.begin) + ">";
    for (const std::string& word : completion.words) text += ' ' + word;
    return text;
  }

  const ScriptConfig config_;
  ScriptMachine script_{config_};
};

TEST_F(PromptTest, CompletesVariablesFieldsAndMethods) {
  EXPECT_EQ(Complete("print(si"), "si> sim");
  EXPECT_EQ(Complete("s.na"), "na> name");
  EXPECT_EQ(Complete("x = s:se"), "se> settle");
  EXPECT_EQ(Complete("sim.fingers.index.force"), "force> force_N");
  EXPECT_EQ(Complete("sim.contacts[1].ga"), "ga> gap_mm");
  EXPECT_EQ(Complete("pg.wr"), "wr> wrench");
  EXPECT_EQ(Complete("math.ma"), "ma> max maxinteger");
  EXPECT_EQ(Complete("for i = 1, 2 do retu"), "retu> return");
  EXPECT_EQ(Complete("sim:"), "> back body fork forward lift move shot step touch wait what_if");
}

TEST_F(PromptTest, CompletesTheOptionsOfACall) {
  EXPECT_EQ(Complete("s:settle{ se"), "se> seconds");
  EXPECT_EQ(Complete("sim:touch({ finger = \"index\", p"), "p> p_OC");
  EXPECT_EQ(Complete("sim:move{ by = {0, 0, 0}, "), "> by finger seconds to");
  EXPECT_EQ(Complete("sim:move{ by = si"), "si> sim");  // a value, not an option
  EXPECT_EQ(Complete("pg.wrench{ torque"), "torque> torque_scale");
}

TEST_F(PromptTest, CompletesTheValuesOfAnOption) {
  EXPECT_EQ(Complete("s:record{ dir = \"out/x\", pictures = \"no"), "no> none");
  EXPECT_EQ(Complete("s:record{ pictures = '"), "> all key none");
  EXPECT_EQ(Complete("sim:touch({ finger = \"in"), "in> index");
  EXPECT_EQ(Complete("s:break_when 'contact"), "contact> contact_lost contact_made");
  EXPECT_EQ(Complete("s:break_when({ 'slip', \"loos"), "loos> loosened");
  EXPECT_EQ(Complete("s:go 'sim."), "sim.> sim.1 sim.2");
  EXPECT_EQ(Complete("x = s:step('sim.2"), "sim.2> sim.2");
  EXPECT_EQ(Complete("s:what_if{ set = { ['mppi.final"), "mppi.final> mppi.final_sigma");
  EXPECT_EQ(Complete("s:plan{ paths = 1, set = { ['mppi.sigma'] = 1, [\"paths.o"),
            "paths.o> paths.order");
  EXPECT_EQ(Complete("s:shot{ overlay = { \"forces\", \"co"), "co> cones contacts");
  EXPECT_EQ(Complete("s:shot{ caption = \"x"), "x>");
}

TEST_F(PromptTest, HelpFindsOptionsOverlaysAndWords) {
  const Manual& manual = Manual::Get();
  EXPECT_EQ(manual.Match("sigma").front(), "Optimizer.sigma");
  EXPECT_EQ(manual.Match("sigma").back(), "OptimizeOptions.sigma");
  EXPECT_EQ(manual.Match("overlay"),
            (std::vector<std::string>{"Overlay", "RunStripOptions.overlay", "ShotOptions.overlay",
                                      "StripOptions.overlay"}));
  EXPECT_EQ(manual.Match("ghost"), (std::vector<std::string>{"Overlay.ghost"}));
  EXPECT_NE(manual.Explain("Overlay.ghost").find("the object at its start"), std::string::npos);
  EXPECT_NE(manual.Explain("Overlay").find("friction cones"), std::string::npos);
  const std::vector<std::string> found = manual.Search("friction cone");
  EXPECT_NE(std::find(found.begin(), found.end(), "Overlay.cones"), found.end());
  EXPECT_EQ(manual.Search("prune a node at a time"),
            (std::vector<std::string>{"Graph:prune_step"}));
  EXPECT_TRUE(manual.Search("zebra").empty());
}

TEST_F(PromptTest, OffersNothingWhereNothingIsKnownAndCallsNothing) {
  for (const char* line : {"nothing.x", "s.nam.x", "s:simulate().t", "(1).x", "s.name.x", "f\"x",
                           "sim.contacts[99].g", "a.b.c:d", ".x", "s..n", "{}.x"}) {
    EXPECT_EQ(Complete(line).back(), '>') << line;
  }
  EXPECT_EQ(Show("s.step_id"), "sim.2");
}

TEST_F(PromptTest, ShowsRecordsAndObjectsAsRows) {
  EXPECT_EQ(Show("s.object"),
            "Body\n  name     \"ruler\"\n  movable  true\n  p        {-0.16, 0, 0.0015}\n"
            "  q        {1, 0, 0, 0}\n  rpy_deg  {0, 0, 0}\n  v        {0, 0, 0}\n"
            "  w        {0, 0, 0}");
  const std::string session = Show("s");
  EXPECT_EQ(session.find("Session(ruler)\n  name        \"ruler\"\n"), 0U) << session;
  EXPECT_NE(session.find("\n  bodies      {\"ruler\", \"table\"}\n  object      Body{..}\n"),
            std::string::npos)
      << session;
  EXPECT_NE(session.find("\n  :settle :verdict :simulate "), std::string::npos) << session;
}

TEST_F(PromptTest, ShowsAListOfRecordsAsATable) {
  const std::string table = Show("sim.contacts");
  EXPECT_EQ(table.find("   a      b      p_W"), 0U) << table;
  EXPECT_NE(table.find("\n1  ruler  table  {"), std::string::npos) << table;
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
}

TEST_F(PromptTest, ShowsPlainValuesInALineAndCutsLongLists) {
  EXPECT_EQ(Show("1 / 3"), "0.33333333333333");
  EXPECT_EQ(Show("{1 / 3, -0.0}"), "{0.3333, 0}");
  EXPECT_EQ(Show("nil"), "nil");
  EXPECT_EQ(Show("'a text'"), "a text");
  EXPECT_EQ(Show("{}"), "{}");
  EXPECT_EQ(Show("{1, 2.5, 'x', true}"), "{1, 2.5, \"x\", true}");
  EXPECT_EQ(Show("{b = {1, {2, {3}}}, a = {}}"), "  a  {}\n  b  {1, {2, {1 entries}}}");
  EXPECT_EQ(Show("(function() local t = {} t.t = t return t end)()"), "  t  {..}");
  Execute("long = {} for i = 1, 1000 do long[i] = i end");
  EXPECT_EQ(Show("{x = long}"), "  x  {1, 2, 3, 4, 5, 6, 7, 8, .. 1000 in all}");
  const std::string rows = Show("long");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 20);
  EXPECT_NE(rows.find("\n.. 980 more"), std::string::npos) << rows;
  EXPECT_LE(Show("{x = ('y'):rep(500)}", 40).size(), 40U);
}

TEST_F(PromptTest, HelpExplainsAValueAFunctionAndAName) {
  const std::string settle = Output("help(s.settle)");
  EXPECT_EQ(settle.find("Session:settle(options) -> SettleResult\n  Lets the scene alone"), 0U)
      << settle;
  EXPECT_NE(settle.find("    seconds?  number  [s], 1\n"), std::string::npos) << settle;
  EXPECT_EQ(Output("help 'settle'"), settle);
  EXPECT_EQ(Output("help 'Session:settle'"), settle);
  EXPECT_NE(Output("help(s)").find("\n  :settle(options)  Lets the scene alone"),
            std::string::npos);
  EXPECT_EQ(Output("help(s.object)").find("Body\n  name     string\n"), 0U);
  EXPECT_EQ(Output("help(pg)").find("pregrasp\n"), 0U);
  EXPECT_EQ(Output("help(pg.open)").find("pregrasp.open(scene, options) -> Session\n"), 0U);
  EXPECT_NE(Output("help()").find("Tab"), std::string::npos);
  // Two classes have a shot.
  EXPECT_NE(Output("help 'shot'").find("\n\nSimulation:shot(options)"), std::string::npos);
  EXPECT_EQ(Output("help 'setle'"),
            "stdin:1: help: nothing is called \"setle\" (did you mean \"settle\"?)");
  EXPECT_NE(Output("help(print)").find("Lua's own"), std::string::npos);
  EXPECT_EQ(Output("help(3)"), "a number: 3\n");
}

TEST(ManualTest, KnowsEveryFunctionAndClass) {
  const Api& api = GetApi();
  const Manual& manual = Manual::Get();
  for (const FunctionInfo* function : api.functions) {
    EXPECT_NE(manual.Find("pregrasp." + function->name), nullptr) << function->name;
  }
  for (const ClassInfo* info : api.classes) {
    ASSERT_NE(manual.Find(info->name), nullptr) << info->name;
    for (const FunctionInfo& method : info->methods) {
      const ManualEntry* entry = manual.Find(info->name + ":" + method.name);
      ASSERT_NE(entry, nullptr) << info->name << ":" << method.name;
      EXPECT_NE(entry->text, "") << entry->name << " is not explained";
    }
  }
}

TEST(ManualTest, ReadsTypesThatHoldBlanks) {
  const Manual manual(
      "---@class A of things\n---@field set? table<string, number|x> changes it\n"
      "---@field mode \"a b\"|(\"c\"|\"d e\")[] how\n");
  const ManualEntry* entry = manual.Find("A");
  ASSERT_NE(entry, nullptr);
  EXPECT_EQ(entry->text, "of things");
  ASSERT_EQ(entry->parts.size(), 2U);
  EXPECT_EQ(entry->parts[0].type, "table<string, number|x>");
  EXPECT_TRUE(entry->parts[0].optional);
  EXPECT_EQ(entry->parts[0].text, "changes it");
  EXPECT_EQ(entry->parts[1].type, "\"a b\"|(\"c\"|\"d e\")[]");
}

}  // namespace
}  // namespace pregrasp
