#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands/dataset.h"
#include "app/commands/progress.h"
#include "app/commands/seed_option.h"
#include "app/core/error.h"
#include "app/geometry/point_cloud.h"
#include "app/training/dataset_run.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

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

void ParseShard(const std::string& text, DatasetRun& run) {
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, run.shard);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, run.shards) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end) {
    throw InputError("--shard", "", "i/n, such as 1/2", text);
  }
}

// Every scene file in the folders that hold evaluation objects.
std::vector<fs::path> EvaluationScenes() {
  std::vector<fs::path> files;
  for (const char* folder : {"scenes", "app/training/evaluation_objects"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(DataFolder() / folder, none)) {
      if (entry.path().extension() == ".lua") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Shows how the items of a run come along.
std::function<void(const DatasetProgress&)> Report(const char* stage, ProgressLine& line) {
  return [stage, &line](const DatasetProgress& state) {
    line.Show(stage, static_cast<int>(state.done), static_cast<int>(state.total));
  };
}

int MakeGrasps(MakeOptions& options) {
  ParseShard(options.shard, options.run);
  ProgressLine line;
  MakeGraspItems(options.run, options.items.Resolve(), Report("objects with grasps", line));
  return 0;
}

int MakeLabels(MakeOptions& options) {
  ParseShard(options.shard, options.run);
  ProgressLine line;
  MakeLabelItems(options.run, options.items.Resolve(), options.grasps, options.generator,
                 Report("objects with labels", line));
  return 0;
}

void AddMakeOptions(CLI::App& command, MakeOptions& options) {
  command.add_option("--out", options.run.folder, "Folder for the items, one file each")
      ->required();
  command.add_option("--items", options.run.items, "Objects in the whole data set")
      ->capture_default_str();
  command.add_option("--shard", options.shard, "i/n: make every n-th item, from the i-th")
      ->capture_default_str();
  command.add_option("--threads", options.run.threads, "Threads; 0 is one per processor")
      ->capture_default_str();
  options.items.AddTo(command);
}

void AddGrasps(CLI::App& dataset, Action& action) {
  auto options = std::make_shared<MakeOptions>();
  CLI::App* command =
      dataset.add_subcommand("grasps",
                             "Grow feasible grasps on random objects; goes on where an "
                             "earlier run was cut off");
  AddMakeOptions(*command, *options);
  command->callback([options, &action] { action = [options] { return MakeGrasps(*options); }; });
}

void AddLabels(CLI::App& dataset, Action& action) {
  auto options = std::make_shared<MakeOptions>();
  CLI::App* command = dataset.add_subcommand(
      "labels", "Label contacts with the share of feasible completions; goes on likewise");
  command->add_option("GRASPS", options->grasps, "Merged data set of grasps")->required();
  command->add_option("--generator", options->generator, "Weights of the grasp generators")
      ->required();
  AddMakeOptions(*command, *options);
  options->items.AddLabelsTo(*command);
  command->callback([options, &action] { action = [options] { return MakeLabels(*options); }; });
}

void AddMerge(CLI::App& dataset, Action& action) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command =
      dataset.add_subcommand("merge", "Put the items of shards together, for pregrasp-train");
  command->add_option("FOLDERS", options->folders, "Where the items were made")->required();
  command->add_option("--items", options->items, "Take items 0 to this less 1")->required();
  command->add_option("--out", options->out, "Folder of the merged data set")->required();
  command->callback([options, &action] {
    action = [options] {
      if (options->items < 1) {
        throw InputError("--items", "", "at least 1", std::to_string(options->items));
      }
      MergeDataset(options->folders, options->items, options->out);
      return 0;
    };
  });
}

}  // namespace

void ItemOptions::AddTo(CLI::App& command) {
  command.add_option("--scenes", config.scenes, "Scenes of each object")->capture_default_str();
  AddSeedOption(command, config.seed, "Seed of everything random");
  command.add_option("--exclude", excluded,
                     "Scenes whose objects no training object may resemble; without this option, "
                     "all evaluation scenes");
}

void ItemOptions::AddLabelsTo(CLI::App& command) {
  command.add_option("--labels", config.labels.per_scene, "Labels of each scene")
      ->capture_default_str();
  command.add_option("--tries", config.labels.tries, "Completions at each relief")
      ->capture_default_str();
}

ItemConfig ItemOptions::Resolve() const {
  constexpr int kCompared = 500;  // points of an excluded object
  ItemConfig resolved = config;
  for (const fs::path& file : excluded.empty() ? EvaluationScenes() : excluded) {
    std::vector<Setting> settings;
    const Scene scene = LoadSceneFile(file, settings);
    const Rng rng(0, RngStream::kPointCloud);
    resolved.excluded.push_back(
        {scene.name, SamplePointCloud(scene.object().shape, kCompared, rng).P});
  }
  return resolved;
}

void AddDataset(CLI::App& app, Action& action) {
  CLI::App* dataset = app.add_subcommand("dataset", "Build training data, and look at it");
  dataset->require_subcommand(1);
  AddGrasps(*dataset, action);
  AddLabels(*dataset, action);
  AddMerge(*dataset, action);
  AddDatasetPictures(*dataset, action);
  AddDatasetProbe(*dataset, action);
}

}  // namespace pregrasp
