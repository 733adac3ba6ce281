#include "bindings/scene_file.h"

#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/geometry/load_shape.h"
#include "app/hand/hand_model.h"
#include "bindings/lua_scene.h"
#include "bindings/sandbox.h"
#include "bindings/value.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr double kSceneSeconds = 2.0;
constexpr std::size_t kSceneBytes = 64U << 20U;

// Rewrites the files that shapes name to paths relative to the scene's folder, wherever they were
// found among the folders that may be read.
struct FileFinder {
  const fs::path& folder;
  const FileAccess& files;
  const std::string& where;

  void Find(std::string& file) const {
    try {
      std::error_code ignored;
      const fs::path beside = fs::path(file).is_absolute() ? fs::path(file) : folder / file;
      const fs::path found =
          files.FindForReading(fs::exists(beside, ignored) ? beside.string() : file);
      if (found.lexically_normal() != beside.lexically_normal()) {
        file = fs::proximate(found, folder).string();
      }
    } catch (const InputError& error) {
      throw InputError(where, "shape \"" + file + "\"", error.expected(), error.got());
    }
  }
  void operator()(Mesh& mesh) const { Find(mesh.file); }
  void operator()(Cloud& cloud) const { Find(cloud.file); }
  void operator()(Union& whole) const {
    for (PlacedShape& part : whole.parts) std::visit(*this, part.shape);
  }
  template <typename Primitive>
  void operator()(Primitive& /*primitive*/) const {}
};

// A hand that is named by its file lies beside the scene, or where files may be read.
void FindHandFile(Scene& scene, const fs::path& folder, const FileAccess& files) {
  try {
    if (IsHandFile(scene.hand)) {
      std::error_code ignored;
      const fs::path beside = folder / scene.hand;
      scene.hand =
          files.FindForReading(fs::exists(beside, ignored) ? beside.string() : scene.hand).string();
    }
    TakeHand(scene);
  } catch (const InputError& error) {
    if (!error.where().empty()) throw;
    throw InputError(scene.where, "hand", error.expected(), error.got());
  }
}

}  // namespace

MachineConfig SceneFileLimits() {
  MachineConfig config;
  config.seconds = kSceneSeconds;
  config.bytes = kSceneBytes;
  config.time_flag.clear();
  return config;
}

void FinishScene(Scene& scene, const fs::path& folder, std::vector<Setting>& settings) {
  ApplySceneSettings(scene, settings);
  ValidateScene(scene);
  FileAccess files;
  files.AllowReadsBelow(folder);
  files.AllowProgramFiles(DataFolder());
  for (Body& body : scene.bodies) {
    std::visit(FileFinder{folder, files, body.where}, body.shape);
  }
  FindHandFile(scene, folder, files);
  LoadShapes(scene, folder);
}

Scene LoadSceneFile(const fs::path& file, std::vector<Setting>& settings) {
  Machine machine(SceneFileLimits());
  lua_State* L = machine.state();
  AllowOneScene(L);
  for (const FunctionInfo& constructor : SceneConstructors()) {
    PushFunction(L, constructor);
    SetGlobalForAll(L, constructor.name.c_str());
  }
  machine.LoadFile(L, file);
  machine.Call(0, 1);
  if (!IsScene(L, -1)) {
    throw InputError(file.string(), "", "\"return scene { .. }\" at its end", DescribeValue(L, -1));
  }
  Scene scene = ReadScene(L, -1);
  scene.file = file.string();
  FinishScene(scene, machine.script_folder(), settings);
  return scene;
}

}  // namespace pregrasp
