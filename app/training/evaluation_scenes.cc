#include "app/training/evaluation_scenes.h"

#include <algorithm>

#include "app/core/error.h"

namespace pregrasp {

namespace fs = std::filesystem;

std::vector<fs::path> FindEvaluationScenes(const fs::path& data) {
  std::vector<fs::path> files;
  const fs::path folder = data / "scenes";
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".lua") files.push_back(it->path());
  }
  if (error || files.empty()) {
    throw InputError(folder.string(), "", "scene files of the objects that training leaves out",
                     error ? error.message() : "none");
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace pregrasp
