#include "app/recording/mrpt_codec.h"

#include <dlfcn.h>

#include <filesystem>

#include "app/core/error.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// Beside the program, or where this build put it.
fs::path FindModule() {
  const fs::path built = PREGRASP_MRPT_MODULE;
  std::error_code error;
  const fs::path beside =
      fs::read_symlink("/proc/self/exe", error).parent_path() / built.filename();
  return fs::exists(beside, error) ? beside : built;
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
