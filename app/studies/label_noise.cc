#include "app/studies/label_noise.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "app/core/interrupt.h"
#include "app/dynamics/world.h"
#include "app/studies/free_object.h"
#include "app/training/metrics.h"
#include "app/training/search_labels.h"
#include "app/training/state_item.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;
using Repeats = std::vector<std::vector<double>>;  // [label][repeat]

double MeanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void AddRepeats(const std::vector<nlohmann::json>& objects, const char* name, Repeats& to) {
  for (const nlohmann::json& object : objects) {
    for (const nlohmann::json& label : object.at(name)) {
      to.push_back(label.get<std::vector<double>>());
    }
  }
}

// The share of the variance that is between labels, not between repeats of one.
double CalcSharedVariance(const Repeats& labels) {
  double within = 0.0, freedom = 0.0;
  std::vector<double> all;
  for (const std::vector<double>& label : labels) {
    const double mean = MeanOf(label);
    for (const double value : label) {
      within += (value - mean) * (value - mean);
      all.push_back(value);
    }
    freedom += static_cast<double>(label.size()) - 1.0;
  }
  if (freedom <= 0.0) return 0.0;
  const double mean = MeanOf(all);
  double total = 0.0;
  for (const double value : all) total += (value - mean) * (value - mean);
  if (total <= 0.0) return 0.0;
  return 1.0 - (within / freedom) / (total / (static_cast<double>(all.size()) - 1.0));
}

// The mean over the repeats of `metric(one repeat, mean of the others)`.
template <typename Metric>
double CompareWithOthers(const Repeats& labels, const Metric& metric) {
  if (labels.empty()) return 0.0;
  const std::size_t repeats = labels.front().size();
  double sum = 0.0;
  for (std::size_t r = 0; r < repeats; ++r) {
    std::vector<double> truth, others;
    for (const std::vector<double>& label : labels) {
      const double all = std::accumulate(label.begin(), label.end(), 0.0);
      truth.push_back(label[r]);
      others.push_back((all - label[r]) / static_cast<double>(repeats - 1));
    }
    sum += metric(truth, others);
  }
  return sum / static_cast<double>(repeats);
}

}  // namespace

Json RepeatLabels(std::int64_t index, std::uint64_t seed, bool by_room, ThreadPool& pool,
                  const LabelNoiseConfig& config) {
  StateItemConfig items;
  items.item = MakeUnseenItems(nullptr, seed);
  items.motion.pushes = config.pushes;
  items.motion.states = config.states;
  const auto draw = [&](std::uint64_t purpose, std::uint64_t repeat) {
    return Rng(items.item.seed, RngStream::kProbedLabels, index, purpose, repeat);
  };
  const SceneObject object = MakeItemObject(items.item, index);
  const PointCloud cloud = MakeItemCloud(items.item, object, index);
  Scene scene;
  for (int tries = 0; scene.bodies.size() < 2; ++tries) {
    scene = SampleRestingScene(object, draw(0, tries)).scene;
  }
  const World world(scene);
  const GraspWorld grasp_world = MakeTrainingWorld(scene);
  std::vector<std::optional<GraspRoom>> rooms(config.repeats + 1);
  for (int r = 0; r <= config.repeats; ++r)
    rooms[r].emplace(grasp_world, items.room, draw(1, r).NextU64());
  const std::vector<ReachedState> states =
      SampleMotionStates(world, grasp_world, *rooms[0], items.motion, draw(2, 0).NextU64());

  std::vector<std::vector<TruthRecord>> first(states.size());
  pool.ParallelFor(static_cast<int>(states.size()), [&](int s, int) {
    first[s] = LabelState(&world, grasp_world, *rooms[0], cloud, states[s], items.labels,
                          draw(3 + s, 0).NextU64())
                   .truths;
  });
  // The first labels favour the sets near which their contacts were drawn, so they do not count.
  std::vector<std::vector<TruthRecord>> again(states.size() * config.repeats);
  pool.ParallelFor(static_cast<int>(again.size()), [&](int i, int) {
    const int s = i / config.repeats, r = 1 + i % config.repeats;
    again[i] = LabelAgain(&world, grasp_world, *rooms[r], cloud, states[s], items.labels, first[s],
                          draw(3 + s, r).NextU64());
  });

  Json progress = Json::array(), lifted = Json::array();
  for (std::size_t s = 0; s < states.size(); ++s) {
    for (std::size_t k = 0; k < first[s].size(); ++k) {
      Json one = Json::array(), other = Json::array();
      for (int r = 0; r < config.repeats; ++r) {
        const TruthRecord& truth = again[s * config.repeats + r][k];
        one.push_back(by_room ? truth.room : truth.relief);
        other.push_back(truth.lifted ? 1 : 0);
      }
      progress.push_back(std::move(one));
      lifted.push_back(std::move(other));
    }
  }
  return {{"object", object.object.name},
          {"family", object.object.family},
          {"progress", std::move(progress)},
          {"lifted", std::move(lifted)}};
}

Json CalcLabelCeiling(const std::vector<nlohmann::json>& objects) {
  Repeats progress, lifted;
  AddRepeats(objects, "progress", progress);
  AddRepeats(objects, "lifted", lifted);
  return {{"labels", progress.size()},
          {"repeats", progress.empty() ? 0 : progress.front().size()},
          {"r2", CalcSharedVariance(progress)},
          {"rank", CompareWithOthers(progress, CalcRankCorrelation)},
          {"auc", CompareWithOthers(lifted, CalcAuc)}};
}

}  // namespace pregrasp
