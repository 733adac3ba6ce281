#include "app/recording/build_info.h"

#include <fmt/core.h>
#include <mrpt/version.h>
#include <zlib.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace pregrasp {
namespace internal {
extern const char* const kGitHash;  // in the generated git_hash.cc
}

const char* ProgramVersion() { return PREGRASP_VERSION; }

const char* GitHash() { return internal::kGitHash; }

std::map<std::string, std::string> BuildLibraries() {
  return {
      {"eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"mrpt",
       fmt::format("{}.{}.{}", MRPT_VERSION >> 8, MRPT_VERSION >> 4 & 15, MRPT_VERSION & 15)},
      {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"zlib", zlibVersion()},
  };
}

}  // namespace pregrasp
