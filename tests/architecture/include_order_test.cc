// The order of folders of the house: a file includes its own folder and folders above it in this
// list, and each third-party library stays in the folder that owns it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kOrder = {
    "app/core",    "app/scene",     "app/geometry",   "app/dynamics", "app/hand",    "app/networks",
    "app/grasp",   "app/graph",     "app/trajectory", "app/motion",   "app/batch",   "app/training",
    "app/job",     "app/recording", "render",         "app/pictures", "app/session", "app/page",
    "app/studies", "bindings",      "app/commands",   "app"};

// Folders of render's and the planner's that are closed to it although they stand above it.
const std::map<std::string, std::set<std::string>> kOnly = {
    {"render", {"app/core", "app/scene", "app/geometry", "app/hand", "app/motion", "render"}},
};

// Who may include a library's headers.
const std::vector<std::pair<std::regex, std::set<std::string>>> kOwners = {
    {std::regex("fcl/.*|assimp/.*|libqhull.*"), {"app/geometry", "app/hand"}},
    {std::regex("Simbody\\.h|SimTK.*"), {"app/dynamics", "app/hand"}},
    {std::regex("urdf.*|nlopt.*"), {"app/hand"}},
    {std::regex("torch/.*"), {"app/training"}},
    {std::regex("mrpt/.*"), {"app/recording"}},
    {std::regex("E?GL/.*"), {"render"}},
    {std::regex("lua.*|lauxlib.*"), {"app/core", "bindings"}},
    {std::regex("histedit.*"), {"bindings"}},
    {std::regex("openssl/.*"), {"app/core"}},
    {std::regex("httplib\\.h"), {"app/page"}},
    {std::regex("jpeglib\\.h"), {"render"}},
    {std::regex("zlib\\.h"), {"app/core", "app/recording"}},
};

std::string FolderOf(const fs::path& relative) {
  const std::string folder = relative.parent_path().string();
  return folder;
}

struct Include {
  std::string file, folder, target;
  bool quoted;
};

std::vector<Include> FindIncludes() {
  const fs::path root = PREGRASP_SOURCE_DIR;
  const std::regex pattern(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::vector<Include> includes;
  for (const char* top : {"app", "render", "bindings"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cc") continue;
      const fs::path relative = fs::relative(entry.path(), root);
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, pattern)) continue;
        includes.push_back({relative.string(), FolderOf(relative), match[2], match[1] == "\""});
      }
    }
  }
  return includes;
}

TEST(IncludeOrderTest, AFileIncludesOnlyItsOwnFolderAndThoseAboveIt) {
  const auto includes = FindIncludes();
  ASSERT_GT(includes.size(), 20U);
  for (const Include& include : includes) {
    const auto own = std::find(kOrder.begin(), kOrder.end(), include.folder);
    ASSERT_NE(own, kOrder.end()) << include.file
                                 << " lies in a folder that the order does not know";
    if (!include.quoted) continue;
    const std::string folder = FolderOf(include.target);
    const auto target = std::find(kOrder.begin(), kOrder.end(), folder);
    ASSERT_NE(target, kOrder.end()) << include.file << " includes \"" << include.target
                                    << "\"; paths start at the repository's root";
    EXPECT_LE(target - kOrder.begin(), own - kOrder.begin())
        << include.file << " includes " << include.target;
    if (const auto only = kOnly.find(include.folder); only != kOnly.end()) {
      EXPECT_TRUE(only->second.count(folder)) << include.file << " includes " << include.target;
    }
    EXPECT_TRUE(fs::exists(fs::path(PREGRASP_SOURCE_DIR) / include.target)) << include.target;
  }
}

TEST(IncludeOrderTest, EachLibraryStaysInTheFolderThatOwnsIt) {
  for (const Include& include : FindIncludes()) {
    if (include.quoted) continue;
    for (const auto& [pattern, owners] : kOwners) {
      if (std::regex_match(include.target, pattern)) {
        EXPECT_TRUE(owners.count(include.folder))
            << include.file << " includes <" << include.target << ">";
      }
    }
  }
}

TEST(IncludeOrderTest, EveryTopFolderHasAReadme) {
  for (const char* folder :
       {"app", "bindings", "lua", "scenes", "assets", "render", "tests", "app/batch", "app/job",
        "app/recording", "app/pictures", "app/session", "app/page", "app/studies"}) {
    EXPECT_TRUE(fs::exists(fs::path(PREGRASP_SOURCE_DIR) / folder / "README.md")) << folder;
  }
}

}  // namespace
}  // namespace pregrasp
