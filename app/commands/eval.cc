#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "app/batch/run_items.h"
#include "app/commands/commands.h"
#include "app/commands/progress.h"
#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/job/planner_settings.h"
#include "app/studies/eval.h"
#include "app/studies/report.h"
#include "app/training/object_folder.h"
#include "bindings/ladder_file.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

struct EvalOptions {
  std::string study = "table1", scenes = "all", shard = "1/1";
  int seeds = 3;
  std::uint64_t first_seed = 1;
  fs::path out, weights, objects;
  RunConfig run;
  int threads = 0;
  std::vector<std::string> settings;
  bool keep_runs = false, dry_run = false;
};

// Of `eval merge` and `eval report`.
struct FoldersOptions {
  std::vector<fs::path> folders;
  fs::path out;
};

std::vector<std::string> SplitList(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  return words;
}

// As it is from the working directory, where that is below it: words of pictures and logs have it.
fs::path Shorten(const fs::path& file) {
  const fs::path near = fs::proximate(file);
  return near.begin()->string() == ".." ? file : near;
}

// The files that --scenes means: all of a folder of ours, or names there, or files by their path.
std::vector<fs::path> FindFiles(const std::string& list, const fs::path& folder) {
  std::vector<fs::path> files;
  if (list == "all") {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".lua") files.push_back(Shorten(entry.path()));
    }
    std::sort(files.begin(), files.end());
    return files;
  }
  for (const std::string& word : SplitList(list)) {
    const bool name = fs::path(word).filename() == word && fs::path(word).extension() != ".lua";
    files.push_back(name ? Shorten(folder / (word + ".lua")) : fs::path(word));
    if (word.empty() || !fs::is_regular_file(files.back())) {
      std::vector<std::string> names;
      for (const fs::path& file : FindFiles("all", folder)) names.push_back(file.stem().string());
      throw InputError("--scenes", "", fmt::format("all, names of {} or files", folder.string()),
                       '"' + word + '"' + FormatHint(FindNearest(word, names)));
    }
  }
  if (files.empty()) throw InputError("--scenes", "", "all, or a list with commas", "nothing");
  return files;
}

// Each file takes the scene's settings that fit it, so a list of scenes needs a fresh one each.
template <typename Loaded, typename Load>
std::vector<Loaded> LoadAll(const std::vector<fs::path>& files,
                            const std::vector<Setting>& settings, PlannerConfig& planner,
                            const Load& load) {
  std::vector<Loaded> loaded;
  for (const fs::path& file : files) {
    std::vector<Setting> left = settings;
    loaded.push_back(load(file, left));
    planner = {};
    ApplyPlannerSettings(planner, left);
    RequireNoSettingsLeft(left, PlannerRoots());
  }
  return loaded;
}

EvalConfig MakeConfig(const EvalOptions& options) {
  EvalConfig config;
  config.study = options.study;
  config.shard = ParseShard(options.shard);
  if (options.out.empty()) throw InputError("--out", "", "a folder for the results", "nothing");
  config.out = options.out;
  StudySetup& setup = config.setup;
  setup.seeds = options.seeds;
  setup.first_seed = options.first_seed;
  if (options.first_seed > std::numeric_limits<std::uint64_t>::max() - options.seeds) {
    throw InputError("--first-seed", "", "so many seeds to be left", "too large a number");
  }
  setup.run = options.run;
  setup.threads = options.threads;
  setup.weights = options.weights.empty() ? DataFolder() / "assets" / "weights" : options.weights;
  if (!options.objects.empty()) {
    if (!FindStudy(options.study).takes_objects) {
      throw InputError("--objects", "", "--study learning, which judges networks by them",
                       options.study);
    }
    setup.objects =
        std::make_shared<const std::vector<TrainingObject>>(ReadObjectFolder(options.objects));
  }
  if (options.keep_runs) setup.runs = options.out / "runs";
  std::vector<Setting> settings;
  for (const std::string& setting : options.settings) settings.push_back(ParseSetting(setting));
  const StudySubject subject = FindStudy(options.study).subject;
  if (subject == StudySubject::kMade) {
    if (options.scenes != "all") {
      throw InputError("--scenes", "", "none, as the study makes its own problems",
                       '"' + options.scenes + '"');
    }
    ApplyPlannerSettings(setup.planner, settings);
    RequireNoSettingsLeft(settings, PlannerRoots());
  } else if (subject == StudySubject::kLadders) {
    setup.ladders = LoadAll<Ladder>(FindFiles(options.scenes, DataFolder() / "tests" / "ladders"),
                                    settings, setup.planner, LoadLadderFile);
  } else {
    setup.scenes = LoadAll<Scene>(FindFiles(options.scenes, DataFolder() / "scenes"), settings,
                                  setup.planner, LoadSceneFile);
  }
  return config;
}

int Eval(const EvalOptions& options) {
  EvalConfig config = MakeConfig(options);
  if (options.dry_run) {
    config.only_count = true;
    RunEval(config, [&](const EvalProgress& progress) {
      fmt::print("{}\n", DescribeCounts(config.out.string(), progress.batch));
    });
    return 0;
  }
  ProgressLine line;
  const bool complete = RunEval(config, [&](const EvalProgress& progress) {
    if (!progress.made.empty()) {
      line.Clear();
      fmt::print("{}\n", progress.made);
      std::fflush(stdout);
    }
    line.Show(config.study, static_cast<int>(progress.batch.done),
              static_cast<int>(progress.batch.total));
  });
  line.Clear();
  fmt::print(
      "{}: {}\n", config.out.string(),
      complete ? "complete" : "this shard is done; put all together with pregrasp eval merge");
  return 0;
}

std::string StudyHelp() {
  std::string text;
  for (const StudyInfo& study : Studies()) {
    text += (text.empty() ? "" : "; ") + study.name + ": " + study.text;
  }
  return text;
}

}  // namespace

void AddEval(const Subcommand& app, Action& action) {
  auto options = std::make_shared<EvalOptions>();
  const Subcommand eval = app.AddCommand(
      "eval",
      "Run a study of many scenes and seeds, and make its tables; goes on where an earlier "
      "run was cut off");
  eval.Add("--study", options->study, StudyHelp()).ShowDefault();
  eval.Add("--scenes", options->scenes, "all, or names or files with commas between").ShowDefault();
  eval.Add("--seeds", options->seeds, "Seeds of each scene")
      .Within(StudySetup::kSeeds)
      .ShowDefault();
  eval.AddSeed("--first-seed", options->first_seed, "The first of them");
  eval.Add("--shard", options->shard, "i/n: make every n-th item, from the i-th").ShowDefault();
  eval.Add("--out", options->out, "Folder of the results");
  eval.Add("--paths", options->run.paths, "Paths to optimise at most")
      .Within(RunConfig::kPaths)
      .ShowDefault();
  eval.Add("--threads", options->threads, "Threads of each run; 0 is one per processor")
      .Within(ThreadPool::kThreads)
      .ShowDefault();
  eval.Add("--set", options->settings, "Change a value of every scene or of the planner, as in run")
      .OneAtATime();
  eval.Add("--weights", options->weights, "Folder of the networks' weights");
  eval.Add("--objects", options->objects,
           "Folder of meshes that the study learning judges the networks by, too; an objects.csv "
           "there says file, category, mass_kg, quality");
  eval.AddFlag("--keep-runs", options->keep_runs, "Keep each item's run directory in OUT/runs");
  eval.AddFlag("--dry-run", options->dry_run, "Make nothing: say how many items there are");

  // Whichever of the command and its parts is read last, a part that was named is what is done.
  auto part_chosen = std::make_shared<bool>(false);
  eval.OnChosen([options, part_chosen, &action] {
    if (!*part_chosen) action = [options] { return Eval(*options); };
  });
  const auto add_part = [&](const std::string& name, const std::string& text,
                            const std::string& out,
                            void (*what)(const std::vector<fs::path>&, const fs::path&)) {
    auto folders = std::make_shared<FoldersOptions>();
    const Subcommand part = eval.AddCommand(name, text);
    part.Add("DIRS", folders->folders, "Folders of studies").Required();
    part.Add("--out", folders->out, out).Required();
    part.OnChosen([folders, part_chosen, what, &action] {
      *part_chosen = true;
      action = [folders, what] {
        what(folders->folders, folders->out);
        return 0;
      };
    });
  };
  add_part("merge", "Put shards together into one result; refuses other builds, scenes or settings",
           "Folder of the whole", MergeEval);
  add_part("report",
           "Write the tables of finished studies as one document, with pictures of runs "
           "that were kept",
           "The Markdown file", WriteReport);
}

}  // namespace pregrasp
