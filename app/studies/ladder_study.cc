// Score, generator, search and lift at each pose of a known motion, and MPPI with the motion's
// progress in place of the score: tells planner, score and generator apart.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "app/core/json_text.h"
#include "app/job/fields_json.h"
#include "app/studies/ladder_climb.h"
#include "app/studies/read_items.h"
#include "app/studies/table_text.h"

namespace pregrasp {
namespace {

class LadderItems : public Study {
 public:
  explicit LadderItems(const StudySetup& setup) : setup_(setup) {}

  std::int64_t num_items() const override {
    return static_cast<std::int64_t>(setup_.ladders.size()) * setup_.seeds;
  }

  nlohmann::ordered_json MakeItem(std::int64_t index) const override {
    const auto start = std::chrono::steady_clock::now();
    const Ladder& ladder = setup_.ladders[index / setup_.seeds];
    const std::uint64_t seed = setup_.first_seed + static_cast<std::uint64_t>(index % setup_.seeds);
    LadderFacts facts = ClimbLadder(ladder, seed, setup_);
    facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return fields::Write(facts);
  }

 private:
  StudySetup setup_;
};

std::string ShareText(int part, int whole) {
  return whole == 0 ? "-" : fmt::format("{} of {}", part, whole);
}

StudyFiles TabulateLadders(const std::vector<nlohmann::json>& items) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::vector<nlohmann::ordered_json> flat;
  std::vector<std::vector<std::string>> poses = {{"ladder", "seed", "pose", "moved, turned",
                                                  "holds", "score", "generator (raw)",
                                                  "search: hold", "reach", "found", "lifted"}};
  std::vector<std::vector<std::string>> oracles = {{"ladder", "seed", "thumb / index", "progress",
                                                    "certified", "feasible", "lifted", "rollouts"}};
  for (const LadderFacts& facts : ReadItems<LadderFacts>(items)) {
    list.push_back(fields::Write(facts));
    const std::string seed = std::to_string(facts.seed);
    for (const PoseFacts& pose : facts.poses) {
      nlohmann::ordered_json record = {{"ladder", facts.ladder}, {"seed", facts.seed}};
      record.update(fields::Write(pose));
      flat.push_back(std::move(record));
      poses.push_back({facts.ladder, seed, std::to_string(pose.pose),
                       fmt::format("{:.0f} mm, {:.0f} deg", pose.moved_mm, pose.turned_deg),
                       pose.holds ? pose.stays_when_released ? "by itself" : "pressed" : "no",
                       fmt::format("{:.3f}", pose.score),
                       fmt::format("{} ({})", ShareText(pose.generated_feasible, pose.generated),
                                   pose.generated_raw),
                       ShareText(pose.sets_hold, pose.sets),
                       ShareText(pose.sets_reach, pose.solved), std::to_string(pose.found),
                       pose.lift_tried ? ShareText(*pose.lifted, *pose.lift_tried) : "-"});
    }
    for (const OracleFacts& oracle : facts.oracle) {
      std::string reasons;
      for (const std::string& reason : oracle.reasons) {
        reasons += (reasons.empty() ? "" : "; ") + reason;
      }
      oracles.push_back({facts.ladder, seed, fmt::format("{} / {}", oracle.thumb, oracle.index),
                         fmt::format("{:.2f}", oracle.progress), oracle.certified ? "yes" : reasons,
                         std::to_string(oracle.feasible), std::to_string(oracle.lifted),
                         std::to_string(oracle.rollouts)});
    }
  }
  return {
      {"ladder.json", FormatJsonIndented(list)},
      {"ladder.csv", CsvTable(flat)},
      {"ladder.md",
       "At each pose: the mean learned score of the placements that grasps are completed from; "
       "of the generated\ngrasps those that are feasible; of a search's contact sets those that "
       "hold, of those put to inverse kinematics\nthose within reach, and the grasps found; of "
       "the feasible grasps those that lift.\n\n" +
           MarkdownTable(poses) +
           "\nMPPI with the progress along the poses in place of the score, on the node of the "
           "pressing finger:\n\n" +
           MarkdownTable(oracles)}};
}

std::string DescribeLadderItem(const nlohmann::json& item) {
  const LadderFacts facts = ReadItems<LadderFacts>({item}).front();
  double progress = 0.0;
  for (const OracleFacts& oracle : facts.oracle) progress = std::max(progress, oracle.progress);
  return fmt::format("{} seed {}: {} poses, oracle's progress {:.2f}, {:.1f} s", facts.ladder,
                     facts.seed, facts.poses.size(), progress, facts.seconds);
}

}  // namespace

StudyInfo LadderStudy() {
  return {.name = "ladder",
          .text =
              "known motions of tests/ladders, pose by pose: score, generator, search, lift; "
              "MPPI with their progress as score",
          .subject = StudySubject::kLadders,
          .make = MakeStudy<LadderItems>,
          .describe = DescribeLadderItem,
          .tabulate = TabulateLadders};
}

}  // namespace pregrasp
