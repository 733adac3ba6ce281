#include "bindings/ladder_file.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "app/core/data_folder.h"
#include "bindings/function.h"
#include "bindings/lua_scene.h"
#include "bindings/machine.h"
#include "bindings/sandbox.h"
#include "bindings/scene_file.h"

namespace pregrasp {

namespace {

namespace fs = std::filesystem;

// What ladder{..} gave.
struct LuaLadder {
  std::string scene, where;
  std::vector<LadderPose> poses;
};
const ClassInfo kLadderClass{"Ladder", {}, {}, nullptr};

const Schema kLadderKeys{"LadderTable", {"scene", "poses"}};
const Schema kPoseKeys{"LadderPoseTable", {"p", "rpy_deg", "press"}};
const Schema kPressKeys{"LadderPressTable", {"finger", "p_OC"}};

constexpr int kFewestPoses = 2, kMostPoses = 100;

}  // namespace

template <>
struct LuaClass<const LuaLadder> {
  static const ClassInfo& info() { return kLadderClass; }
};

namespace {

LadderPose ReadLadderPose(lua_State* L, const std::string& path, const std::string& where) {
  const Fields fields(L, lua_gettop(L), kPoseKeys, path + ".", where);
  LadderPose pose;
  pose.X_WO = ReadPose(fields);
  if (fields.Has("press")) {
    fields.Push("press");
    const Fields press(L, lua_gettop(L), kPressKeys, path + ".press.", where);
    pose.press = {press.Required<Finger>("finger"), press.Required<Vector3>("p_OC")};
    if (static_cast<int>(pose.press->finger) >= kNumPlanningFingers) {
      press.Refuse("finger", "thumb or index");
    }
    lua_pop(L, 1);
  }
  return pose;
}

std::shared_ptr<const LuaLadder> MakeLadder(OneTable table) {
  lua_State* L = table.L;
  LuaLadder ladder;
  ladder.where = WhereInLua(L);
  const Fields fields(L, 1, kLadderKeys, "", ladder.where);
  ladder.scene = fields.Required<std::string>("scene");
  fields.Push("poses");
  const int count = CheckList(L, lua_gettop(L), "poses", "a list of poses");
  if (count < kFewestPoses || count > kMostPoses) {
    throw InputError(ladder.where, "poses", fmt::format("{} to {}", kFewestPoses, kMostPoses),
                     std::to_string(count));
  }
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(L, -1, i);
    ladder.poses.push_back(ReadLadderPose(L, fmt::format("poses[{}]", i), ladder.where));
    lua_pop(L, 1);
  }
  lua_pop(L, 1);
  return std::make_shared<const LuaLadder>(std::move(ladder));
}

}  // namespace

Ladder LoadLadderFile(const fs::path& file, std::vector<Setting>& settings) {
  Machine machine(SceneFileLimits());
  lua_State* L = machine.state();
  static const FunctionInfo constructor = Function<&MakeLadder>("ladder", "table");
  PushFunction(L, constructor);
  SetGlobalForAll(L, constructor.name.c_str());
  machine.LoadFile(L, file);
  machine.Call(0, 1);
  const auto table = FindObject<const LuaLadder>(L, -1);
  if (!table) {
    throw InputError(file.string(), "", "\"return ladder { .. }\" at its end",
                     DescribeValue(L, -1));
  }
  FileAccess files;
  files.AllowReadsBelow(machine.script_folder());
  files.AllowProgramFiles(DataFolder());
  const fs::path beside = machine.script_folder() / table->scene;
  const fs::path scene =
      files.FindForReading(fs::is_regular_file(beside) ? beside.string() : table->scene);
  return {file.stem().string(), LoadSceneFile(scene, settings), table->poses};
}

}  // namespace pregrasp
