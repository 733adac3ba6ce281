#include "app/studies/learning_trials.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/geometry/point_cloud.h"
#include "app/graph/learned_scorer.h"
#include "app/grasp/grasp_completion.h"
#include "app/grasp/grasp_search.h"
#include "app/job/job.h"
#include "app/networks/score_function.h"
#include "app/studies/free_object.h"
#include "app/studies/holding_press.h"
#include "app/training/make_item.h"
#include "app/training/metrics.h"
#include "app/training/search_labels.h"
#include "app/training/state_item.h"
#include "app/training/training_data.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kNumCases = 3;          // thumb, index, both: GeneratorOf's order
constexpr int kContactsOfPose = 200;  // of each case
constexpr const char* kScoreFile = "score.safetensors";
constexpr int kPartsOfGrasp = 1000;  // streams
constexpr double kHandSpan = 0.13;   // between contacts of one hand [m]

Json TrainingOf(const TensorFile& weights) { return Json::parse(weights.metadata_at("training")); }

bool IsRoom(const TensorFile& weights) {
  return TrainingOf(weights).value("progress", "relief") == "room";
}

// A context's object in the networks' eyes.
ObjectState SeenIn(const ContextRecord& context) {
  return {context.phi, context.occluded, context.X_WO.linear().row(2).transpose()};
}

// The score, asked about labels.
class ScoreJudge {
 public:
  explicit ScoreJudge(const fs::path& weights) : ScoreJudge(ReadTensors(weights / kScoreFile)) {}

  const std::vector<SetLevelConfig>& levels() const { return score_.encoder().config().levels; }
  const char* progress() const { return by_room_ ? "room" : "relief"; }

  // Visits (truth of progress, score, lifted, probability) of each label of the context.
  template <typename Visit>
  void Judge(const TrainingContext& context, const Visit& visit) const {
    std::vector<PlanningContacts> contacts;
    for (const TruthRecord* truth : context.truths) contacts.push_back(truth->contacts);
    CloudStructure structure = *context.structure;
    structure.R_WO0 = context.context->X_WO.linear();
    const ObjectState state = SeenIn(*context.context);
    const VectorX s = score_.ScoreContacts(structure, state, contacts, ScoreOutput::kProgress);
    const VectorX p = score_.ScoreContacts(structure, state, contacts, ScoreOutput::kLifted);
    for (Eigen::Index i = 0; i < s.size(); ++i) {
      const TruthRecord& truth = *context.truths[i];
      visit(by_room_ ? truth.room : truth.relief, s[i], truth.lifted ? 1.0 : 0.0, p[i]);
    }
  }

 private:
  explicit ScoreJudge(const TensorFile& file)
      : score_(ScoreFunction::FromTensors(file)), by_room_(IsRoom(file)) {}

  ScoreFunction score_;
  bool by_room_;
};

TrainingData PrepareToJudge(std::shared_ptr<const Dataset> dataset, const ScoreJudge& judge,
                            const std::vector<std::string>& families) {
  return PrepareTrainingData(
      std::move(dataset), judge.levels(), families,
      [](const TrainingContext& context) { return !context.truths.empty(); });
}

// What a grasp gives to one of the generators, with nothing around the object.
PlanningContacts GivenBy(const std::vector<GraspContact>& grasp, int which) {
  PlanningContacts given;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (which != 2 && which != f) continue;
    const GraspContact* contact = FindContact(grasp, static_cast<Finger>(f));
    if (contact) given[f] = PlanningContact{contact->p_OC, contact->nhat_O};
  }
  return given;
}

// What became of samples.
struct Tally {
  int samples = 0, raw = 0, feasible = 0, overlapping = 0;

  void Add(const CompletedGrasp& grasp) {
    ++samples;
    raw += grasp.raw.feasible();
    feasible += grasp.feasible();
    const std::vector<GraspContact>& tips = grasp.projected;
    const TipSpheres spheres;  // of the hand that the networks know
    bool overlap = false;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        overlap = overlap || CalcTipGap(spheres, tips[i], tips[j]) < 0.0;
      }
    }
    overlapping += overlap;
  }
  Json ToJson() const {
    return {
        {"samples", samples}, {"feasible", feasible}, {"raw", raw}, {"overlapping", overlapping}};
  }
};

// The given contacts, and for the other fingers any points of the surface that a hand's span from
// the anchor holds.
GraspPoints DrawPoints(const PlanningContacts& given, const MatrixX3& surface, Rng& rng) {
  constexpr int kDraws = 100;
  GraspPoints points;
  const Vector3 anchor = CalcAnchor(given);
  for (int f = 0; f < kNumFingers; ++f) {
    if (f < kNumPlanningFingers && given[f]) {
      points[f] = given[f]->p_OC;
      continue;
    }
    for (int draw = 0; draw < kDraws; ++draw) {
      points[f] = surface.row(rng.UniformInt(static_cast<std::uint32_t>(surface.rows())));
      if ((points[f] - anchor).norm() < kHandSpan) break;
    }
  }
  return points;
}

// The tenth of a pose's labels of one case that has the best scores, on the average.
Json FindBestTenth(const std::vector<TruthRecord>& truths, const VectorX& progress,
                   const VectorX& lifted, int which) {
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(truths.size()); ++i) {
    if (GeneratorOf(truths[i].contacts) == which) order.push_back(i);
  }
  if (order.size() < 10) return nullptr;
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return progress[a] > progress[b]; });
  Json best{{"contacts", order.size()}};
  double all = 0.0;
  for (const int i : order) all += truths[i].relief / static_cast<double>(order.size());
  order.resize((order.size() + 9) / 10);
  const auto mean = [&](const auto& value) {
    double sum = 0.0;
    for (const int i : order) sum += value(i);
    return sum / static_cast<double>(order.size());
  };
  best["score"] = mean([&](int i) { return progress[i]; });
  best["relief"] = mean([&](int i) { return truths[i].relief; });
  best["room"] = mean([&](int i) { return truths[i].room; });
  best["probability"] = mean([&](int i) { return lifted[i]; });
  best["lifted"] = mean([&](int i) { return truths[i].lifted ? 1.0 : 0.0; });
  best["relief_of_all"] = all;
  return best;
}

}  // namespace

std::vector<std::string> ReadHeldOutFamilies(const fs::path& weights) {
  const fs::path file = weights / kScoreFile;
  const Json training = TrainingOf(ReadTensors(file));
  if (!training.contains("validation") || training["validation"].empty()) {
    throw InputError(file.string(), "training", "families that were held out", "none");
  }
  return training["validation"].get<std::vector<std::string>>();
}

bool IsProgressRoom(const fs::path& weights) { return IsRoom(ReadTensors(weights / kScoreFile)); }

void JudgedLabels::Add(double progress, double s, double is_lifted, double p) {
  truth.push_back(progress);
  score.push_back(s);
  lifted.push_back(is_lifted);
  probability.push_back(p);
}

Json JudgedLabels::ToJson() const {
  return {{"labels", truth.size()},
          {"r2", CalcR2(truth, score)},
          {"rank", CalcRankCorrelation(truth, score)},
          {"auc", CalcAuc(lifted, probability)},
          {"calibration", CalcCalibrationError(lifted, probability)}};
}

namespace {

// Of labels in equal bins of what was predicted: the means of prediction and truth.
Json BinMeans(const std::vector<double>& truth, const std::vector<double>& prediction) {
  Json means = Json::array();
  for (const CalibrationBin& bin : CalcCalibration(truth, prediction)) {
    if (bin.count > 0) means.push_back({bin.mean_prediction, bin.mean_truth});
  }
  return means;
}

}  // namespace

Json JudgeScore(const fs::path& labels, const fs::path& weights) {
  const ScoreJudge judge(weights);
  const TrainingData data = PrepareToJudge(std::make_shared<Dataset>(ReadDataset(labels)), judge,
                                           ReadHeldOutFamilies(weights));
  JudgedLabels all, held, not_held;
  std::map<std::string, JudgedLabels> families;
  for (const TrainingContext& context : data.validation) {
    ThrowIfInterrupted();
    const bool pressed = context.context->kind.find("held") != std::string::npos;
    judge.Judge(context, [&](double truth, double s, double lifted, double p) {
      for (JudgedLabels* judged :
           {&families[context.item->family], &all, pressed ? &held : &not_held}) {
        judged->Add(truth, s, lifted, p);
      }
    });
  }
  Json by_family;
  for (const auto& [family, judged] : families) by_family[family] = judged.ToJson();
  return {{"labels", data.dataset->hash},
          {"progress", judge.progress()},
          {"all", all.ToJson()},
          {"held", held.ToJson()},
          {"not_held", not_held.ToJson()},
          {"families", by_family},
          {"progress_bins", BinMeans(all.truth, all.score)},
          {"lifted_bins", BinMeans(all.lifted, all.probability)}};
}

Json JudgeObjects(const LearningObjects& objects, std::int64_t begin, std::int64_t end,
                  std::uint64_t seed, const fs::path& weights, const GraspLibrary& library,
                  ThreadPool& pool, const TrialConfig& config) {
  StateItemConfig items;
  items.item = MakeUnseenItems(objects, seed);
  items.item.scenes = 1;
  items.motion.pushes = config.pushes;
  items.motion.states = config.states;
  std::vector<Dataset> found(end - begin);
  pool.ParallelFor(static_cast<int>(found.size()), [&](int i, int) {
    ThrowIfInterrupted();
    found[i].items.push_back(MakeStateItem(items, begin + i));
  });
  const ScoreJudge judge(weights);
  Json judged_objects = Json::array();
  for (std::int64_t index = begin; index < end; ++index) {
    ThrowIfInterrupted();
    const auto dataset = std::make_shared<const Dataset>(std::move(found[index - begin]));
    JudgedLabels judged;
    if (!dataset->items.front().truths.empty()) {
      const TrainingData data = PrepareToJudge(dataset, judge, {});
      for (const TrainingContext& context : data.training) {
        judge.Judge(context, [&](double truth, double s, double lifted, double p) {
          judged.Add(truth, s, lifted, p);
        });
      }
    }
    Json object = TryGenerator(objects, index, seed, weights, library, pool, config);
    object["truth"] = judged.truth;
    object["score"] = judged.score;
    object["lifted"] = judged.lifted;
    object["probability"] = judged.probability;
    judged_objects.push_back(std::move(object));
  }
  return {{"objects", judged_objects}};
}

Json TryGenerator(const LearningObjects& objects, std::int64_t index, std::uint64_t seed,
                  const fs::path& weights, const GraspLibrary& library, ThreadPool& pool,
                  const TrialConfig& config) {
  const FreeObject object(MakeUnseenItems(objects, seed), index);
  const GraspWorld world = MakeTrainingWorld(object.scene);
  const std::vector<RigidTransform> X_WB = world.StartPoses();
  const ContactPlaces places(world, X_WB);
  const GraspGenerator generator = GraspGenerator::Load(weights / "generator.safetensors");
  const CloudStructure structure = generator.BuildStructure(object.cloud.P, X_WB.front().linear());
  ObjectState state;
  state.up_O = -(X_WB.front().linear().transpose() * object.scene.gravity).normalized();
  const EncodedState encoded = generator.Encode(structure, state);

  const int draws = PlannerConfig().grasp_draws;
  GraspSearchConfig search;
  search.max_found = config.grasps;
  const auto draw = [&](int g, int part) {  // the third index is for refinement to split
    return Rng(seed, RngStream::kProbedContacts, index, kPartsOfGrasp * g + part);
  };
  const GraspSearchResult found =
      SearchGrasps(places, search, {}, draw(config.grasps, 0).NextU64(), pool);
  std::array<Tally, kNumCases> generated, single, nearest, random;
  std::vector<GeneratedGrasp> samples, single_draws, neighbours, points;
  std::vector<int> cases;
  for (int g = 0; g < std::min<int>(config.grasps, std::ssize(found.found)); ++g) {
    for (int which = 0; which < kNumCases; ++which) {
      const PlanningContacts given = GivenBy(found.found[g].contacts, which);
      Rng rng = draw(g, which);
      const auto grasps = generator.Sample(structure, encoded, given, config.samples * draws,
                                           draw(g, kNumCases + which));
      const std::vector<GraspPoints> near = library.FindNearest(object.box, given, config.samples);
      for (auto first = grasps.begin(); first != grasps.end(); first += draws) {
        const Rng refinement = draw(g, 2 * kNumCases + static_cast<int>(samples.size()));
        samples.push_back({*first, refinement, {first + 1, first + draws}});
        single_draws.push_back({*first, refinement});
        points.push_back({DrawPoints(given, world.surface().P, rng), refinement});
        const std::size_t k = (first - grasps.begin()) / draws;
        neighbours.push_back(
            {near.empty() ? points.back().points : near[k % near.size()], refinement});
        cases.push_back(which);
      }
    }
  }
  // Each alone: what one sample's refinement finds must not help another's.
  const auto complete = [&](const std::vector<GeneratedGrasp>& all,
                            std::array<Tally, kNumCases>& to) {
    std::vector<std::optional<CompletedGrasp>> done(all.size());
    pool.ParallelFor(static_cast<int>(all.size()), [&](int i, int) {
      ThrowIfInterrupted();
      done[i] = CompleteGrasp(places, CompletionConfig(), all[i], {});
    });
    for (std::size_t i = 0; i < all.size(); ++i) to[cases[i]].Add(*done[i]);
  };
  complete(samples, generated);
  complete(single_draws, single);
  complete(neighbours, nearest);
  complete(points, random);
  Json result{{"object", object.name}, {"family", object.family}, {"grasps", found.found.size()}};
  for (int which = 0; which < kNumCases; ++which) {
    result["generator"][kGeneratorNames[which]] = generated[which].ToJson();
    result["single_draw"][kGeneratorNames[which]] = single[which].ToJson();
    result["nearest"][kGeneratorNames[which]] = nearest[which].ToJson();
    result["random"][kGeneratorNames[which]] = random[which].ToJson();
  }
  return result;
}

Json ProbeLadder(const Ladder& ladder, std::uint64_t seed, const StudySetup& setup) {
  Job job({ladder.scene, seed, setup.planner, setup.weights}, setup.threads);
  const auto planner = job.GetPlanner(job.world().InitialState(), setup.planner);
  const ScoreFunction score = ScoreFunction::Load(setup.weights / kScoreFile);
  const PointCloud& cloud = planner->scorer().cloud();
  const CloudStructure structure =
      score.BuildStructure(cloud.P, ladder.scene.object().X_WB.linear());
  SearchLabelConfig labels;
  labels.thumbs = labels.indices = labels.pairs = labels.held_pairs = kContactsOfPose;

  std::vector<ReachedState> states(ladder.poses.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].state = FindHoldingPress(job.world(), ladder.poses[i], job.pool()).state;
    PlanOutcome outcome;
    outcome.end = states[i].state;
    states[i].fixed = KeptContacts(EndToScore(job.world(), outcome));
    if (!states[i].fixed.empty()) continue;
    for (const Finger finger : {Finger::kThumb, Finger::kIndex}) {
      job.world().LiftFinger(states[i].state, finger);
    }
  }
  std::vector<Json> poses(states.size());
  job.pool().ParallelFor(static_cast<int>(states.size()), [&](int i, int) {
    ThrowIfInterrupted();
    const std::vector<RigidTransform> X_WB = job.world().GetPoses(states[i].state);
    const SearchLabels known =
        LabelState(&job.world(), planner->grasp_world(), planner->room(), cloud, states[i], labels,
                   Rng(seed, RngStream::kProbedLabels, i).NextU64());
    std::vector<PlanningContacts> contacts;
    for (const TruthRecord& truth : known.truths) contacts.push_back(truth.contacts);
    const ObjectState seen =
        MakeObjectState(cloud, X_WB, planner->grasp_world().environment(), ladder.scene.gravity,
                        ladder.scene.tips.radius(Finger::kIndex));
    const VectorX progress = score.ScoreContacts(structure, seen, contacts, ScoreOutput::kProgress);
    const VectorX lifted = score.ScoreContacts(structure, seen, contacts, ScoreOutput::kLifted);
    poses[i] = {{"held", !states[i].fixed.empty()}, {"grasps", known.stats.found.front()}};
    for (int which = 0; which < kNumCases; ++which) {
      poses[i][kGeneratorNames[which]] = FindBestTenth(known.truths, progress, lifted, which);
    }
  });
  return {{"ladder", ladder.name}, {"seed", seed}, {"poses", poses}};
}

double TimeScore(const fs::path& weights) {
  constexpr int kRollouts = 128, kStates = 3, kRepeats = 5;
  const ScoreFunction score = ScoreFunction::Load(weights / kScoreFile);
  const FreeObject object(MakeUnseenItems(nullptr, 1), 0);
  const MatrixX3& P = object.cloud.P;
  const CloudStructure structure = score.BuildStructure(P, Matrix3::Identity());
  std::vector<ObjectState> states(kRollouts * kStates);
  std::vector<PlanningContacts> contacts(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].phi = VectorX::Constant(P.rows(), 0.05);
    states[i].occluded.assign(P.rows(), false);
    states[i].up_O = Vector3::UnitZ();
    for (auto& contact : contacts[i]) {
      contact =
          PlanningContact{P.row(static_cast<Eigen::Index>(i) % P.rows()), Vector3::UnitZ(), 0.05};
    }
  }
  ThreadPool alone(1);
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    score.ScoreStates(structure, states, contacts, alone);
    best = std::min(
        best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

}  // namespace pregrasp
