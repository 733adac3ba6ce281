#include "app/recording/rawlog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "app/core/error.h"
#include "app/core/json_text.h"
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
    WriteSampleRun(run(), kSteps, kSteps);
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
    EXPECT_EQ(log.pictures[static_cast<std::size_t>(i)], "");
  }
}

TEST_F(RawlogTest, RawlogEditSeesEveryStep) {
  const CommandResult info = RunIn(folder_->path(), "rawlog-edit --info -i run/run.rawlog");
  ASSERT_EQ(info.status, 0) << info.output;
  const std::string text = Squeeze(info.output);
  // The header and a pair a step.
  EXPECT_EQ(Count(text, "number of objects : " + std::to_string(2 * kSteps + 1) + '\n'), 1) << text;
  for (const char* label : {"pose_object", "pose_tool", "pose_tool_2", "contacts"}) {
    EXPECT_EQ(Count(text, std::string(": ") + label + " / " + std::to_string(kSteps) + " /"), 1)
        << label << text;
  }
  EXPECT_EQ(Count(text, ": picture"), 0) << text;
  EXPECT_EQ(Count(text, "Earliest timestamp : 946684800.000000"), 1) << text;
  EXPECT_EQ(Count(text, "Latest timestamp : 946684800.162500"), 1) << text;
}

TEST_F(RawlogTest, TheLogOfPicturesHasTheStepsThatHaveOneAsTheLogOfTheRunHasThem) {
  WriteSampleRun(folder_->path() / "some", kSteps, 7);
  const Rawlog all = LoadRawlog(folder_->path() / "some/run.rawlog");
  const Rawlog log = LoadRawlog(folder_->path() / "some/pictures.rawlog");
  EXPECT_EQ(log.header, all.header);
  ASSERT_EQ(log.steps.size(), 7U);
  for (int i = 0; i < 7; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_FALSE(CompareFacts(log.steps[at], all.steps[at]).has_value()) << i;
    EXPECT_EQ(log.pictures[at], PictureName(i + 1, log.steps[at].id));
  }
}

TEST_F(RawlogTest, AStepWhoseObservationsAreNotThoseOfItsCommentIsNamed) {
  // A step's observations with the comment of another one.
  const fs::path file = folder_->path() / "mixed.rawlog";
  const StepFacts step = SampleStep(3);
  StepFacts other = step;
  other.fingers[1].f_W.z() = std::nextafter(other.fingers[1].f_W.z(), 1e3);
  RawlogWriter writer(file, {});
  writer.Add(other, FormatJson(FactsToJson(step, 1)));
  writer.Close();
  try {
    LoadRawlog(file);
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("step 1, sim.3: contacts: "), std::string::npos) << text;
  }
}

// With all pictures, with some, and with none.
class RawlogEditTest : public testing::TestWithParam<int> {
 protected:
  RawlogEditTest() { WriteSampleRun(run(), kSteps, GetParam()); }
  fs::path run() const { return folder_.path() / "run"; }
  // The pictures' folder is only found from inside the run directory: MRPT 2.5.8 joins the folder
  // of the log and the name of the folder of images without a slash.
  CommandResult Edit(const std::string& arguments) const {
    return RunIn(run(), "rawlog-edit " + arguments);
  }
  std::vector<std::string> Logs() const {
    if (GetParam() == 0) return {"run"};
    return {"run", "pictures"};
  }
  static int NumSteps(const std::string& log) { return log == "run" ? kSteps : GetParam(); }

  const TemporaryFolder folder_;
};

TEST_P(RawlogEditTest, InformsAboutEveryStep) {
  EXPECT_EQ(fs::exists(run() / "pictures.rawlog"), GetParam() > 0);
  for (const std::string& log : Logs()) {
    const CommandResult info = Edit("--info -i " + log + ".rawlog");
    EXPECT_EQ(info.status, 0) << info.output;
    EXPECT_EQ(Count(Squeeze(info.output),
                    "number of objects : " + std::to_string(2 * NumSteps(log) + 1) + '\n'),
              1)
        << info.output;
    for (const char* operation : {"--list-poses", "--list-timestamps"}) {
      EXPECT_EQ(Edit(std::string(operation) + " -i " + log + ".rawlog").status, 0) << operation;
    }
  }
}

TEST_P(RawlogEditTest, ListsThePicturesThatThereAre) {
  for (const std::string& log : Logs()) {
    const fs::path list = folder_.path() / "list.txt";
    const CommandResult images =
        Edit("--list-images -i " + log + ".rawlog --text-file-output " + list.string());
    ASSERT_EQ(images.status, 0) << images.output;
    EXPECT_EQ(Count(images.output, "Found external storage directory: pictures_Images"),
              log == "pictures" ? 1 : 0)
        << images.output;
    std::ifstream in(list);
    int number = 0;
    for (std::string line; std::getline(in, line); ++number) {
      EXPECT_EQ(line, PictureName(number + 1, SampleStep(number).id));
      EXPECT_TRUE(fs::exists(run() / "frames" / line)) << line;
    }
    EXPECT_EQ(number, log == "pictures" ? GetParam() : 0);
  }
}

TEST_P(RawlogEditTest, DescribesEveryStepAndPicture) {
  for (const std::string& log : Logs()) {
    const CommandResult all = Edit("--describe -i " + log + ".rawlog");
    EXPECT_EQ(all.status, 0);
    EXPECT_EQ(Count(all.output, "\"id\":\"sim."), NumSteps(log)) << all.output;
    // Describing an image loads it.
    EXPECT_EQ(Count(all.output, "Image size: 1x1 pixels"), log == "pictures" ? GetParam() : 0);
  }
}

TEST_P(RawlogEditTest, ExportsEveryPoseAndContact) {
  for (const std::string& log : Logs()) {
    const CommandResult poses = Edit("--export-txt -i " + log + ".rawlog");
    ASSERT_EQ(poses.status, 0) << poses.output;
    for (const char* name : {"object", "tool", "tool_2"}) {
      const fs::path file = run() / (log + "_pose_" + name + ".txt");
      EXPECT_EQ(CountLines(file), NumSteps(log) + 1) << file;  // and a header
    }
    const CommandResult contacts = Edit("--export-rawdaq-txt -i " + log + ".rawlog");
    ASSERT_EQ(contacts.status, 0) << contacts.output;
    EXPECT_EQ(CountLines(run() / (log + "_contacts.txt")), NumSteps(log) + 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Pictures, RawlogEditTest, testing::Values(kSteps, 7, 0));

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
