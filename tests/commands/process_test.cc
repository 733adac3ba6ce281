// The program as a process: streams that are not there, signals, odd command lines.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "app/recording/loaded_run.h"
#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// Runs a shell command in the folder, with $PREGRASP set to the built program.
int Shell(const std::string& command, const TestFolder& folder) {
  setenv("PREGRASP", PREGRASP_PROGRAM, 1);
  const std::string line = "cd '" + folder.path().string() + "' && " + command;
  const int status = std::system(line.c_str());  // NOLINT: a test's own command
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

const char* const kPush = R"(local pg = require "pregrasp"
local s = pg.open "scenes/ruler.lua"
s:record{ dir = "out/run", pictures = "none" }
local x = s:simulate()
x:touch{ finger = "index", p_OC = {0.1, 0, 0.0015} }
x:wait{ seconds = 0.2 }
print "done"
)";

TEST(ProcessTest, StreamsThatAreClosedDoNotEndUpInTheRun) {
  const TestFolder folder;
  folder.Write("push.lua", kPush);
  ASSERT_EQ(Shell("$PREGRASP script push.lua 2> err.txt > out.txt", folder), 0);
  const auto open_files = ListFiles(folder.path() / "out/run");
  const std::string whole = ReadText(folder.path() / "out/run/steps.jsonl");
  ASSERT_EQ(Shell("rm -r out && $PREGRASP script push.lua 0<&- 1>&- 2>&-", folder), 0);
  EXPECT_EQ(ListFiles(folder.path() / "out/run").size(), open_files.size());
  EXPECT_EQ(ReadText(folder.path() / "out/run/steps.jsonl"), whole);
  for (const char* name : {"manifest.json", "summary.json", "steps.jsonl"}) {
    EXPECT_EQ(ReadText(folder.path() / "out/run" / name).find("done\n"), std::string::npos) << name;
  }
}

TEST(ProcessTest, OutputThatIsLostIsNoSuccess) {
  const TestFolder folder;
  folder.Write("push.lua", kPush);
  EXPECT_EQ(Shell("$PREGRASP info --settings > /dev/full 2> err.txt", folder), 1);
  const std::string message = ReadText(folder.path() / "err.txt");
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  EXPECT_EQ(message.find("bug of ours"), std::string::npos) << message;
  // Nobody reads any more: the work is finished all the same.
  EXPECT_EQ(Shell("{ $PREGRASP script push.lua 2> err.txt; echo $? > code.txt; } | true", folder),
            0);
  EXPECT_EQ(LoadRun(folder.path() / "out/run").steps.back().id, "sim.2");
}

TEST(ProcessTest, AHangUpLeavesAValidShorterRun) {
  const TestFolder folder;
  folder.Write("loop.lua", std::string(kPush) + "while true do x:step(50) x:back(50) end\n");
  const TestFolder captured;
  const pid_t child = StartProgram({"script", "loop.lua"}, folder.path(), captured.path());
  for (int i = 0; i < 600 && ReadText(captured.path() / "out") != "done\n"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  kill(child, SIGHUP);
  const ProgramResult result = AwaitProgram(child, captured.path());
  EXPECT_EQ(result.code, 130);
  EXPECT_EQ(result.err, "interrupted\n");
  EXPECT_EQ(LoadRun(folder.path() / "out/run").summary.status, "interrupted");
}

TEST(ProcessTest, AnOptionWithoutItsValueTakesNoOther) {
  const TestFolder folder;
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"run", "scenes/ruler.lua", "--out=", "--threads", "2"},
       "pregrasp: --out: expected a value after =, got none\n"},
      {{"run", "--out=", "scenes/ruler.lua"},
       "pregrasp: --out: expected a value after =, got none\n"},
      {{"run", "scenes/ruler.lua", "--out", "--all"},
       "pregrasp run: --out: expected a value, got the option --all (see pregrasp run --help)\n"},
      {{"run", "scenes/ruler.lua", "--out", ""},
       "pregrasp run: --out: expected a value, got an empty one (see pregrasp run --help)\n"},
  };
  for (const auto& [arguments, expected] : cases) {
    const ProgramResult result = RunProgram(arguments, folder.path());
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.err, expected);
    EXPECT_EQ(ListFiles(folder.path()).size(), 0U);
  }
  // A script's own arguments are its own.
  folder.Write("args.lua", "print(...)\n");
  EXPECT_EQ(RunProgram({"script", "args.lua", "x="}, folder.path()).out, "x=\n");
}

TEST(ProcessTest, WhatTheCommandLineDoesNotHaveIsNamedWithTheNearest) {
  const TestFolder folder;
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"rnu", "scenes/ruler.lua"}, "pregrasp: expected a command (check, "},
      {{"rnu", "scenes/ruler.lua"}, "got \"rnu\" (did you mean \"run\"?) (see pregrasp --help)"},
      {{"run", "x.lua", "--sed", "3"},
       "pregrasp run: expected an option that it has, got \"--sed\" (did you mean \"--seed\"?) "
       "(see "
       "pregrasp run --help)"},
      {{"run", "--sed", "3"}, "pregrasp run: expected an option that it has, got \"--sed\""},
      {{"run", "a.lua", "b.lua"}, "pregrasp run: expected no more arguments, got \"b.lua\""},
      {{"run"}, "pregrasp run: expected SCENE, got nothing"},
      {{"run", "a.lua", "--seed"}, "pregrasp run: --seed: expected a value, got nothing"},
      {{"run", "a.lua", "--seed", "1", "--seed", "2"},
       "pregrasp run: --seed: expected it once, got 2 times"},
      {{"run", "a.lua", "--all=maybe"}, "pregrasp run: --all: expected no value, got \"maybe\""},
      {{"run", "a.lua", "--set", "--all"},
       "pregrasp run: --set: expected a value, got the option --all"},
      {{"hand"}, "pregrasp hand: expected the command check, got nothing"},
      {{"dataset", "graps"}, "got \"graps\" (did you mean \"grasps\"?)"},
      {{"eval", "reprt", "out"},
       "pregrasp eval: expected a command (merge, report), got \"reprt\""},
      {{"eval", "--study", "lader", "--out", "x"}, "got \"lader\" (did you mean \"ladder\"?)"},
      {{"eval", "--scenes", "rulr", "--out", "x"}, "got \"rulr\" (did you mean \"ruler\"?)"},
      {{"run", "rulr.lua"}, "rulr.lua: expected a file, got nothing of that name (did you mean \""},
      {{"show", "run", "--steps", "a,,b", "--out", "x.png"},
       "--steps: expected the ids of steps with a comma between two, got \"a,,b\""},
      {{"show", "/dev/null", "--out", "x.png"}, "/dev/null: expected a finished run, got a device"},
      {{"verify", "nowhere"}, "nowhere: expected a finished run, got nothing of that name"},
  };
  for (const auto& [arguments, expected] : cases) {
    const ProgramResult result = RunProgram(arguments, folder.path());
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_NE(result.err.find(expected), std::string::npos) << expected << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(ListFiles(folder.path()).size(), 0U);
  }
}

TEST(ProcessTest, WhatMayNotBeLookedAtIsBadInput) {
  const TestFolder folder;
  folder.Write("closed/scene.lua", "");
  folder.Write("unreadable.lua", "");
  // root may look at all: a user without rights does it, where the machine lets us be one.
  const std::string drop =
      getuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
  fs::permissions(folder.path(), fs::perms::owner_all | fs::perms::others_all);
  fs::permissions(folder.path() / "closed", fs::perms::none);
  fs::permissions(folder.path() / "unreadable.lua", fs::perms::none);
  const std::pair<std::string, std::string> cases[] = {
      {"run closed/scene.lua", "closed/scene.lua: expected a file, got one that cannot be reached"},
      {"run unreadable.lua", "unreadable.lua: expected a file that can be read"},
      {"hand check ./unreadable.lua", "./unreadable.lua: expected a hand.lua, got one that cannot"},
      {"verify closed", "closed: expected a finished run, got a folder that cannot be searched ("},
      {"jobs status closed", "closed/jobs.json: expected a path that can be reached, got Perm"},
      {"eval --scenes closed/scene.lua --out x",
       "closed/scene.lua: expected a path that can be reached, got Permission denied"},
  };
  if (Shell(drop + "test -x $PREGRASP", folder) != 0) GTEST_SKIP() << "no user without rights";
  for (const auto& [words, expected] : cases) {
    EXPECT_EQ(Shell(drop + "$PREGRASP " + words + " > out.txt 2> err.txt", folder), 2) << words;
    const std::string line = ReadText(folder.path() / "err.txt");
    EXPECT_EQ(line.find(expected), 0U) << words << ": " << line;
  }
  fs::permissions(folder.path() / "closed", fs::perms::owner_all);
}

TEST(ProcessTest, AnUnknownDriverOfPicturesIsBadInput) {
  const TestFolder folder;
  EXPECT_EQ(Shell("GALLIUM_DRIVER=nope $PREGRASP info > out.txt 2> err.txt", folder), 2);
  EXPECT_EQ(ReadText(folder.path() / "err.txt"),
            "GALLIUM_DRIVER: expected llvmpipe, or nothing, got \"nope\"\n");
  EXPECT_EQ(Shell("GALLIUM_DRIVER=llvmpipe $PREGRASP info > out.txt", folder), 0);
}

TEST(ProcessTest, AnotherFolderOfDataIsTakenOrRefused) {
  const TestFolder folder;
  EXPECT_EQ(Shell("PREGRASP_DATA=$PWD $PREGRASP info > out.txt 2> err.txt", folder), 2);
  EXPECT_EQ(
      ReadText(folder.path() / "err.txt").find("PREGRASP_DATA: expected a folder with assets"), 0U);
  fs::create_directory(folder.path() / "data");
  for (const char* name : {"assets", "lua", "scenes"}) {
    fs::create_directory_symlink(fs::path(PREGRASP_SOURCE_DIR) / name,
                                 folder.path() / "data" / name);
  }
  EXPECT_EQ(Shell("PREGRASP_DATA=data $PREGRASP info > out.txt", folder), 0);
  EXPECT_NE(ReadText(folder.path() / "out.txt").find((folder.path() / "data").string()),
            std::string::npos);
}

TEST(ProcessTest, LongInputToThePromptIsReadInTimeInProportion) {
  const TestFolder folder;
  std::string lines, table = "t = {\n";
  for (int i = 1; i <= 30000; ++i) lines += "x = " + std::to_string(i) + "\n";
  for (int i = 1; i <= 30000; ++i) table += "  { " + std::to_string(i) + " },\n";
  const auto seconds = [&](const std::string& input, const std::string& printed) {
    const auto begin = std::chrono::steady_clock::now();
    const ProgramResult result = RunProgram({"repl"}, folder.path(), input);
    EXPECT_EQ(result.out, printed);
    EXPECT_EQ(result.err, "stdin:60003: no\n");
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  EXPECT_LT(seconds(lines + table + "}\nprint(x, #t)\n" + "error('no')\n", "30000\t30000\n"), 20.0);
}

TEST(ProcessTest, ScenesInOtherUnitsAreRefusedWithTheLikelyCause) {
  const TestFolder folder;
  const auto check = [&](const std::string& object) {
    folder.Write("scene.lua",
                 "return scene { name = \"x\", object = { " + object +
                     " },\n  environment = { { name = \"table\", shape = box{90, 90, 1}, "
                     "p = {0, 0, -0.5} } } }\n");
    const ProgramResult result = RunProgram({"check", "scene.lua", "--no-grasps"}, folder.path());
    EXPECT_EQ(result.code, 2);
    return result.err;
  };
  EXPECT_EQ(check("shape = box{12.5, 4.0, 20.0}, mass = 0.5, p = {0, 0, 10}"),
            "scene.lua:1: object.shape: expected an object at most 10 m long, in metres (60 mm are "
            "0.06), got one of 20 m\n");
  EXPECT_EQ(check("shape = box{4, 4, 4}, mass = 0.5, p = {0, 0, 2}"),
            "scene.lua:1: object.mass: expected a mass in kg of 0.1 to 1e+06 kg/m^3, of a shape in "
            "metres, got 0.5 kg in 64 m^3\n");
  EXPECT_NE(
      check("shape = box{0.1, 0.1, 1e-300}, mass = 0.5, p = {0, 0, 0.1}").find("1e-06 to 100"),
      std::string::npos);
  folder.Write("many.lua",
               "local t = { { name = 'table', shape = box{1, 1, 1}, p = {0, 0, -0.5} } }\n"
               "for i = 1, 600 do t[i + 1] = { shape = box{0.1, 0.1, 0.1}, mass = 0.5, p = {i, 0, "
               "0.05} } end\n"
               "return scene { name = 'x', object = { shape = box{0.1, 0.1, 0.1}, mass = 0.5, p = "
               "{0, 0, 0.05} }, "
               "environment = t }\n");
  EXPECT_EQ(RunProgram({"check", "many.lua"}, folder.path()).err,
            "many.lua:3: environment: expected at most 499 bodies, got 601\n");
}

}  // namespace
}  // namespace pregrasp
