#include <fmt/core.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/dataset.h"
#include "app/core/error.h"
#include "app/graph/learned_scorer.h"
#include "app/training/labels.h"
#include "app/training/make_item.h"
#include "bindings/scene_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kCases = 3;  // thumb, index, both: GeneratorOf's order

struct ProbeOptions {
  fs::path scene, score, generator;
  std::vector<double> direction{1.0, 0.0, 0.0};
  double distance = 0.10;
  int steps = 10, contacts = 64, tries = 0;
  std::uint64_t seed = 1;
};

Placement ToPlacement(const PlanningContacts& contacts) {
  Placement placement;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (contacts[f]) placement.fingers[f] = {true, contacts[f]->p_OC, contacts[f]->nhat_O};
  }
  return placement;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// One scene, contacts that fingertips can have at its start, and what is said of them as the object
// moves.
class Prober {
 public:
  explicit Prober(const ProbeOptions& options)
      : options_(options),
        scene_(LoadScene(options.scene)),
        world_(MakeTrainingWorld(scene_)),
        cloud_(SamplePointCloud(scene_.object().shape, 512,
                                Rng(options.seed, RngStream::kPointCloud))),
        score_(ScoreFunction::Load(options.score)),
        scorer_(score_, scene_, cloud_, world_.environment(), pool_) {
    const auto X_WB = world_.StartPoses();
    const ContactSampler sampler(world_, X_WB, {});
    LabelConfig reachable;
    reachable.anywhere = 0.0;
    for (int which = 0; which < kCases; ++which) {
      for (int i = 0; i < options.contacts; ++i) {
        Rng rng(options.seed, RngStream::kDataset, which, i);
        contacts_[which].push_back(
            SampleLabelContacts(world_, sampler, {}, which, reachable, X_WB, rng));
      }
    }
    if (options.tries > 0) generator_ = GraspGenerator::Load(options.generator);
  }

  // The mean learned score with the object moved by p_W.
  double CalcScore(const Vector3& p_W, int which) const {
    std::vector<ScoredState> states;
    for (const PlanningContacts& contacts : contacts_[which]) {
      states.push_back({world_.StartPoses(), ToPlacement(contacts)});
      states.back().X_WB[0].translation() += p_W;
    }
    return Mean(scorer_.Score(states));
  }

  // The mean label there: what the score was to learn.
  double CalcLabels(const Vector3& p_W, int which) {
    Scene moved = scene_;
    moved.object().X_WB.translation() += p_W;
    const GraspWorld world = MakeTrainingWorld(moved);
    const CloudStructure structure =
        generator_->BuildStructure(cloud_.P, scene_.object().X_WB.linear());
    LabelConfig config;
    config.tries = options_.tries;
    std::vector<double> values(contacts_[which].size());
    pool_.ParallelFor(static_cast<int>(values.size()), [&](int i, int) {
      const Rng rng(options_.seed, RngStream::kDataset, kCases + which, i);
      values[i] = CalcLabel(world, *generator_, cloud_, structure, contacts_[which][i], config, rng)
                      .Value();
    });
    return Mean(values);
  }

 private:
  static Scene LoadScene(const fs::path& file) {
    std::vector<Setting> settings;
    return LoadSceneFile(file, settings);
  }

  const ProbeOptions& options_;
  Scene scene_;
  GraspWorld world_;
  PointCloud cloud_;
  ScoreFunction score_;
  ThreadPool pool_;
  LearnedScorer scorer_;
  std::optional<GraspGenerator> generator_;
  std::array<std::vector<PlanningContacts>, kCases> contacts_;
};

int Probe(const ProbeOptions& options) {
  const Vector3 direction(options.direction[0], options.direction[1], options.direction[2]);
  if (!(direction.norm() > 0.0)) throw InputError("--direction", "", "not zero", "zero");
  Prober prober(options);
  fmt::print("moved [mm]  score: thumb index  both{}\n",
             options.tries > 0 ? "   label: thumb index  both" : "");
  for (int step = 0; step <= options.steps; ++step) {
    const double moved = options.distance * step / options.steps;
    const Vector3 p_W = moved * direction.normalized();
    fmt::print("{:10.1f}       ", 1e3 * moved);
    for (int which = 0; which < kCases; ++which) {
      fmt::print(" {:5.3f}", prober.CalcScore(p_W, which));
    }
    if (options.tries > 0) {
      fmt::print("         ");
      for (int which = 0; which < kCases; ++which) {
        fmt::print(" {:5.3f}", prober.CalcLabels(p_W, which));
      }
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

void AddDatasetProbe(CLI::App& dataset, Action& action) {
  auto options = std::make_shared<ProbeOptions>();
  const fs::path weights = DataFolder() / "assets" / "weights";
  options->score = weights / "score.safetensors";
  options->generator = weights / "generator.safetensors";
  CLI::App* command = dataset.add_subcommand(
      "probe", "What the learned score says of a scene as its object is moved");
  command->add_option("SCENE", options->scene, "The scene, a Lua file")->required();
  command->add_option("--score", options->score, "Weights of the score function");
  command->add_option("--generator", options->generator, "Weights of the grasp generators");
  command->add_option("--direction", options->direction, "x,y,z in the world")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--distance", options->distance, "How far it is moved at most [m]")
      ->capture_default_str();
  command->add_option("--steps", options->steps, "Into so many steps")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--contacts", options->contacts, "Contacts that the scores are the mean of")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  command
      ->add_option("--tries", options->tries,
                   "Make labels too, with so many completions at each relief; takes minutes")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of everything random")->capture_default_str();
  command->callback([options, &action] { action = [options] { return Probe(*options); }; });
}

}  // namespace pregrasp
