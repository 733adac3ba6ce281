#include "app/recording/build_info.h"

#include <fmt/core.h>
#include <gnu/libc-version.h>
#include <zlib.h>

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

namespace pregrasp {
namespace internal {
extern const char* const kGitHash;  // in the generated git_hash.cc
}

const char* ProgramVersion() { return PREGRASP_VERSION; }

const char* GitHash() { return internal::kGitHash; }

std::string Compiler() {
#ifdef __clang__
  return fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("gcc {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

namespace {

// "fcl" of .../libfcl.so.0.7.0: "0.7.0". Of what gives OpenGL the one that draws: MRPT may load
// others while it works.
std::map<std::string, std::string> LoadedVersions() {
  const std::map<std::string, std::string> names = {{"assimp", "assimp"},
                                                    {"ccd", "ccd"},
                                                    {"fcl", "fcl"},
                                                    {"nlopt", "nlopt"},
                                                    {PREGRASP_GL, PREGRASP_GL_SONAME},
                                                    {"qhull", "qhull_r"},
                                                    {"simbody", "SimTKsimbody"},
                                                    {"urdfdom", "urdfdom_model"}};
  const std::regex file(R"(/lib([\w+.-]+)\.so\.([0-9.]+)$)");
  std::map<std::string, std::string> versions;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::smatch match;
    if (!std::regex_search(line, match, file)) continue;
    for (const auto& [name, library] : names) {
      if (match[1] == library) versions[name] = match[2];
    }
  }
  return versions;
}

}  // namespace

std::string ProcessorFeatures() {
  std::ifstream in("/proc/cpuinfo");
  std::string flags;
  for (std::string line; flags.empty() && std::getline(in, line);) {
    if (line.rfind("flags", 0) == 0) flags = line + ' ';
  }
  std::string features;
  for (const char* feature : {"sse4_2", "avx", "avx2", "fma", "avx512f"}) {
    if (flags.find(std::string(" ") + feature + " ") == std::string::npos) continue;
    features += std::string(features.empty() ? "" : " ") + feature;
  }
  return features.empty() ? "none of sse4_2, avx, avx2, fma, avx512f" : features;
}

std::map<std::string, std::string> BuildLibraries() {
  std::map<std::string, std::string> versions = LoadedVersions();
  versions.merge(std::map<std::string, std::string>{
      {"eigen",
       fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"fmt",
       fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"glibc", gnu_get_libc_version()},
      {"lua", PREGRASP_LUA_VERSION},
      {"mrpt", PREGRASP_MRPT_VERSION},
      {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                    NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"zlib", zlibVersion()},
  });
  return versions;
}

}  // namespace pregrasp
