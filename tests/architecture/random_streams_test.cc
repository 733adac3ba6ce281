// Every purpose of random numbers has its own entry in RngStream; an entry that two places of the
// product draw from would give two purposes the same numbers.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

std::string Read(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// The files in which each stream is named, once for each time.
std::map<std::string, std::vector<std::string>> FindUses() {
  const fs::path root = PREGRASP_SOURCE_DIR;
  const std::regex pattern(R"(RngStream::(k\w+))");
  std::map<std::string, std::vector<std::string>> uses;
  for (const char* top : {"app", "render", "bindings"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if ((extension != ".h" && extension != ".cc") || entry.path().filename() == "rng.h") continue;
      const std::string text = Read(entry.path());
      for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
        uses[(*it)[1]].push_back(fs::relative(entry.path(), root).string());
      }
    }
  }
  return uses;
}

TEST(RandomStreamsTest, EachIsDrawnFromInOnePlace) {
  // The same numbers are wanted: the planner's cloud, asked for by a script too. The two trainers
  // are two programs' work, and an item is made with grasps or with states, not both. What is drawn
  // for a state's scene, motions and labels, for a keyframe or a trajectory's reach, and for a made
  // problem's grasp or stages, has a key
  // of its own; the library of grasps has a seed that no trial has, and labels made again one that
  // no ladder has.
  const std::map<std::string, std::size_t> wanted = {
      {"kObjectCloud", 2},    {"kInitialWeights", 2}, {"kBatchNoise", 2},     {"kItemScene", 4},
      {"kItemGrowth", 2},     {"kItemLabel", 4},      {"kMotionKey", 2},      {"kMotionFrame", 2},
      {"kProbedContacts", 2}, {"kProbedLabels", 2},   {"kMotionProblemIk", 2}};
  const auto uses = FindUses();
  ASSERT_GT(uses.size(), 10U);
  EXPECT_FALSE(uses.contains("kTest"));
  for (const auto& [stream, files] : uses) {
    const auto more = wanted.find(stream);
    std::string list;
    for (const std::string& file : files) list += " " + file;
    EXPECT_EQ(files.size(), more == wanted.end() ? 1U : more->second) << stream << " in" << list;
  }
}

TEST(RandomStreamsTest, EachEntryIsUsed) {
  const std::string header = Read(fs::path(PREGRASP_SOURCE_DIR) / "app/core/rng.h");
  const std::size_t begin = header.find("enum class RngStream");
  ASSERT_NE(begin, std::string::npos);
  const std::string entries = header.substr(begin, header.find("};", begin) - begin);
  const std::regex pattern(R"(\n  (k\w+))");
  const auto uses = FindUses();
  int count = 0;
  for (std::sregex_iterator it(entries.begin(), entries.end(), pattern), end; it != end; ++it) {
    const std::string entry = (*it)[1];
    ++count;
    EXPECT_TRUE(entry == "kTest" || uses.contains(entry)) << entry;
  }
  EXPECT_GT(count, 10);
}

}  // namespace
}  // namespace pregrasp
