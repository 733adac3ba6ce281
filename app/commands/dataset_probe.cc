#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/dataset.h"
#include "app/core/data_folder.h"
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

// What is said of a scene as its object moves.
class Prober {
 public:
  explicit Prober(const ProbeOptions& options)
      : options_(options),
        scene_(LoadScene(options.scene)),
        world_(MakeTrainingWorld(scene_)),
        cloud_(SamplePointCloud(scene_.object().shape, 512,
                                Rng(options.seed, RngStream::kObjectCloud))),
        score_(ScoreFunction::Load(options.score)),
        scorer_(score_, scene_, cloud_, world_.environment(), pool_) {
    for (int which = 0; which < kCases; ++which) {
      start_contacts_[which] = SampleContacts(world_.StartPoses(), which);
    }
    if (options.tries > 0) generator_ = GraspGenerator::Load(options.generator);
  }

  std::vector<RigidTransform> PosesMovedBy(const Vector3& p_W) const {
    std::vector<RigidTransform> X_WB = world_.StartPoses();
    X_WB[0].translation() += p_W;
    return X_WB;
  }

  // The mean score of the contacts drawn at the start, which move with the object.
  double CalcKept(const std::vector<RigidTransform>& X_WB, int which) const {
    return Mean(Score(X_WB, start_contacts_[which]));
  }

  struct Best {
    double score = 0.0, label = 0.0;  // means
  };
  // Of all contacts that fingertips can have now, the tenth that scores best.
  Best CalcBest(const std::vector<RigidTransform>& X_WB, int which) {
    const std::vector<PlanningContacts> contacts = SampleContacts(X_WB, which);
    const std::vector<double> scores = Score(X_WB, contacts);
    std::vector<int> order(contacts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return scores[a] > scores[b]; });
    order.resize((contacts.size() + 9) / 10);
    Best best;
    std::vector<PlanningContacts> chosen;
    for (const int i : order) {
      best.score += scores[i] / static_cast<double>(order.size());
      chosen.push_back(contacts[i]);
    }
    if (options_.tries > 0) best.label = Mean(Label(X_WB, chosen));
    return best;
  }

 private:
  static Scene LoadScene(const fs::path& file) {
    std::vector<Setting> settings;
    return LoadSceneFile(file, settings);
  }

  std::vector<PlanningContacts> SampleContacts(const std::vector<RigidTransform>& X_WB,
                                               int which) const {
    const ContactSampler sampler(world_, X_WB, {});
    LabelConfig config;
    config.anywhere = 0.0;
    std::vector<PlanningContacts> contacts;
    for (int i = 0; i < options_.contacts; ++i) {
      Rng rng(options_.seed, RngStream::kProbedContacts, which, i);
      contacts.push_back(SampleLabelContacts(world_, sampler, {}, which, config, X_WB, rng));
    }
    return contacts;
  }

  std::vector<double> Score(const std::vector<RigidTransform>& X_WB,
                            const std::vector<PlanningContacts>& contacts) const {
    std::vector<ScoredState> states;
    states.reserve(contacts.size());
    for (const PlanningContacts& each : contacts) states.push_back({X_WB, ToPlacement(each)});
    return scorer_.Score(states);
  }

  // What the score was to learn.
  std::vector<double> Label(const std::vector<RigidTransform>& X_WB,
                            const std::vector<PlanningContacts>& contacts) {
    Scene moved = scene_;
    for (std::size_t b = 0; b < X_WB.size(); ++b) moved.bodies[b].X_WB = X_WB[b];
    const GraspWorld world = MakeTrainingWorld(moved);
    const CloudStructure structure =
        generator_->BuildStructure(cloud_.P, scene_.object().X_WB.linear());
    LabelConfig config;
    config.tries = options_.tries;
    std::vector<double> values(contacts.size());
    pool_.ParallelFor(static_cast<int>(values.size()), [&](int i, int) {
      const Rng rng(options_.seed, RngStream::kProbedLabels, i);
      values[i] =
          CalcLabel(world, *generator_, cloud_, structure, contacts[i], config, rng).Value();
    });
    return values;
  }

  const ProbeOptions& options_;
  Scene scene_;
  GraspWorld world_;
  PointCloud cloud_;
  ScoreFunction score_;
  mutable ThreadPool pool_;
  LearnedScorer scorer_;
  std::optional<GraspGenerator> generator_;
  std::array<std::vector<PlanningContacts>, kCases> start_contacts_;
};

int Probe(const ProbeOptions& options) {
  const Vector3 direction(options.direction[0], options.direction[1], options.direction[2]);
  if (!(direction.norm() > 0.0)) throw InputError("--direction", "", "not zero", "zero");
  Prober prober(options);
  fmt::print("{:>10}   {:<19}   {:<19}{}\n", "moved [mm]", "kept: thumb index both",
             "best: thumb index both", options.tries > 0 ? "   label of best" : "");
  for (int step = 0; step <= options.steps; ++step) {
    const double moved = options.distance * step / options.steps;
    const auto X_WB = prober.PosesMovedBy(moved * direction.normalized());
    std::string kept, best, label;
    for (int which = 0; which < kCases; ++which) {
      kept += fmt::format(" {:6.3f}", prober.CalcKept(X_WB, which));
      const Prober::Best found = prober.CalcBest(X_WB, which);
      best += fmt::format(" {:6.3f}", found.score);
      if (options.tries > 0) label += fmt::format(" {:6.3f}", found.label);
    }
    fmt::print("{:10.1f}   {}   {}   {}\n", 1e3 * moved, kept, best, label);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace

void AddDatasetProbe(const Subcommand& dataset, Action& action) {
  auto options = std::make_shared<ProbeOptions>();
  const fs::path weights = DataFolder() / "assets" / "weights";
  options->score = weights / "score.safetensors";
  options->generator = weights / "generator.safetensors";
  const Subcommand command =
      dataset.AddCommand("probe", "What the learned score says of a scene as its object is moved");
  command.Add("SCENE", options->scene, "The scene, a Lua file").Required();
  command.Add("--score", options->score, "Weights of the score function");
  command.Add("--generator", options->generator, "Weights of the grasp generators");
  command.Add("--direction", options->direction, "x,y,z in the world").CommaSeparated(3);
  command.Add("--distance", options->distance, "How far it is moved at most [m]")
      .Within({0.0, 10.0})
      .ShowDefault();
  command.Add("--steps", options->steps, "Into so many steps").Within({1, 1000, 1}).ShowDefault();
  command.Add("--contacts", options->contacts, "Contacts that the scores are the mean of")
      .Within({1, 100'000, 1})
      .ShowDefault();
  command
      .Add("--tries", options->tries,
           "Make labels too, with so many completions at each relief; takes minutes")
      .Within({0, 1000, 1})
      .ShowDefault();
  command.AddSeed(options->seed, "Seed of everything random");
  command.OnChosen([options, &action] { action = [options] { return Probe(*options); }; });
}

}  // namespace pregrasp
