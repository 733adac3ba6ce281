#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/commands/dataset.h"
#include "app/commands/progress.h"
#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/gzip.h"
#include "app/training/dataset_run.h"
#include "app/training/evaluation_scenes.h"
#include "app/training/object_folder.h"
#include "app/training/packed_states.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr NumberRange kItems{1, 1e9, 1};

struct MakeOptions {
  DatasetRun run;
  ItemOptions items;
  std::string shard = "1/1";
  fs::path grasps, generator;  // of labels
};

struct MergeOptions {
  std::vector<fs::path> folders;
  std::int64_t items = 0;
  fs::path out;
};

// Shows how the items of a run come along.
std::function<void(const BatchProgress&)> Report(const char* stage, ProgressLine& line) {
  return [stage, &line](const BatchProgress& state) {
    line.Show(stage, static_cast<int>(state.done), static_cast<int>(state.total));
  };
}

using Progress = std::function<void(const BatchProgress&)>;

// Makes the items, or counts them.
int Make(MakeOptions& options, const char* stage,
         const std::function<void(const Progress&)>& make) {
  options.run.shard = ParseShard(options.shard);
  if (options.run.only_count) {
    make([&](const BatchProgress& counts) {
      fmt::print("{}\n", DescribeCounts(options.run.folder.string(), counts));
    });
    return 0;
  }
  ProgressLine line;
  make(Report(stage, line));
  return 0;
}

int MakeGrasps(MakeOptions& options) {
  return Make(options, "objects with grasps", [&](const Progress& progress) {
    MakeGraspItems(options.run, options.items.Resolve(), progress);
  });
}

int MakeLabels(MakeOptions& options) {
  return Make(options, "objects with labels", [&](const Progress& progress) {
    MakeLabelItems(options.run, options.items.Resolve(), options.grasps, options.generator,
                   progress);
  });
}

int MakeStates(MakeOptions& options) {
  StateItemConfig config;
  config.item = options.items.Resolve();
  return Make(options, "objects with searched states",
              [&](const Progress& progress) { MakeStateItems(options.run, config, progress); });
}

void AddMakeOptions(const Subcommand& command, MakeOptions& options) {
  command.Add("--out", options.run.folder, "Folder for the items, one file each").Required();
  command.Add("--items", options.run.items, "Objects in the whole data set")
      .Within(kItems)
      .ShowDefault();
  command.Add("--shard", options.shard, "i/n: make every n-th item, from the i-th").ShowDefault();
  command.Add("--threads", options.run.threads, "Threads; 0 is one per processor")
      .Within(ThreadPool::kThreads)
      .ShowDefault();
  command.AddFlag("--dry-run", options.run.only_count,
                  "Make nothing: say how many items there are");
  options.items.AddTo(command);
}

void AddGrasps(const Subcommand& dataset, Action& action) {
  auto options = std::make_shared<MakeOptions>();
  const Subcommand command =
      dataset.AddCommand("grasps",
                         "Grow feasible grasps on random objects; goes on where an "
                         "earlier run was cut off");
  AddMakeOptions(command, *options);
  command.OnChosen([options, &action] { action = [options] { return MakeGrasps(*options); }; });
}

void AddLabels(const Subcommand& dataset, Action& action) {
  auto options = std::make_shared<MakeOptions>();
  const Subcommand command = dataset.AddCommand(
      "labels", "Label contacts with the share of feasible completions; goes on likewise");
  command.Add("GRASPS", options->grasps, "Merged data set of grasps").Required();
  command.Add("--generator", options->generator, "Weights of the grasp generators").Required();
  AddMakeOptions(command, *options);
  options->items.AddLabelsTo(command);
  command.OnChosen([options, &action] { action = [options] { return MakeLabels(*options); }; });
}

void AddStates(const Subcommand& dataset, Action& action) {
  auto options = std::make_shared<MakeOptions>();
  options->items.config.scenes = StateItemConfig().item.scenes;
  const Subcommand command = dataset.AddCommand("states",
                                                "Move random objects, and label contacts in each "
                                                "state by contact searches; goes on likewise");
  AddMakeOptions(command, *options);
  command.OnChosen([options, &action] { action = [options] { return MakeStates(*options); }; });
}

void AddMerge(const Subcommand& dataset, Action& action) {
  auto options = std::make_shared<MergeOptions>();
  const Subcommand command =
      dataset.AddCommand("merge", "Put the items of shards together, for pregrasp-train");
  command.Add("FOLDERS", options->folders, "Where the items were made").Required();
  command.Add("--items", options->items, "Take items 0 to this less 1").Within(kItems).Required();
  command.Add("--out", options->out, "Folder of the merged data set").Required();
  command.OnChosen([options, &action] {
    action = [options] {
      MergeDataset(options->folders, options->items, options->out);
      return 0;
    };
  });
}

void AddPack(const Subcommand& dataset, Action& action) {
  struct PackOptions {
    fs::path data, out;
  };
  auto options = std::make_shared<PackOptions>();
  const Subcommand command = dataset.AddCommand(
      "pack", "Put states and their labels into one small file, which pregrasp-train reads too");
  command.Add("DATA", options->data, "Folder of a merged data set").Required();
  command
      .Add("--out", options->out, "File to write; packed further by gzip if its name ends in .gz")
      .Required();
  command.OnChosen([options, &action] {
    action = [options] {
      const TensorFile states = PackStates(ReadDataset(options->data));
      if (options->out.extension() == ".gz") {
        WriteWholeFile(options->out, Deflate(SerializeTensors(states)));
      } else {
        WriteTensors(options->out, states);
      }
      return 0;
    };
  });
}

}  // namespace

void ItemOptions::AddTo(const Subcommand& command) {
  command.Add("--scenes", config.scenes, "Scenes of each object")
      .Within({1, 1000, 1})
      .ShowDefault();
  command.AddSeed(config.seed, "Seed of everything random");
  command.Add("--exclude", excluded,
              "Scenes whose objects no training object may resemble; without this option, "
              "all evaluation scenes");
  command.Add(
      "--objects", objects,
      "Folder of meshes to take in turn instead of random household objects; an objects.csv "
      "there says file, category, mass_kg, quality");
}

void ItemOptions::AddLabelsTo(const Subcommand& command) {
  command.Add("--labels", config.labels.per_scene, "Labels of each scene")
      .Within({1, 10'000, 1})
      .ShowDefault();
  command.Add("--tries", config.labels.tries, "Completions at each relief")
      .Within({1, 1000, 1})
      .ShowDefault();
}

ItemConfig ItemOptions::Resolve() const {
  ItemConfig resolved = config;
  for (const fs::path& file : excluded.empty() ? FindEvaluationScenes(DataFolder()) : excluded) {
    std::vector<Setting> settings;
    const Scene scene = LoadSceneFile(file, settings);
    resolved.excluded.emplace_back(scene.name, scene.object().shape);
  }
  if (objects.empty()) return resolved;
  std::vector<TrainingObject> kept;
  for (TrainingObject& object : ReadObjectFolder(objects)) {
    if (ResemblesAny(object.shape, resolved.excluded)) {
      fmt::print("left out, as it resembles an object of a scene: {}\n", object.name);
      continue;
    }
    kept.push_back(std::move(object));
  }
  if (kept.empty()) {
    throw InputError("--objects", "", "a mesh unlike the objects of scenes", objects.string());
  }
  resolved.objects = std::make_shared<const std::vector<TrainingObject>>(std::move(kept));
  return resolved;
}

void AddDataset(const Subcommand& app, Action& action) {
  const Subcommand dataset = app.AddCommand("dataset", "Build training data, and look at it");
  dataset.RequireCommand();
  AddGrasps(dataset, action);
  AddLabels(dataset, action);
  AddStates(dataset, action);
  AddMerge(dataset, action);
  AddPack(dataset, action);
  AddDatasetPictures(dataset, action);
}

}  // namespace pregrasp
