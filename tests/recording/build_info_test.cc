#include "app/recording/build_info.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

int Shell(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str());
}

// What git_hash.cmake makes of a source tree.
std::string HashOf(const fs::path& source, const fs::path& output) {
  EXPECT_EQ(Shell("cmake -DSOURCE_DIR='" + source.string() + "' -DOUTPUT='" + output.string() +
                  "' -P '" PREGRASP_SOURCE_DIR "/app/recording/git_hash.cmake'"),
            0);
  const std::string text = ReadFile(output);
  const std::size_t begin = text.find('"') + 1;
  return text.substr(begin, text.rfind('"') - begin);
}

bool IsCommit(const std::string& text) {
  return text.size() == 40 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

TEST(BuildInfoTest, TheHashIsACommitOrUnknown) {
  std::string hash = GitHash();
  const std::size_t mark = hash.find("-dirty");
  if (mark != std::string::npos && mark + 6 == hash.size()) hash.resize(mark);
  EXPECT_TRUE(hash == "unknown" || IsCommit(hash)) << GitHash();
}

TEST(BuildInfoTest, ATreeOutsideGitIsUnknown) {
  const TemporaryFolder folder;
  EXPECT_EQ(HashOf(folder.path(), folder.path() / "out"), "unknown");
}

TEST(BuildInfoTest, TheHashFollowsTheTreeAndTheFileChangesOnlyWithIt) {
  if (Shell("git --version") != 0) GTEST_SKIP() << "git is not installed";
  const TemporaryFolder folder, other;
  const fs::path output = other.path() / "out";
  const std::string git = "git -C '" + folder.path().string() +
                          "' -c user.name=a -c user.email=a@example.org -c commit.gpgsign=false ";
  WriteFile(folder.path() / "file", "1");
  ASSERT_EQ(Shell(git + "init"), 0);
  ASSERT_EQ(Shell(git + "add file"), 0);
  ASSERT_EQ(Shell(git + "commit --no-verify -m one"), 0);
  ASSERT_EQ(Shell(git + "tag v1"), 0);  // a tag must not take the hash's place

  const std::string clean = HashOf(folder.path(), output);
  EXPECT_TRUE(IsCommit(clean)) << clean;
  const auto written = fs::last_write_time(output);
  EXPECT_EQ(HashOf(folder.path(), output), clean);
  EXPECT_EQ(fs::last_write_time(output), written);

  WriteFile(folder.path() / "file", "2");
  EXPECT_EQ(HashOf(folder.path(), output), clean + "-dirty");

  // A source tree without .git must not take the hash of a repository that it happens to lie in.
  fs::create_directory(folder.path() / "unpacked");
  EXPECT_EQ(HashOf(folder.path() / "unpacked", output), "unknown");
}

TEST(BuildInfoTest, LibrariesHaveVersions) {
  const auto libraries = BuildLibraries();
  for (const char* name : {"eigen", "fmt", "lua", "mrpt", "nlohmann_json", "zlib"}) {
    ASSERT_TRUE(libraries.count(name)) << name;
    EXPECT_NE(libraries.at(name).find('.'), std::string::npos) << name << ' ' << libraries.at(name);
  }
}

}  // namespace
}  // namespace pregrasp
