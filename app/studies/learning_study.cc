// The networks on what they never saw: the score on labels of families held out and on the ladders'
// poses, the generators on new objects of these families, what the score costs, and both on meshes
// that the user gives.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "app/core/data_folder.h"
#include "app/core/json_text.h"
#include "app/studies/label_noise.h"
#include "app/studies/learning_trials.h"
#include "app/studies/scatter_plot.h"
#include "app/studies/table_text.h"
#include "app/training/make_item.h"
#include "app/training/metrics.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kObjects = 3;        // of each family held out and seed
constexpr int kKnownOfFamily = 3;  // of the families that were learned from, for the baseline
constexpr std::uint64_t kLibrarySeed = 0x6c696272;
constexpr int kMeshesOfItem = 4;  // which are labelled in parallel
constexpr std::array<const char*, 3> kCaseNames{"thumb", "index", "both"};

// Items: the labels, the score's speed, labels repeated on an object of each family, objects by
// family, number and seed, ladders by seed, and the meshes once.
class LearningItems : public Study {
 public:
  explicit LearningItems(const StudySetup& setup)
      : setup_(setup), families_(ReadHeldOutFamilies(setup.weights)) {}

  std::int64_t num_items() const override {
    return 2 + num_families() + num_seeded_items() + num_mesh_items();
  }

  Json MakeItem(std::int64_t index) const override {
    const auto record = [](const char* kind, Json facts) {
      Json item{{"kind", kind}};
      item.update(facts);
      return item;
    };
    if (index == 0) {
      const auto labels = DataFolder() / "assets" / "training" / "states.safetensors.gz";
      return record("score", JudgeScore(labels, setup_.weights));
    }
    if (index == 1) return record("speed", {{"seconds", TimeScore(setup_.weights)}});
    index -= 2;
    if (index < num_families()) {
      ThreadPool pool(setup_.threads);
      return record("noise", RepeatLabels(ItemOfFamily(families_[index], 0), setup_.first_seed,
                                          IsProgressRoom(setup_.weights), pool));
    }
    index -= num_families();
    if (index >= num_seeded_items()) {
      const std::int64_t begin = (index - num_seeded_items()) * kMeshesOfItem;
      const std::int64_t end = std::min(begin + kMeshesOfItem, num_meshes());
      ThreadPool pool(setup_.threads);
      return record("meshes", JudgeObjects(setup_.objects, begin, end, setup_.first_seed,
                                           setup_.weights, library(pool), pool));
    }
    const std::uint64_t seed = setup_.first_seed + static_cast<std::uint64_t>(index % setup_.seeds);
    index /= setup_.seeds;
    if (index < num_objects()) {
      ThreadPool pool(setup_.threads);
      const std::int64_t item = ItemOfFamily(families_[index / kObjects], index % kObjects);
      return record("object",
                    TryGenerator(nullptr, item, seed, setup_.weights, library(pool), pool));
    }
    index -= num_objects();
    return record("ladder", ProbeLadder(setup_.ladders[index], seed, setup_));
  }

 private:
  std::int64_t num_families() const { return std::ssize(families_); }
  std::int64_t num_objects() const { return kObjects * num_families(); }
  std::int64_t num_seeded_items() const {
    return (num_objects() + std::ssize(setup_.ladders)) * setup_.seeds;
  }
  std::int64_t num_meshes() const { return setup_.objects ? std::ssize(*setup_.objects) : 0; }
  std::int64_t num_mesh_items() const { return (num_meshes() + kMeshesOfItem - 1) / kMeshesOfItem; }

  // Made when it is first asked for: an item that is done needs none.
  const GraspLibrary& library(ThreadPool& pool) const {
    std::call_once(once_, [&] {
      std::vector<std::string> learned;
      for (const std::string& family : ObjectFamilies()) {
        if (std::find(families_.begin(), families_.end(), family) == families_.end()) {
          learned.push_back(family);
        }
      }
      library_ = std::make_unique<const GraspLibrary>(learned, kKnownOfFamily, kLibrarySeed, pool);
    });
    return *library_;
  }

  StudySetup setup_;
  std::vector<std::string> families_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const GraspLibrary> library_;
};

// Of what TryGenerator said of objects: the share of samples of these cases for which `key` counts.
double CalcShare(const std::vector<nlohmann::json>& objects, const char* source,
                 std::initializer_list<const char*> cases, const char* key) {
  double samples = 0.0, counted = 0.0;
  for (const nlohmann::json& object : objects) {
    for (const char* one : cases) {
      samples += object.at(source).at(one).at("samples").get<double>();
      counted += object.at(source).at(one).at(key).get<double>();
    }
  }
  return samples > 0.0 ? counted / samples : 0.0;
}

// As the planner asks for samples, of single draws, of known grasps that are nearest, and of random
// points; refined and not.
void AddGeneratorShares(const std::vector<nlohmann::json>& objects, Json& summary) {
  for (const char* source : {"generator", "single_draw", "nearest", "random"}) {
    for (const auto& [suffix, key] : {std::pair("", "feasible"), std::pair("_raw", "raw")}) {
      summary[fmt::format("{}_both{}", source, suffix)] = CalcShare(objects, source, {"both"}, key);
      summary[fmt::format("{}_single{}", source, suffix)] =
          CalcShare(objects, source, {"thumb", "index"}, key);
    }
  }
  summary["generator_overlapping"] =
      CalcShare(objects, "generator", {"thumb", "index", "both"}, "overlapping");
}

void AddLabels(const nlohmann::json& object, JudgedLabels& labels) {
  for (std::size_t i = 0; i < object.at("truth").size(); ++i) {
    labels.Add(object["truth"][i], object["score"][i], object["lifted"][i],
               object["probability"][i]);
  }
}

// Of the user's meshes, the same as of our own objects: learning.json's "objects".
Json SummariseMeshes(const std::vector<nlohmann::json>& objects) {
  JudgedLabels all;
  std::map<std::string, JudgedLabels> families;
  for (const nlohmann::json& object : objects) {
    AddLabels(object, all);
    AddLabels(object, families[object.at("family").get<std::string>()]);
  }
  const Json facts = all.ToJson();
  Json summary{{"objects", objects.size()},
               {"score_r2", facts.at("r2")},
               {"score_rank", facts.at("rank")},
               {"score_auc", facts.at("auc")},
               {"calibration", facts.at("calibration")},
               {"labels", facts.at("labels")}};
  AddGeneratorShares(objects, summary);
  for (const auto& [family, labels] : families) summary["families"][family] = labels.ToJson();
  return summary;
}

// How the score of the best placements goes along a ladder with what searches say of them: rank
// correlations over the poses, of all seeds together; null with fewer than four poses.
Json CalcLadder(const std::vector<nlohmann::json>& items, const std::string& ladder) {
  Json result;
  std::vector<double> all_scores, all_truths;
  for (const char* one : kCaseNames) {
    std::vector<double> scores, truths;
    for (const nlohmann::json& item : items) {
      if (item.at("kind") != "ladder" || item.at("ladder") != ladder) continue;
      for (const nlohmann::json& pose : item.at("poses")) {
        if (pose.at(one).is_null()) continue;
        scores.push_back(pose.at(one).at("score"));
        truths.push_back(pose.at(one).at("relief"));
      }
    }
    result[one] = scores.size() < 4 ? Json() : Json(CalcRankCorrelation(scores, truths));
    all_scores.insert(all_scores.end(), scores.begin(), scores.end());
    all_truths.insert(all_truths.end(), truths.begin(), truths.end());
  }
  result["all"] = CalcRankCorrelation(all_scores, all_truths);
  return result;
}

std::string NumberText(const Json& value) {
  return value.is_null() ? "-" : fmt::format("{:.2f}", value.get<double>());
}

const std::vector<std::string> kFamilyColumns{"family", "labels", "R2",
                                              "rank",   "AUC",    "calibration"};

std::vector<std::string> FamilyRow(const std::string& name, const Json& facts) {
  return {name,
          std::to_string(facts.at("labels").get<int>()),
          NumberText(facts.at("r2")),
          NumberText(facts.at("rank")),
          NumberText(facts.at("auc")),
          NumberText(facts.at("calibration"))};
}

std::string TabulateMeshes(const Json& summary) {
  std::vector<std::vector<std::string>> rows = {kFamilyColumns};
  for (const auto& [family, facts] : summary.at("families").items()) {
    rows.push_back(FamilyRow(family, facts));
  }
  rows.push_back({"all", std::to_string(summary.at("labels").get<int>()),
                  NumberText(summary.at("score_r2")), NumberText(summary.at("score_rank")),
                  NumberText(summary.at("score_auc")), NumberText(summary.at("calibration"))});
  return fmt::format(
      "On {} meshes that were given, labelled by searches in scenes of their own:\n\n{}\nOf the "
      "generator's samples {:.2f} are feasible with both fingers given, {:.2f} with one.\n\n",
      summary.at("objects").get<int>(), MarkdownTable(rows),
      summary.at("generator_both").get<double>(), summary.at("generator_single").get<double>());
}

// What was predicted against what is, in bins of what was predicted.
std::string PlotBins(const std::string& title, const nlohmann::json& bins) {
  ScatterPlot plot;
  plot.title = title;
  plot.x_label = "predicted";
  plot.y_label = "truth";
  for (const nlohmann::json& bin : bins) plot.points.emplace_back(bin.at(0), bin.at(1));
  return ToSvg(plot);
}

StudyFiles TabulateLearning(const std::vector<nlohmann::json>& items) {
  const nlohmann::json& score = items.at(0);
  Json summary{{"score_r2", score.at("all").at("r2")},
               {"score_rank", score.at("all").at("rank")},
               {"score_auc", score.at("all").at("auc")},
               {"calibration", score.at("all").at("calibration")}};
  std::vector<nlohmann::json> objects, meshes, noise;
  for (const nlohmann::json& item : items) {
    if (item.at("kind") == "object") objects.push_back(item);
    if (item.at("kind") == "noise") noise.push_back(item);
    if (item.at("kind") != "meshes") continue;
    for (const nlohmann::json& mesh : item.at("objects")) meshes.push_back(mesh);
  }
  summary["ceiling"] = CalcLabelCeiling(noise);
  AddGeneratorShares(objects, summary);
  summary["ms_128x3"] = 1e3 * items.at(1).at("seconds").get<double>();
  std::vector<std::vector<std::string>> families = {kFamilyColumns};
  const auto add_family = [&](const std::string& name, const Json& facts) {
    families.push_back(FamilyRow(name, facts));
  };
  for (const auto& [family, facts] : score.at("families").items()) {
    add_family(family, facts);
    summary["families"][family] = facts;
  }
  for (const char* part : {"held", "not_held", "all"}) add_family(part, score.at(part));
  Json ceiling = summary["ceiling"];
  ceiling["calibration"] = nullptr;
  add_family("what labels allow", ceiling);
  std::string meshes_text;
  if (!meshes.empty()) {
    summary["objects"] = SummariseMeshes(meshes);
    meshes_text = TabulateMeshes(summary["objects"]);
  }

  std::vector<std::vector<std::string>> ladders = {{"ladder", "thumb", "index", "both", "all"}};
  std::vector<std::vector<std::string>> poses = {
      {"ladder", "seed", "pose", "held", "case", "score", "truth", "probability", "lifted"}};
  for (const nlohmann::json& item : items) {
    if (item.at("kind") != "ladder") continue;
    const std::string name = item.at("ladder");
    if (!summary["ladders"].contains(name)) {
      const Json facts = CalcLadder(items, name);
      summary["ladders"][name] = facts;
      ladders.push_back({name, NumberText(facts["thumb"]), NumberText(facts["index"]),
                         NumberText(facts["both"]), NumberText(facts["all"])});
    }
    int number = 0;
    for (const nlohmann::json& pose : item.at("poses")) {
      ++number;
      for (const char* one : kCaseNames) {
        const nlohmann::json& best = pose.at(one);
        if (best.is_null()) continue;
        poses.push_back({name, std::to_string(item.at("seed").get<std::uint64_t>()),
                         std::to_string(number), pose.at("held").get<bool>() ? "yes" : "no", one,
                         NumberText(best.at("score")), NumberText(best.at("relief")),
                         NumberText(best.at("probability")), NumberText(best.at("lifted"))});
      }
    }
  }
  return {
      {"learning.json", FormatJsonIndented(summary)},
      {"learning-progress.svg",
       PlotBins("Progress, families never seen", score.at("progress_bins"))},
      {"learning-lifted.svg",
       PlotBins("Probability of a lifted grasp, families never seen", score.at("lifted_bins"))},
      {"learning.md",
       fmt::format(
           "The score on labels of families that it never saw, and last what no score can go "
           "beyond, as\n"
           "labels made again by other searches differ from one another:\n\n{}\n{}Rank "
           "correlation, along "
           "each ladder, of the score of the tenth of placements that scores best\nwith the "
           "truth of these (the share of reliefs at which a search has a grasp with "
           "them):\n\n{}\nPose by pose:\n\n{}",
           MarkdownTable(families), meshes_text, MarkdownTable(ladders), MarkdownTable(poses))}};
}

std::string DescribeLearningItem(const nlohmann::json& item) {
  const std::string kind = item.at("kind");
  if (kind == "score") {
    return fmt::format("score: R2 {:.3f}, AUC {:.3f}", item.at("all").at("r2").get<double>(),
                       item.at("all").at("auc").get<double>());
  }
  if (kind == "speed") {
    return fmt::format("speed: {:.1f} ms", 1e3 * item.at("seconds").get<double>());
  }
  if (kind == "noise")
    return fmt::format("labels of {} again", item.at("family").get<std::string>());
  if (kind == "meshes") return fmt::format("{} meshes", item.at("objects").size());
  if (kind == "object") return fmt::format("object {}", item.at("object").get<std::string>());
  return fmt::format("ladder {}: {} poses", item.at("ladder").get<std::string>(),
                     item.at("poses").size());
}

}  // namespace

StudyInfo LearningStudy() {
  return {.name = "learning",
          .text = "the networks on labels, objects and ladders they were not trained on",
          .subject = StudySubject::kLadders,
          .takes_objects = true,
          .make = MakeStudy<LearningItems>,
          .describe = DescribeLearningItem,
          .tabulate = TabulateLearning};
}

}  // namespace pregrasp
