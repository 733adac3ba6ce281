#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace pregrasp {
namespace {

std::string Read(const std::string& name) {
  std::ifstream in(std::filesystem::path(PREGRASP_SOURCE_DIR) / name);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(PackagesTest, EveryPackageHasItsReasonInTheReadme) {
  const std::string readme = Read("README.md");
  for (const char* list :
       {"packages.txt", "packages-dev.txt", "packages-train.txt", "packages-cluster.txt"}) {
    std::istringstream packages(Read(list));
    int count = 0;
    for (std::string package; packages >> package; ++count) {
      EXPECT_NE(readme.find('`' + package + '`'), std::string::npos)
          << package << " of " << list << " is not in the README's table";
    }
    EXPECT_GT(count, 0) << list;
  }
}

}  // namespace
}  // namespace pregrasp
