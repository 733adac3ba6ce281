#include "app/recording/mrpt_codec.h"

#include <dlfcn.h>

#include <filesystem>

#include "app/core/data_folder.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// Beside the program, or as installed below a prefix: the program's, or that of the data, for a
// program of others. Else where this build put it.
fs::path FindModule() {
  const fs::path built = PREGRASP_MRPT_MODULE;
  const fs::path installed = fs::path("lib") / "pregrasp" / built.filename();
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& file : {program / built.filename(), program.parent_path() / installed,
                               DataFolder().parent_path().parent_path() / installed}) {
    if (fs::exists(file, error)) return file;
  }
  return built;
}

const MrptCodec& LoadModule() {
  const fs::path file = FindModule();
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const entry = module == nullptr ? nullptr : dlsym(module, "PregraspMrptCodec");
  if (entry == nullptr) {
    throw InputError(file.string(), "", "the program's module for MRPT logs", dlerror());
  }
  return *reinterpret_cast<const MrptCodec* (*)()>(entry)();
}

}  // namespace

const MrptCodec& GetMrptCodec() {
  static const MrptCodec& codec = LoadModule();
  return codec;
}

}  // namespace pregrasp
