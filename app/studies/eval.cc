#include "app/studies/eval.h"
#include "app/recording/partial_directory.h"

#include <cstdlib>
#include <set>

#include <nlohmann/json.hpp>

#include "app/core/error.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"
#include "app/core/json_values.h"
#include "app/core/sha256.h"
#include "app/job/planner_settings.h"
#include "app/recording/build_info.h"
#include "app/recording/manifest.h"
#include "app/recording/scene_file.h"
#include "app/training/make_item.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStudyItemExtension = ".json";

// A folder for what is written to be hashed, removed with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "pregrasp-scene-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw InputError(name, "", "a folder to write to", "none");
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Of all that the resolved scene is: every body with its mesh, and the step.
std::string HashScene(const Scene& scene) {
  const ScratchFolder folder;
  WriteScene(folder.path(), scene, StepConfig{}.dt);
  std::string sums;
  for (const std::string& file : ListRunFiles(folder.path()).files) {
    sums += file + " " + Sha256OfFile(folder.path() / file) + "\n";
  }
  return Sha256(sums);
}

Json DescribePoses(const Ladder& ladder) {
  Json poses = Json::array();
  for (const LadderPose& pose : ladder.poses) {
    Json entry;
    entry["p"] = ToJson(Vector3(pose.X_WO.translation()));
    entry["q"] = QuaternionJson(pose.X_WO.linear());
    if (pose.press) {
      entry["press"] = FingerName(pose.press->finger);
      entry["p_OC"] = ToJson(pose.press->p_OC);
    }
    poses.push_back(std::move(entry));
  }
  return poses;
}

// All that decides a study's items. The program's own bytes stand for the build: two builds of one
// commit may differ.
std::string Describe(const EvalConfig& config, std::int64_t items) {
  const StudySetup& setup = config.setup;
  Json json;
  json["study"] = config.study;
  json["items"] = items;
  json["version"] = ProgramVersion();
  json["git"] = GitHash();
  json["program"] = Sha256OfProgram();
  json["first_seed"] = setup.first_seed;
  json["seeds"] = setup.seeds;
  json["paths"] = setup.run.paths;
  for (const char* name : {"score", "generator"}) {
    json["weights"][name] = Sha256OfFile(setup.weights / (std::string(name) + ".safetensors"));
  }
  for (const Scene& scene : setup.scenes) {
    json["scenes"].push_back({{"name", scene.name}, {"sha256", HashScene(scene)}});
  }
  for (const Ladder& ladder : setup.ladders) {
    json["ladders"].push_back({{"name", ladder.name},
                               {"scene", HashScene(ladder.scene)},
                               {"poses", DescribePoses(ladder)}});
  }
  if (setup.objects) {
    ItemConfig given;
    given.objects = setup.objects;
    json["objects"] = Json::parse(given.ToJson()).at("objects");
  }
  json["settings"] = PlannerSettings(setup.planner);
  return FormatJson(json);
}

void RequireRules(const StudySetup& setup) {
  const auto require = [](const std::string& where, const std::vector<std::string>& departures) {
    if (departures.empty()) return;
    throw InputError(where, "", "a scene and settings within the rules, as for every table",
                     departures.front());
  };
  const auto require_scene = [&](const Scene& scene) {
    require(scene.file, RuleDepartures(scene, setup.planner));
  };
  for (const Scene& scene : setup.scenes) require_scene(scene);
  for (const Ladder& ladder : setup.ladders) require_scene(ladder.scene);
  require("settings", RuleDepartures(setup.planner));  // of a study without scenes
}

void RequireDistinct(const std::vector<Scene>& scenes) {
  std::set<std::string> names;
  for (const Scene& scene : scenes) {
    if (names.insert(scene.name).second) continue;
    throw InputError("", "scenes", "scenes of different names", "\"" + scene.name + "\" twice");
  }
}

nlohmann::json ReadItem(const fs::path& file) {
  return ParseJson(ReadWholeFile(file), file.string());
}

// A whole study: shards that are put together.
struct WholeStudy {
  std::string name, description;
  std::vector<std::string> texts;  // of the items, in their order
  std::vector<nlohmann::json> items;
};

WholeStudy ReadWholeStudy(const std::vector<fs::path>& folders) {
  std::vector<fs::path> sources;
  sources.reserve(folders.size());
  for (const fs::path& folder : folders) sources.push_back(folder / "items");
  const ItemFolders from(sources, kStudyItemExtension, "study");
  const nlohmann::json json =
      ParseJson(from.description(), (sources[0] / "description.json").string());
  const JsonReader fields(json, sources[0].string());
  WholeStudy study{fields["study"].Text(), from.description(), {}, {}};
  const auto count = static_cast<std::int64_t>(fields["items"].Number());
  for (std::int64_t i = 0; i < count; ++i) {
    const fs::path item = from.Find(i);
    study.texts.push_back(ReadWholeFile(item));
    study.items.push_back(ParseJson(study.texts.back(), item.string()));
  }
  return study;
}

void WriteTables(const StudyInfo& study, const std::vector<nlohmann::json>& items,
                 const fs::path& out) {
  for (const auto& [name, text] : study.tabulate(items)) WriteWholeFile(out / name, text);
}

}  // namespace

bool RunEval(const EvalConfig& config, const std::function<void(const EvalProgress&)>& progress) {
  config.shard.Validate();
  config.setup.planner.Validate();
  config.setup.run.Validate();
  RequireDistinct(config.setup.scenes);
  RequireRules(config.setup);
  RequireOutsideRuns(config.out / "items");
  const StudyInfo& info = FindStudy(config.study);
  const std::unique_ptr<Study> study = info.make(config.setup);
  BatchRun run;
  run.items = study->num_items();
  run.shard = config.shard;
  run.records = config.out / "records";
  run.only_count = config.only_count;
  const ItemFolder folder(config.out / "items", Describe(config, run.items), kStudyItemExtension,
                          run.only_count ? ItemFolder::Purpose::kLook : ItemFolder::Purpose::kMake);
  std::string made;
  RunItems(
      run, folder,
      [&](std::int64_t index) {
        const Json item = study->MakeItem(index);
        WriteWholeFile(folder.PathOf(index), FormatJsonIndented(item));
        made = info.describe(item);
        return made;
      },
      [&](const BatchProgress& batch) {
        if (progress) progress({batch, made});
      });
  if (run.only_count) return false;
  std::vector<nlohmann::json> items;
  for (std::int64_t i = 0; i < run.items; ++i) {
    if (!folder.Has(i)) return false;
    items.push_back(ReadItem(folder.PathOf(i)));
  }
  WriteTables(info, items, config.out);
  return true;
}

std::vector<nlohmann::json> ReadEval(const fs::path& folder) {
  return ReadWholeStudy({folder}).items;
}

void MergeEval(const std::vector<fs::path>& folders, const fs::path& out) {
  const WholeStudy study = ReadWholeStudy(folders);
  const ItemFolder folder(out / "items", study.description, kStudyItemExtension);
  for (std::size_t i = 0; i < study.texts.size(); ++i) {
    WriteWholeFile(folder.PathOf(static_cast<std::int64_t>(i)), study.texts[i]);
  }
  WriteTables(FindStudy(study.name), study.items, out);
}

}  // namespace pregrasp
