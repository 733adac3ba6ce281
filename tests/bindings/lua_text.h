#pragma once

#include <filesystem>
#include <string>

#include "app/core/error.h"
#include "bindings/machine.h"
#include "tests/test_folder.h"

namespace pregrasp {

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
