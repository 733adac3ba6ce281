#include "bindings/scene_file.h"

#include <algorithm>
#include <map>

#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/text.h"
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

FileAccess SceneFiles(const fs::path& folder) {
  FileAccess files;
  files.AllowReadsBelow(folder);
  files.AllowProgramFiles(DataFolder());
  return files;
}

// A hand that is named by its file lies beside the scene, or where files may be read.
fs::path FindHandFile(const Scene& scene, const fs::path& folder, const FileAccess& files,
                      const std::string& where) {
  try {
    std::error_code ignored;
    const fs::path beside = folder / scene.hand;
    return files.FindForReading(fs::exists(beside, ignored) ? beside.string() : scene.hand);
  } catch (const InputError& error) {
    throw InputError(where, "hand \"" + scene.hand + "\"", error.expected(), error.got());
  }
}

// What is not there is refused with the nearest scene that is.
void LoadWithHint(Machine& machine, const fs::path& file) {
  std::error_code ignored;
  const bool missing = fs::status(file, ignored).type() == fs::file_type::not_found;
  const fs::path nearest = missing ? FindNearestScene(file.string()) : fs::path();
  try {
    machine.LoadFile(machine.state(), file);
  } catch (const InputError& error) {
    if (nearest.empty()) throw;
    throw InputError(error.where(), error.field(), error.expected(),
                     error.got() + FormatHint(nearest.string()));
  }
}

}  // namespace

fs::path FindNearestScene(const std::string& name) {
  std::map<std::string, fs::path> files;
  for (const fs::path& folder : {fs::path("scenes"), DataFolder() / "scenes"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      const fs::path& file = entry.path();
      if (file.extension() == ".lua") files.emplace(file.stem().string(), file);
    }
  }
  std::vector<std::string> stems;
  for (const auto& [stem, file] : files) stems.push_back(stem);
  const std::string nearest = FindNearest(fs::path(name).stem().string(), stems);
  return nearest.empty() ? fs::path() : files.at(nearest);
}

std::string WhereHandIsNamed(const Scene& scene, const std::vector<Setting>& settings) {
  const auto last = std::find_if(settings.rbegin(), settings.rend(),
                                 [](const Setting& setting) { return setting.key == "hand"; });
  return last == settings.rend() ? scene.where : last->where;
}

void FindHandOf(Scene& scene, const fs::path& folder, const std::string& where) {
  if (IsHandFile(scene.hand)) {
    scene.hand = FindHandFile(scene, folder, SceneFiles(folder), where).string();
  }
  try {
    TakeHand(scene);
  } catch (const InputError& error) {
    if (!error.where().empty()) throw;
    throw InputError(where, "hand", error.expected(), error.got());
  }
}

MachineConfig SceneFileLimits() {
  MachineConfig config;
  config.seconds = kSceneSeconds;
  config.bytes = kSceneBytes;
  config.time_flag.clear();
  return config;
}

void FinishScene(Scene& scene, const fs::path& folder, std::vector<Setting>& settings) {
  const std::string hand_where = WhereHandIsNamed(scene, settings);
  ApplySceneSettings(scene, settings);
  ValidateScene(scene);
  const FileAccess files = SceneFiles(folder);
  for (Body& body : scene.bodies) {
    std::visit(FileFinder{folder, files, body.where}, body.shape);
  }
  FindHandOf(scene, folder, hand_where);
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
  LoadWithHint(machine, file);
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
