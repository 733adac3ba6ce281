#include "app/recording/partial_directory.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

#include "app/core/error.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// What making a run directory there says, "" for nothing; the message must be one line.
std::string ErrorAt(const fs::path& directory) {
  try {
    const PartialDirectory partial(directory);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "";
}

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Runs `work` in a process of its own and returns its exit status, 100 for an exception.
int InChild(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    int status = 100;
    try {
      status = work();
    } catch (...) {
    }
    _exit(status);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// The names in a folder.
std::vector<std::string> Names(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

using StringList = std::vector<std::string>;

TEST(PartialDirectoryTest, TwoWritersOfOneRunAreRefused) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "real");
  fs::create_directory_symlink("real", folder.path() / "link");
  const fs::path run = folder.path() / "real/run";
  {
    const RunDirectory first(run, SampleScene());
    const std::string expected = "expected a folder that no other run is writing";
    EXPECT_TRUE(Contains(ErrorAt(run), expected));
    EXPECT_TRUE(Contains(ErrorAt(run / ""), expected));
    EXPECT_TRUE(Contains(ErrorAt(folder.path() / "link/run"), expected));
    EXPECT_EQ(InChild([&] { return Contains(ErrorAt(run), expected) ? 0 : 1; }), 0);
    EXPECT_EQ(ErrorAt(folder.path() / "real/other"), "");
  }
  EXPECT_EQ(ErrorAt(run), "");
}

TEST(PartialDirectoryTest, NothingIsMadeInARunOrInItsPlace) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run", other = folder.path() / "finished";
  WriteSampleRun(other, 2);
  const auto refuses = [](const fs::path& path) {
    try {
      RequireOutsideRuns(path);
    } catch (const InputError& error) {
      return Contains(error.what(), "expected a place outside of run directories");
    }
    return false;
  };
  {
    const RunDirectory first(run, SampleScene());
    for (const char* place :
         {"run/inner", "run/a/b/x.png", "run.partial/x", "run.partial/steps.jsonl",
          "run.partial/frames/x.png", "run.lock", "run.replaced", "run.partial",
          "finished/summary.json", "finished/frames/x.png", "finished/new/run"}) {
      EXPECT_TRUE(refuses(folder.path() / place)) << place;
    }
    EXPECT_TRUE(Contains(ErrorAt(run / "inner"), "one in the run run"));
    EXPECT_TRUE(Contains(ErrorAt(other / "inner"), "one in the run finished"));
    EXPECT_FALSE(fs::exists(run));
    for (const char* place : {"x.png", "runs/x.png", "other.lock", "run2", "run.png"}) {
      EXPECT_FALSE(refuses(folder.path() / place)) << place;
    }
  }
  EXPECT_FALSE(refuses(run / "inner"));
  EXPECT_FALSE(VerifyManifest(other));
}

TEST(PartialDirectoryTest, ManyProcessesAtOnceLeaveOneWholeRun) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  std::vector<pid_t> children;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    for (int i = 0; i < 20; ++i) {
      try {
        WriteSampleRun(run, 2, 2, seed);
      } catch (const InputError& error) {
        if (!Contains(error.what(), "no other run is writing")) _exit(1);
      }
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  EXPECT_FALSE(VerifyManifest(run));
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
}

TEST(PartialDirectoryTest, NothingButAFinishedRunIsEverReplaced) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  const std::string expected = "expected a new or empty folder, or a finished run";
  fs::create_directory(run);
  EXPECT_EQ(ErrorAt(run), "");
  WriteFile(run / "thesis.tex", "years of work");
  EXPECT_TRUE(Contains(ErrorAt(run), expected));
  WriteFile(run / "manifest.json", "{\"name\": \"of a browser extension\"}");
  EXPECT_TRUE(Contains(ErrorAt(run), expected));
  EXPECT_EQ(ReadFile(run / "thesis.tex"), "years of work");
  fs::remove_all(run);

  WriteSampleRun(run, 2);
  EXPECT_EQ(ErrorAt(run), "");
  WriteFile(run / "notes.txt", "mine");
  EXPECT_TRUE(Contains(ErrorAt(run), "a run with a file that is not part of it, \"notes.txt\""));
  EXPECT_EQ(ReadFile(run / "notes.txt"), "mine");
  fs::remove_all(run);

  WriteFile(run, "a file");
  EXPECT_TRUE(Contains(ErrorAt(run), expected));
  EXPECT_EQ(ReadFile(run), "a file");
  fs::remove(run);

  fs::create_symlink("nowhere", run);
  EXPECT_TRUE(Contains(ErrorAt(run), expected));
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
}

TEST(PartialDirectoryTest, WhatAppearsAtTheTargetDuringTheRunIsNotReplacedEither) {
  const TemporaryFolder folder;
  const fs::path directory = folder.path() / "run";
  {
    RunDirectory run(directory, SampleScene());
    fs::create_directory(directory);
    WriteFile(directory / "thesis.tex", "years of work");
    EXPECT_THROW(run.Finish({}, "", {}), InputError);
  }
  EXPECT_EQ(ReadFile(directory / "thesis.tex"), "years of work");
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
}

TEST(PartialDirectoryTest, AForeignFolderInOurPlaceIsLeftAlone) {
  for (const char* suffix : {".partial", ".replaced"}) {
    const TemporaryFolder folder;
    const fs::path foreign = folder.path() / (std::string("run") + suffix);
    fs::create_directory(foreign);
    WriteFile(foreign / "thesis.tex", "years of work");
    EXPECT_TRUE(Contains(ErrorAt(folder.path() / "run"), foreign.string())) << suffix;
    EXPECT_EQ(ReadFile(foreign / "thesis.tex"), "years of work");
  }
  const TemporaryFolder folder;
  WriteFile(folder.path() / "run.lock", "not a lock");
  EXPECT_TRUE(Contains(ErrorAt(folder.path() / "run"), "run.lock"));
  EXPECT_EQ(ReadFile(folder.path() / "run.lock"), "not a lock");
}

TEST(PartialDirectoryTest, WhatADeadProcessLeftIsClearedAway) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  InChild([&] {
    auto* abandoned = new RunDirectory(run, SampleScene());
    abandoned->AddStep(SampleStep(0));
    return 0;  // without a destructor, as if killed
  });
  EXPECT_EQ(Names(folder.path()), (StringList{"run.lock", "run.partial"}));
  WriteSampleRun(run, 2);
  EXPECT_FALSE(VerifyManifest(run));
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
}

TEST(PartialDirectoryTest, AFolderCutShortInItsRemovalIsClearedAway) {
  const TemporaryFolder folder;
  for (const char* kept : {"manifest.json", kUnfinishedMark, ""}) {
    const fs::path partial = folder.path() / "run.partial";
    WriteSampleRun(folder.path() / "old", 1);
    fs::create_directory(partial);
    if (*kept != '\0') fs::copy(folder.path() / "old/manifest.json", partial / kept);
    EXPECT_EQ(ErrorAt(folder.path() / "run"), "") << kept;
    EXPECT_FALSE(fs::exists(partial));
  }
}

TEST(PartialDirectoryTest, ARunMovedAsideIsPutBackIfNoNewOneCame) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  WriteSampleRun(run, 3, 3, 1);
  fs::rename(run, folder.path() / "run.replaced");
  WriteSampleRun(folder.path() / "new", 3, 3, 2);
  fs::rename(folder.path() / "new", folder.path() / "run.partial");
  EXPECT_EQ(ErrorAt(run), "");
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
  EXPECT_FALSE(VerifyManifest(run));
  EXPECT_EQ(LoadRun(run).manifest["seed"], 1);
}

TEST(PartialDirectoryTest, ARunMovedAsideIsRemovedIfANewOneCame) {
  const TemporaryFolder folder;
  WriteSampleRun(folder.path() / "run.replaced", 3, 3, 1);
  WriteSampleRun(folder.path() / "run", 3, 3, 2);
  EXPECT_EQ(ErrorAt(folder.path() / "run"), "");
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
  EXPECT_EQ(LoadRun(folder.path() / "run").manifest["seed"], 2);
}

TEST(PartialDirectoryTest, FoldersAreSwappedWithAndWithoutExchange) {
  for (const bool may_exchange : {true, false}) {
    const TemporaryFolder folder;
    WriteSampleRun(folder.path() / "run", 1, 0, 1);
    WriteSampleRun(folder.path() / "fresh", 1, 0, 2);
    SwapInto(folder.path() / "fresh", folder.path() / "run", may_exchange);
    EXPECT_EQ(LoadRun(folder.path() / "run").manifest["seed"], 2);
    const char* old = may_exchange ? "fresh" : "run.replaced";
    EXPECT_EQ(LoadRun(folder.path() / old).manifest["seed"], 1);
    EXPECT_EQ(Names(folder.path()).size(), 2U);
  }
}

TEST(PartialDirectoryTest, KilledAtAnyMomentItLeavesTheOldOrTheNewRun) {
  const TemporaryFolder folder(fs::temp_directory_path());  // a real disk, if there is one
  const fs::path run = folder.path() / "run";
  Rng rng(5);
  int replaced = 0;
  std::uint64_t seed_before = 0;
  std::chrono::duration<double> wait(
      0.01);  // follows the disk: the kills gather about the moment of the swap
  for (int round = 0; round < 40; ++round) {
    const bool existed = fs::exists(run);
    const pid_t child = fork();
    if (child == 0) {
      for (std::uint64_t seed = 1000U * static_cast<std::uint64_t>(round);; ++seed) {
        WriteSampleRun(run, 3, 3, seed + 1);
      }
    }
    std::this_thread::sleep_for(rng.Uniform() * wait);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ASSERT_TRUE(fs::exists(run) || !existed) << "the old run is lost in round " << round;
    wait *= 1.5;
    if (!fs::exists(run)) continue;
    const auto mismatch = VerifyManifest(run);
    ASSERT_FALSE(mismatch.has_value()) << mismatch->Sentence() << " in round " << round;
    const LoadedRun loaded = LoadRun(run);
    EXPECT_EQ(loaded.steps.size(), 3U);
    if (loaded.manifest["seed"] != seed_before) {
      ++replaced;
      wait *= 0.5;
    }
    seed_before = loaded.manifest["seed"];
    if (round % 4 == 0) {
      EXPECT_EQ(ErrorAt(run), "");
      EXPECT_EQ(Names(folder.path()), StringList{"run"});
    }
  }
  EXPECT_GT(replaced, 5);
  WriteSampleRun(run, 1);
  EXPECT_EQ(Names(folder.path()), StringList{"run"});
}

// As a user without root's rights, whoever runs the test.
int AsUser(const std::function<int()>& work) {
  return InChild([&] {
    if (geteuid() == 0 && setuid(65534) != 0) return 99;
    return work();
  });
}

TEST(PartialDirectoryTest, AFolderThatCannotBeWrittenIsOneClearLine) {
  const TemporaryFolder folder;
  chmod(folder.path().c_str(), 0555);
  EXPECT_EQ(
      AsUser([&] {
        const std::string there = ErrorAt(folder.path() / "run");
        const std::string below = ErrorAt(folder.path() / "a/b/run");
        return Contains(there, "Permission denied") && Contains(below, "Permission denied") ? 0 : 1;
      }),
      0);
  chmod(folder.path().c_str(), 0755);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(PartialDirectoryTest, WhatIsNoNameOfAFolderIsRefused) {
  EXPECT_TRUE(Contains(ErrorAt(""), "expected the name of a folder"));
  EXPECT_TRUE(Contains(ErrorAt("/"), "expected the name of a folder"));
  const TemporaryFolder folder;
  WriteFile(folder.path() / "file", "");
  EXPECT_NE(ErrorAt(folder.path() / "file/run"), "");
  EXPECT_TRUE(Contains(ErrorAt(folder.path() / std::string(250, 'a')), "File name too long"));
  EXPECT_EQ(Names(folder.path()), StringList{"file"});
}

TEST(CheckedFileTest, AFullDiskIsNoticed) {
  CheckedFile file("/dev/full");
  file.Write("a little");  // still in the buffer
  try {
    file.Close();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "/dev/full: expected a file that can be written, got No space left on device");
  }
  CheckedFile other("/dev/full");
  EXPECT_THROW(other.Write(std::string(1 << 20, 'x')), InputError);
}

// A limit on the size of a file stands for a disk that is full from some moment on: every write
// beyond it fails. Each limit lets the run get a little further.
TEST(RunDirectoryTest, WhereverTheDiskIsFullNothingIsLeftBehind) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  int failures = 0;
  for (const rlim_t limit :
       {0UL, 200UL, 1000UL, 1800UL, 3000UL, 6000UL, 6500UL, 20000UL, 70000UL}) {
    const int status = InChild([&] {
      signal(SIGXFSZ, SIG_IGN);
      const rlimit file_size{limit, limit};
      setrlimit(RLIMIT_FSIZE, &file_size);
      try {
        WriteSampleRun(run, 60, 60, limit + 1);
      } catch (const InputError& error) {
        const std::string message = error.what();
        return Contains(message, "File too large") && !Contains(message, "\n") ? 2 : 1;
      }
      return 0;
    });
    EXPECT_EQ(status, limit < 70000 ? 2 : status) << limit;
    failures += status == 2;
    EXPECT_EQ(Names(folder.path()), status == 0 ? StringList{"run"} : StringList{}) << limit;
    fs::remove_all(run);
  }
  EXPECT_GE(failures, 8);
}

}  // namespace
}  // namespace pregrasp
