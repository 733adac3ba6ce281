// pregrasp-train: learns the score function and the grasp generators from a data set.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <utility>

#include "app/batch/run_items.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/sha256.h"
#include "app/core/text.h"
#include "app/training/generator_task.h"
#include "app/training/score_task.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;
constexpr int kInterrupted = 130;  // as shells have it for SIGINT

struct Options {
  std::vector<fs::path> data;
  fs::path out = "out/training";
  std::vector<std::string> validation;
  TrainingConfig training;
  ScoreTaskConfig score;
  GeneratorTaskConfig generator;
  std::string variant = "full", encoder = "default", source = "search", progress = "relief";
  std::string study, decoder = "flow";
  int seeds = 0;  // 0: one, into OUT itself
  std::string shard = "1/1";
  bool dry_run = false;
};

// Step, loss and time left: one line that renews itself on a terminal, plain lines otherwise.
class Reporter {
 public:
  explicit Reporter(std::string name) : name_(std::move(name)) {}

  void operator()(const TrainingProgress& progress) {
    const auto now = Clock::now();
    if (first_step_ < 0) {
      first_step_ = progress.step;
      start_ = shown_ = now;
      return;
    }
    const bool terminal = isatty(STDERR_FILENO) != 0;
    const bool due = now - shown_ > (terminal ? std::chrono::seconds(1) : std::chrono::seconds(30));
    if (!due && progress.metrics == nullptr) return;
    shown_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const auto done = static_cast<double>(progress.step - first_step_);
    const double left = seconds / done * static_cast<double>(progress.steps - progress.step);
    const std::string line =
        fmt::format("{}: step {}/{}, loss {:.4f}, {:.0f} steps/s, {:.0f} s left", name_,
                    progress.step, progress.steps, progress.loss, done / seconds, left);
    std::fprintf(stderr, "%s%s%s", terminal ? "\r\033[K" : "", line.c_str(), terminal ? "" : "\n");
    if (progress.metrics != nullptr) {
      Json short_metrics = *progress.metrics;
      short_metrics.erase("families");
      short_metrics.erase("calibration");
      std::fprintf(stderr, "%s  %s\n", terminal ? "\n" : "", short_metrics.dump().c_str());
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::string name_;
  std::int64_t first_step_ = -1;
  Clock::time_point start_, shown_;
};

void WriteJson(const fs::path& path, const Json& json) {
  std::ofstream out(path, std::ios::trunc);
  out << json.dump(1) << "\n";
  if (!out) throw InputError(path.string(), "", "a file that can be written", "a write error");
}

// Trains `task` into OUT/NAME.safetensors, with OUT/NAME.checkpoint and OUT/NAME.metrics.json.
// @return the metrics at the end.
template <typename Task>
Json Train(Task& task, const Options& options, const std::string& name) {
  fs::create_directories(options.out);
  TrainingConfig training = options.training;
  training.checkpoint = options.out / (name + ".checkpoint");
  const Json history = RunTraining(task, training, Reporter(name));
  WriteTensors(options.out / (name + ".safetensors"), task.Export());
  WriteJson(options.out / (name + ".metrics.json"),
            {{"task", Json::parse(task.Describe())},
             {"training", training.ToJson()},
             {"training_contexts", task.data().training.size()},
             {"validation_contexts", task.data().validation.size()},
             {"history", history}});
  return history.back().at("metrics");
}

// Trains with each of --seeds, one a folder OUT/seed-K, as the items of a batch: OUT/items has the
// metrics of each, and OUT/seeds.json those of all when all are there.
// @param task_of  makes the task of such options.
template <typename TaskOf>
int TrainSeeds(const Options& options, const std::string& name, const TaskOf& task_of) {
  BatchRun run;
  run.items = options.seeds;
  run.shard = ParseShard(options.shard);
  run.records = options.out / "records";
  run.only_count = options.dry_run;
  const Json description{{"task", Json::parse(task_of(options).Describe())},
                         {"training", options.training.ToJson()},
                         {"seeds", options.seeds},
                         {"program", Sha256OfProgram()}};
  const ItemFolder folder(options.out / "items", description.dump(), ".json",
                          run.only_count ? ItemFolder::Purpose::kLook : ItemFolder::Purpose::kMake);
  RunItems(
      run, folder,
      [&](std::int64_t index) {
        Options one = options;
        one.training.seed += static_cast<std::uint64_t>(index);
        const std::string seed = fmt::format("seed-{}", one.training.seed);
        one.out /= seed;
        auto task = task_of(one);
        const Json item{{"seed", one.training.seed}, {"metrics", Train(task, one, name)}};
        WriteWholeFile(folder.PathOf(index), item.dump(1) + "\n");
        return seed;
      },
      [&](const BatchProgress& counts) {
        if (options.dry_run) fmt::print("{}\n", DescribeCounts(options.out.string(), counts));
      });
  if (options.dry_run) return 0;
  Json all = Json::array();
  for (std::int64_t i = 0; i < run.items; ++i) {
    if (!folder.Has(i)) return 0;
    all.push_back(Json::parse(ReadWholeFile(folder.PathOf(i))));
  }
  WriteWholeFile(options.out / "seeds.json", all.dump(1) + "\n");
  return 0;
}

template <typename TaskOf>
int TrainAll(const Options& options, const std::string& name, const TaskOf& task_of) {
  if (options.seeds > 0) return TrainSeeds(options, name, task_of);
  for (const auto& [given, option] :
       {std::pair(options.shard != "1/1", "--shard"), std::pair(options.dry_run, "--dry-run")}) {
    if (given) throw InputError(option, "", "--seeds, which it goes with", "none");
  }
  auto task = task_of(options);
  Train(task, options, name);
  return 0;
}

SetEncoderConfig EncoderNamed(const std::string& name) {
  if (name == "default") return {};
  if (name == "paper") return PaperSetEncoderConfig();
  throw InputError("--encoder", "", "default or paper", name);
}

// Every variant with kStudySeeds seeds, each into files of its own, and OUT/ablations.json with how
// each ended. What is there already is not trained again.
int StudyAblations(const std::shared_ptr<const Dataset>& dataset, Options options) {
  constexpr int kStudySeeds = 3;
  Json study{{"dataset", dataset->hash},
             {"validation", options.validation},
             {"training", options.training.ToJson()}};
  for (const ScoreVariant variant : {ScoreVariant::kFull, ScoreVariant::kNoSdf,
                                     ScoreVariant::kNoShape, ScoreVariant::kFrozenEncoder}) {
    for (int i = 0; i < kStudySeeds; ++i) {
      Options one = options;
      one.training.seed = options.training.seed + i;
      one.score.seed = one.training.seed;
      one.score.variant = variant;
      const std::string name = fmt::format("{}-{}", ScoreVariantName(variant), one.training.seed);
      ScoreTask task(dataset, one.validation, one.score);
      study["variants"][ScoreVariantName(variant)].push_back(Train(task, one, name));
      Json& constant = study["variants"]["constant"];
      if (constant.is_null()) constant = Json::array({task.EvaluateConstant()});
    }
  }
  WriteJson(options.out / "ablations.json", study);
  return 0;
}

int TrainScore(Options options) {
  options.score.encoder = EncoderNamed(options.encoder);
  options.score.variant = ParseScoreVariant(options.variant);
  options.score.source = ParseLabelSource(options.source);
  options.score.progress = ParseProgressKind(options.progress);
  if (options.score.mirror && options.score.source != LabelSource::kSearch) {
    throw InputError("--mirror", "", "--source search, whose progress has no right or left",
                     options.source);
  }
  const auto dataset = std::make_shared<Dataset>(ReadDatasets(options.data));
  if (options.study == "ablations") return StudyAblations(dataset, options);
  if (!options.study.empty()) throw InputError("--study", "", "ablations", options.study);
  return TrainAll(options, "score", [&](const Options& one) {
    ScoreTaskConfig config = one.score;
    config.seed = one.training.seed;
    return ScoreTask(dataset, one.validation, config);
  });
}

int TrainGenerator(Options options) {
  options.generator.encoder = EncoderNamed(options.encoder);
  options.generator.decoder = ParseGeneratorDecoder(options.decoder);
  const auto dataset = std::make_shared<Dataset>(ReadDatasets(options.data));
  return TrainAll(options, "generator", [&](const Options& one) {
    GeneratorTaskConfig config = one.generator;
    config.seed = one.training.seed;
    return GeneratorTask(dataset, one.validation, config);
  });
}

void AddCommonOptions(CLI::App& command, Options& options) {
  command.add_option("data", options.data, "Folders of merged data sets, or files of packed ones")
      ->required();
  command.add_option("--out", options.out, "Where weights, metrics and checkpoint go")
      ->capture_default_str();
  command.add_option("--validation", options.validation, "Families held out, comma-separated")
      ->delimiter(',');
  command.add_option("--steps", options.training.steps, "Optimiser steps")->capture_default_str();
  command.add_option("--rate", options.training.learning_rate, "Learning rate")
      ->capture_default_str();
  command.add_option("--decay", options.training.weight_decay, "Weight decay")
      ->capture_default_str();
  command.add_option("--seed", options.training.seed, "Of everything random")
      ->capture_default_str();
  command
      .add_option("--seeds", options.seeds,
                  "Train with so many seeds from --seed on, each into a folder of OUT")
      ->check(CLI::Range(1, 10'000));
  command.add_option("--shard", options.shard, "i/n: every n-th of them, from the i-th")
      ->capture_default_str();
  command.add_flag("--dry-run", options.dry_run, "Train nothing: say how many seeds there are");
  command
      .add_option("--evaluate-every", options.training.evaluate_every,
                  "Steps between evaluations on the families held out")
      ->capture_default_str();
  command.add_option("--encoder", options.encoder, "default, or paper for its PointNet++")
      ->capture_default_str();
}

int Fail(int code, const std::string& message) {
  std::fprintf(stderr, "%s\n", OneLine(message).c_str());
  return code;
}

int Run(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Learns pregrasp's networks from a data set made by `pregrasp dataset`. Can be cut "
      "off at any moment: the same command goes on where it was.",
      "pregrasp-train");
  app.require_subcommand(1);
  CLI::App* score = app.add_subcommand("score", "The score function");
  AddCommonOptions(*score, options);
  score->add_option("--variant", options.variant, "full, no-sdf, no-shape or frozen-encoder")
      ->capture_default_str();
  score
      ->add_option("--source", options.source,
                   "Whose labels: search (progress and lifted), or completions (the paper's)")
      ->capture_default_str();
  score->add_option("--progress", options.progress, "What stands for progress: relief or room")
      ->capture_default_str();
  score->add_flag("--mirror", options.score.mirror,
                  "Learn half of the states mirrored, but for what only a right hand decides");
  score->add_option("--study", options.study,
                    "ablations: every variant with three seeds, and ablations.json");
  score->add_option("--labels", options.score.labels_per_context, "Labels per context and step")
      ->capture_default_str();
  CLI::App* generator = app.add_subcommand("generator", "The three grasp generators");
  AddCommonOptions(*generator, options);
  generator->add_option("--decoder", options.decoder, "flow, or autoencoder as in the paper")
      ->capture_default_str();
  generator
      ->add_option("--latent", options.generator.latent_size,
                   "Size of an autoencoder's latent space")
      ->capture_default_str();
  generator
      ->add_option("--spacing", options.generator.spacing_weight,
                   "Weight of what fingertips overlap by")
      ->capture_default_str();
  generator->add_option("--kl", options.generator.kl_weight, "Weight of the divergence")
      ->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    return Fail(kBadInput,
                std::string("pregrasp-train: ") + error.what() + " (see pregrasp-train --help)");
  }
  PrepareTorch();
  return score->parsed() ? TrainScore(options) : TrainGenerator(options);
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  using namespace pregrasp;  // NOLINT: the program's own namespace
  try {
    InstallInterruptHandler();
    return Run(argc, argv);
  } catch (const InputError& error) {
    return Fail(kBadInput, error.what());
  } catch (const Interrupted& error) {
    return Fail(kInterrupted, error.what());
  } catch (const std::exception& error) {
    return Fail(kInternalError, std::string("pregrasp-train: a bug of ours: ") + error.what());
  }
}
