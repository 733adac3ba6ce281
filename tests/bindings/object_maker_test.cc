// assets/objects/make.lua in plain Lua, without the sandbox: the committed meshes are what it
// makes.
#include <gtest/gtest.h>

#include "app/core/lua_api.h"
#include "tests/bindings/run_program.h"

namespace pregrasp {
namespace {

const std::string kObjects = PREGRASP_SOURCE_DIR "/assets/objects/";

// What the script prints when it is run with one argument.
std::string Make(const std::string& name) {
  lua_State* L = luaL_newstate();
  luaL_openlibs(L);
  const std::string prologue = "printed = {} arg = {\"" + name +
                               "\"} function print(line) printed[#printed + 1] = line .. '\\n' end";
  const bool ready = luaL_dostring(L, prologue.c_str()) == LUA_OK;
  if (!ready || luaL_dofile(L, (kObjects + "make.lua").c_str()) != LUA_OK ||
      luaL_dostring(L, "return table.concat(printed)") != LUA_OK) {
    ADD_FAILURE() << lua_tostring(L, -1);
  }
  std::string text = lua_tostring(L, -1);
  lua_close(L);
  return text;
}

TEST(ObjectMakerTest, TheCommittedFilesAreWhatTheScriptMakes) {
  for (const char* name : {"plate", "container", "paper_roll", "c_shape"}) {
    EXPECT_EQ(Make(name), ReadText(kObjects + name + ".obj")) << name;
  }
  EXPECT_EQ(Make("paper_roll_points"), ReadText(kObjects + "paper_roll.ply"));
}

}  // namespace
}  // namespace pregrasp
