#include "bindings/file_access.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "tests/bindings/lua_text.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

TEST(FileAccessTest, ReadsWhatLiesBelowAnAllowedFolderAndNothingElse) {
  const TestFolder folder, other;
  folder.Write("a/b.txt", "b");
  const fs::path secret = other.Write("secret.txt", "s");
  fs::create_symlink(secret, folder.path() / "link.txt");
  fs::create_directory_symlink(other.path(), folder.path() / "way");
  FileAccess files;
  files.AllowReadsBelow(folder.path());
  EXPECT_EQ(files.FindForReading("a/b.txt"), folder.path() / "a/b.txt");
  EXPECT_EQ(files.FindForReading((folder.path() / "a/../a/b.txt").string()),
            folder.path() / "a/../a/b.txt");
  const std::string up = (folder.path() / "a/../..").string();
  for (const std::string& name :
       {secret.string(), std::string("link.txt"), std::string("way/secret.txt"),
        up + "/" + other.path().filename().string() + "/secret.txt", std::string("a"),
        std::string(), std::string("missing"), std::string("a/b.txt\0x", 9),
        std::string("/dev/null"), std::string("/etc/passwd")}) {
    EXPECT_THROW(files.FindForReading(name), InputError) << name;
  }
}

TEST(FileAccessTest, AFolderWhoseNameOnlyBeginsAlikeIsNotBelow) {
  const TestFolder folder;
  const fs::path secret = folder.Write("data-secret/x", "s");
  fs::create_directory(folder.path() / "data");
  FileAccess files;
  files.AllowReadsBelow(folder.path() / "data");
  EXPECT_THROW(files.FindForReading(secret.string()), InputError);
}

TEST(FileAccessTest, WritesBelowTheOutputFolderWhichOutStandsFor) {
  const TestFolder folder, other;
  fs::create_directory_symlink(other.path(), folder.path() / "way");
  FileAccess files;
  files.SetOutput(folder.path());
  EXPECT_EQ(files.ResolveForWriting("out/a/b"), folder.path() / "a/b");
  EXPECT_EQ(files.ResolveForWriting("./out/a"), folder.path() / "a");
  EXPECT_EQ(files.ResolveForWriting((folder.path() / "c").string()), folder.path() / "c");
  for (const char* name : {"a", "out/..", "out/../a", "../out/a", "/tmp/a", "", ".", "..",
                           "out/way/a", "out/a/../../b"}) {
    EXPECT_THROW(files.ResolveForWriting(name), InputError) << name;
  }
}

}  // namespace
}  // namespace pregrasp
