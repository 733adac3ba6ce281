#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// Two types of one name in one namespace are undefined behaviour that no compiler or linker
// reports: whichever destructor the linker keeps is run on both.
TEST(TypeNamesTest, NoTwoHeadersDefineATypeOfOneName) {
  const fs::path root = PREGRASP_SOURCE_DIR;
  const std::regex definition(R"(^(struct|class|enum class) (\w+)( final)?( :[^:].*)? ?[{:].*)");
  std::map<std::string, std::string> seen;
  int types = 0;
  for (const char* folder : {"app", "render", "bindings"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".h") continue;
      const std::string file = fs::relative(entry.path(), root).string();
      std::ifstream in(entry.path());
      std::string space, line;  // the innermost namespace
      while (std::getline(in, line)) {
        if (line.rfind("namespace ", 0) == 0) space = line;
        std::smatch match;
        if (!std::regex_match(line, match, definition)) continue;
        ++types;
        const auto [at, is_new] = seen.emplace(space + " " + match[2].str(), file);
        EXPECT_TRUE(is_new) << match[2] << " is defined in " << at->second << " and " << file;
      }
    }
  }
  EXPECT_GT(types, 300);
}

}  // namespace
}  // namespace pregrasp
