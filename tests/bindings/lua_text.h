#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "app/core/error.h"
#include "bindings/machine.h"

namespace pregrasp {

/// A folder for one test's files, removed with it.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "pregrasp_test_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path Write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// What `text` returns as a string, run as a script of its own.
inline std::string RunLua(const std::string& text, const MachineConfig& config = {}) {
  const TestFolder folder;
  Machine machine(config);
  machine.LoadFile(machine.state(), folder.Write("test.lua", text));
  machine.Call(0, 1);
  luaL_tolstring(machine.state(), -1, nullptr);
  return lua_tostring(machine.state(), -1);
}

/// The line with which `text` fails, without the folder's name; empty if it does not fail.
inline std::string LuaError(const std::string& text, const MachineConfig& config = {}) {
  try {
    RunLua(text, config);
  } catch (const InputError& error) {
    const std::string line = error.what();
    const std::size_t file = line.find("test.lua");
    return file == std::string::npos ? line : line.substr(file);
  }
  return "";
}

}  // namespace pregrasp
