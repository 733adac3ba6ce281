#include "app/recording/rawlog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>

#include "app/core/error.h"
#include "app/job/facts_json.h"
#include "app/recording/build_info.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kSteps = 40;

// Runs a shell command in `folder`; returns what it prints on both streams and its exit status.
struct CommandResult {
  std::string output;
  int status = -1;
};
CommandResult RunIn(const fs::path& folder, const std::string& command) {
  CommandResult result;
  FILE* pipe = popen(("cd '" + folder.string() + "' && " + command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    result.output.append(buffer.data(), count);
  }
  result.status = pclose(pipe);
  return result;
}

int CountLines(const fs::path& file) {
  std::ifstream in(file);
  int count = 0;
  for (std::string line; std::getline(in, line);) ++count;
  return count;
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// With each run of blanks as one.
std::string Squeeze(std::string text) {
  const auto both_blank = [](char a, char b) { return a == ' ' && b == ' '; };
  text.erase(std::unique(text.begin(), text.end(), both_blank), text.end());
  return text;
}

class RawlogTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    WriteSampleRun(run(), kSteps, true);
  }
  static void TearDownTestSuite() { delete std::exchange(folder_, nullptr); }
  static fs::path run() { return folder_->path() / "run"; }

  static TemporaryFolder* folder_;
};
TemporaryFolder* RawlogTest::folder_ = nullptr;

TEST_F(RawlogTest, MrptReadsEveryStepBack) {
  const Rawlog log = LoadRawlog(run() / "run.rawlog");
  EXPECT_EQ(log.header["scene"], "sample");
  EXPECT_EQ(log.header["seed"], 1);
  EXPECT_EQ(log.header["planner_version"], ProgramVersion());
  ASSERT_EQ(log.steps.size(), static_cast<std::size_t>(kSteps));
  for (int i = 0; i < kSteps; ++i) {
    const StepFacts step = SampleStep(i);
    const auto difference = CompareFacts(log.steps[static_cast<std::size_t>(i)], step);
    EXPECT_FALSE(difference.has_value()) << i << ": " << difference->field;
    EXPECT_EQ(log.pictures[static_cast<std::size_t>(i)], PictureName(i + 1, step.id));
  }
}

TEST_F(RawlogTest, RawlogEditSeesEveryStep) {
  const CommandResult info = RunIn(folder_->path(), "rawlog-edit --info -i run/run.rawlog");
  ASSERT_EQ(info.status, 0) << info.output;
  const std::string text = Squeeze(info.output);
  // The header and a pair a step.
  EXPECT_EQ(Count(text, "number of objects : " + std::to_string(2 * kSteps + 1) + '\n'), 1) << text;
  for (const char* label : {"pose_object", "pose_tool", "pose_tool_2", "contacts", "picture"}) {
    EXPECT_EQ(Count(text, std::string(": ") + label + " / " + std::to_string(kSteps) + " /"), 1)
        << label << text;
  }
  EXPECT_EQ(Count(text, "Earliest timestamp : 946684800.000000"), 1) << text;
  EXPECT_EQ(Count(text, "Latest timestamp : 946684800.162500"), 1) << text;
}

TEST_F(RawlogTest, RawlogEditListsThePictureOfEveryStepAndFindsThem) {
  const fs::path list = folder_->path() / "list.txt";
  // The pictures' folder is only found from inside the run directory: MRPT 2.5.8 joins the folder
  // of the log and the name of the folder of images without a slash.
  const CommandResult images =
      RunIn(run(), "rawlog-edit --list-images -i run.rawlog --text-file-output " + list.string());
  ASSERT_EQ(images.status, 0) << images.output;
  EXPECT_NE(images.output.find("Found external storage directory: run_Images"), std::string::npos);
  std::ifstream in(list);
  int number = 0;
  for (std::string line; std::getline(in, line); ++number) {
    EXPECT_EQ(line, PictureName(number + 1, SampleStep(number).id));
  }
  EXPECT_EQ(number, kSteps);
  // Describing an image loads it.
  const CommandResult all = RunIn(run(), "rawlog-edit --describe -i run.rawlog");
  EXPECT_EQ(all.status, 0);
  EXPECT_EQ(Count(all.output, "Image size: 1x1 pixels"), kSteps);
  EXPECT_EQ(Count(all.output, "\"id\":\"sim."), kSteps);
}

TEST_F(RawlogTest, RawlogEditExportsEveryPoseAndContact) {
  const TemporaryFolder copy;
  fs::copy(run() / "run.rawlog", copy.path() / "run.rawlog");
  const CommandResult poses = RunIn(copy.path(), "rawlog-edit --export-txt -i run.rawlog");
  ASSERT_EQ(poses.status, 0) << poses.output;
  for (const char* name : {"object", "tool", "tool_2"}) {
    const fs::path file = copy.path() / (std::string("run_pose_") + name + ".txt");
    EXPECT_EQ(CountLines(file), kSteps + 1) << file;  // and a header
  }
  const CommandResult contacts =
      RunIn(copy.path(), "rawlog-edit --export-rawdaq-txt -i run.rawlog");
  ASSERT_EQ(contacts.status, 0) << contacts.output;
  EXPECT_EQ(CountLines(copy.path() / "run_contacts.txt"), kSteps + 1);
}

TEST_F(RawlogTest, PicturesNeedNotBeThere) {
  const TemporaryFolder copy;
  fs::copy(run() / "run.rawlog", copy.path() / "run.rawlog");
  for (const char* operation : {"--info", "--list-images", "--list-poses", "--list-timestamps"}) {
    const CommandResult result =
        RunIn(copy.path(), std::string("rawlog-edit -i run.rawlog ") + operation);
    EXPECT_EQ(result.status, 0) << operation << result.output;
  }
}

TEST_F(RawlogTest, ADamagedLogIsAnInputError) {
  const std::string bytes = ReadFile(run() / "run.rawlog");
  const fs::path damaged = folder_->path() / "damaged.rawlog";
  Rng rng(7);
  for (int i = 0; i < 100; ++i) {
    std::string copy = bytes;
    if (i % 2 == 0) {
      copy.resize(rng.UniformInt(static_cast<std::uint32_t>(bytes.size())));
    } else {
      // Past the header, whose time, flags and system mean nothing to the content.
      copy[10 + rng.UniformInt(static_cast<std::uint32_t>(bytes.size() - 10))] ^=
          static_cast<char>(1U << rng.UniformInt(8));
    }
    WriteFile(damaged, copy);
    EXPECT_THROW(LoadRawlog(damaged), InputError) << i;
  }
}

}  // namespace
}  // namespace pregrasp
