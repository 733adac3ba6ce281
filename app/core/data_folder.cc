#include "app/core/data_folder.h"

#include <array>
#include <cstdlib>

#include "app/core/error.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

fs::path FindDataFolder() {
  std::error_code error;
  if (const char* given = std::getenv("PREGRASP_DATA"); given != nullptr && *given != '\0') {
    if (!fs::exists(fs::path(given) / "assets" / "MANIFEST", error)) {
      throw InputError("PREGRASP_DATA", "", "a folder with assets, lua and scenes", given);
    }
    return fs::weakly_canonical(given, error);
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  const std::array<fs::path, 2> beside{program / ".." / "..",
                                       program / ".." / "share" / "pregrasp"};
  for (const fs::path& folder : beside) {
    if (fs::exists(folder / "assets" / "MANIFEST", error)) {
      return fs::weakly_canonical(folder, error);
    }
  }
  return PREGRASP_BUILT_FROM;
}

}  // namespace

fs::path DataFolder() {
  static const fs::path folder = FindDataFolder();
  return folder;
}

}  // namespace pregrasp
