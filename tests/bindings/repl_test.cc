// The real program's prompt: from a pipe, and at a pseudo-terminal.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>

#include "app/recording/loaded_run.h"
#include "tests/bindings/lua_text.h"
#include "tests/bindings/run_program.h"
#include "tests/bindings/terminal.h"

namespace pregrasp {
namespace {

ProgramResult Pipe(const std::string& text, const TestFolder& folder,
                   const std::vector<std::string>& more = {"scenes/ruler.lua"}) {
  std::vector<std::string> arguments = {"repl"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return RunProgram(arguments, folder.path(), text);
}

class ReplTerminalTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!Terminal::IsPossible()) GTEST_SKIP() << "no pseudo-terminals here: is /dev/pts mounted?";
  }
};

TEST(ReplPipeTest, ShowsValuesAndNothingElse) {
  const TestFolder folder;
  const ProgramResult result = Pipe(
      "s.name, 1 + 1\n\nlocal sim = s:simulate()\nfor i = 1, 2 do\n  sim:step(10)\nend\n"
      "sim.num_steps -- a comment\nx = 3; local function f() return x end\nf()\n",
      folder);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, "ruler\n2\n20\n3\n");
  EXPECT_EQ(ListFiles(folder.path()).size(), 0U);
}

TEST(ReplPipeTest, TheFirstErrorIsOneLineWithItsLineAndEndsIt) {
  const TestFolder folder;
  const std::pair<std::string, std::string> cases[] = {
      {"1\ns.nme\n2\n", "stdin:2: Session: unknown key \"nme\" (did you mean \"name\"?)\n"},
      {"1\nfunction f()\n  error('no')\nend\nf()\n", "stdin:3: no\n"},
      {"1\nx y\n", "stdin:2: syntax error near 'y'\n"},
      {"1\nfor i = 1, 2 do\n", "stdin:2: the input ends within a statement\n"},
      {"1\nos.execute('touch x')\n", "stdin:2: unknown variable \"os\" (did you mean \"s\"?)\n"},
      {"1\ns:record{ dir = 'out/x' } s:simulate():wait()\nerror('late')\n", "stdin:3: late\n"},
      {"1\nlocal shape = box{1, 1, 1}\n",
       "stdin:2: unknown variable \"box\" (did you mean \"pg.box\"?)\n"},
  };
  for (const auto& [text, expected] : cases) {
    const ProgramResult result = Pipe(text, folder);
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.out, "1\n");
    EXPECT_EQ(result.err, expected);
    const bool recorded = text.find("record") != std::string::npos;
    EXPECT_EQ(ListFiles(folder.path()).empty(), !recorded) << text;
    if (recorded) {
      EXPECT_EQ(LoadRun(folder.path() / "out/x").summary.status, "failed");
    }
    std::filesystem::remove_all(folder.path() / "out");
  }
  const ProgramResult missing = Pipe("1\n", folder, {"missing.lua"});
  EXPECT_EQ(missing.code, 2);
  EXPECT_EQ(missing.out, "");
  EXPECT_EQ(missing.err, "missing.lua: expected a file, got nothing of that name\n");
  EXPECT_EQ(Pipe("while true do end\n", folder, {"--time", "0.1"}).err,
            "stdin:1: out of time after 0.1 s of Lua (--time gives it more)\n");
}

TEST(ReplPipeTest, PrintShowsWhatAnExpressionDoesAndASentenceWhole) {
  const TestFolder folder;
  EXPECT_EQ(Pipe("print({1, 2}, 'a', 1.5)\n", folder).out, "{1, 2}\ta\t1.5\n");
  EXPECT_EQ(Pipe("print(s.dt)\n", folder).out, Pipe("s.dt\n", folder).out);
  const std::string shown = Pipe("s:check()\n", folder).out;
  EXPECT_EQ(shown, Pipe("print(s:check())\n", folder).out);
  EXPECT_EQ(shown.rfind("Check\nclean: at rest, no overlaps\n", 0), 0U) << shown;
}

TEST(ReplPipeTest, TheCommandLineSaysItsVersionAndTakesThreadsForCheck) {
  const TestFolder folder;
  const ProgramResult version = RunProgram({"--version"}, folder.path());
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("pregrasp ", 0), 0U) << version.out;
  const std::string scene =
      (std::filesystem::path(PREGRASP_SOURCE_DIR) / "scenes/ruler.lua").string();
  EXPECT_EQ(RunProgram({"check", scene, "--threads", "1", "--no-grasps"}, folder.path()).code, 0);
}

TEST(ReplPipeTest, ARecordingIsFinishedAtTheEnd) {
  const TestFolder folder;
  const ProgramResult result =
      Pipe("s:record{ dir = 'out/x', pictures = 'none' }\ns:simulate():wait()\n", folder);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(LoadRun(folder.path() / "out/x").steps.back().id, "sim.1");
}

TEST_F(ReplTerminalTest, ReadsOverSeveralLinesAndGoesOnAfterAnErrorWithItsTraceback) {
  const TestFolder folder;
  Terminal terminal({"repl", "scenes/ruler.lua"}, folder.path());
  ASSERT_TRUE(terminal.Await("Ctrl-D ends\r\ns = Session(ruler)\r\n> ")) << terminal.rest();
  terminal.Type("function f(x)\n");
  ASSERT_TRUE(terminal.Await(">> ")) << terminal.rest();
  terminal.Type("error('deep ' .. x) end\n");
  ASSERT_TRUE(terminal.Await("\n> ")) << terminal.rest();
  terminal.Type("f(1)\n");
  ASSERT_TRUE(terminal.Await("stdin:2: deep 1\r\n    stdin:2, in f\r\n    stdin:3\r\n> "))
      << terminal.rest();
  terminal.Type("6 * 7\n");
  ASSERT_TRUE(terminal.Await("\n42\r\n> ")) << terminal.rest();
  terminal.Type("\x04");
  EXPECT_EQ(terminal.AwaitEnd(), 0);
}

TEST_F(ReplTerminalTest, CompletesAndRemembersOverSessions) {
  const TestFolder folder;
  {
    Terminal terminal({"repl", "scenes/ruler.lua"}, folder.path());
    ASSERT_TRUE(terminal.Await("\n> ")) << terminal.rest();
    terminal.Type("#s.bod\t\n");
    ASSERT_TRUE(terminal.Await("\n2\r\n> ")) << terminal.rest();
    terminal.Type("s:s\t");
    ASSERT_TRUE(
        terminal.Await("save        save_state  settle      shot        simulate    step\r\n"))
        << terminal.rest();
    terminal.Type("\x15\x04");  // take back, end
    EXPECT_EQ(terminal.AwaitEnd(), 0);
  }
  Terminal terminal({"repl", "scenes/ruler.lua"}, folder.path());
  ASSERT_TRUE(terminal.Await("\n> ")) << terminal.rest();
  terminal.Type("\x1b[A\n");  // up
  ASSERT_TRUE(terminal.Await("\n2\r\n> ")) << terminal.rest();
  terminal.Type("\x04");
  EXPECT_EQ(terminal.AwaitEnd(), 0);
}

TEST_F(ReplTerminalTest, CtrlCEndsALongCallOrALineAndLeavesTheStateUsable) {
  const TestFolder folder;
  Terminal terminal({"repl", "scenes/ruler.lua"}, folder.path());
  ASSERT_TRUE(terminal.Await("\n> ")) << terminal.rest();
  terminal.Type("sim = s:simulate() sim:step(7)\n");
  ASSERT_TRUE(terminal.Await("\n> ")) << terminal.rest();
  for (const char* endless :
       {"print 'on' while true do pcall(function() while true do end end) end\n",
        "print 'on' while true do sim:step(70000) sim:back(70000) end\n"}) {
    terminal.Type(endless);
    ASSERT_TRUE(terminal.Await("\non\r\n")) << terminal.rest();
    terminal.Type("\x03");
    ASSERT_TRUE(terminal.Await("interrupted\r\n> ")) << terminal.rest();
  }
  terminal.Type("half a li\x03");
  ASSERT_TRUE(terminal.Await("^C\r\n> ")) << terminal.rest();
  terminal.Type("sim:back(sim.num_steps - 7) sim.num_steps == 7, s.name\n");
  ASSERT_TRUE(terminal.Await("syntax error")) << terminal.rest();
  terminal.Type("sim:back(sim.num_steps - 7)\nsim.num_steps, s.name\n");
  ASSERT_TRUE(terminal.Await("\n7\r\nruler\r\n> ")) << terminal.rest();
  terminal.Type("\x04");
  EXPECT_EQ(terminal.AwaitEnd(), 0);
}

TEST_F(ReplTerminalTest, WhatIsTypedAheadIsRead) {
  const TestFolder folder;
  Terminal terminal({"repl"}, folder.path());
  terminal.Type("6 * 7\n\x04");
  EXPECT_EQ(terminal.AwaitEnd(), 0);
  EXPECT_NE(terminal.rest().find("\n42\r\n"), std::string::npos) << terminal.rest();
}

TEST_F(ReplTerminalTest, APoliteKillEndsIt) {
  const TestFolder folder;
  Terminal terminal({"repl", "scenes/ruler.lua"}, folder.path());
  ASSERT_TRUE(terminal.Await("\n> ")) << terminal.rest();
  terminal.Signal(SIGTERM);
  EXPECT_EQ(terminal.AwaitEnd(), 130);
}

}  // namespace
}  // namespace pregrasp
