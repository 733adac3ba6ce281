#include "app/core/file_kind.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

TEST(FileKindTest, WhatIsNoFileIsCalledWhatItIs) {
  const TestFolder folder;
  const fs::path at = folder.path();
  folder.Write("file", "text");
  fs::create_symlink("file", at / "link");
  fs::create_symlink("loop", at / "loop");
  ASSERT_EQ(mkfifo((at / "pipe").c_str(), 0600), 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = at / "socket";
  ASSERT_LT(name.size(), sizeof address.sun_path);
  std::strcpy(address.sun_path, name.c_str());  // NOLINT: its size is asked above
  const int descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const std::pair<fs::path, std::string> cases[] = {
      {at / "nothing", "nothing of that name"},
      {at, "a folder"},
      {at / "pipe", "a pipe"},
      {at / "socket", "a socket"},
      {"/dev/null", "a device"},
  };
  for (const auto& [path, what] : cases) EXPECT_EQ(DescribeNonFile(path), what) << path;
  for (const char* plain : {"file", "link"}) {
    EXPECT_EQ(DescribeNonFile(at / plain), "");
    EXPECT_EQ(NonFileClause(at / plain), "");
  }
  EXPECT_EQ(DescribeNonFile(at / "file" / "below"), "nothing of that name");
  EXPECT_EQ(DescribeNonFile(at / "loop").find("one that cannot be reached (Too many"), 0U);
  EXPECT_EQ(NonFileClause(at / "nothing"), "which does not exist");
  EXPECT_EQ(NonFileClause(at / "pipe"), "which is a pipe");
  EXPECT_EQ(NonFileClause(at / "loop").find("which cannot be reached (Too many"), 0U);
  close(descriptor);
}

}  // namespace
}  // namespace pregrasp
