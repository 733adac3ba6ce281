// The order in which keyframes are solved (the paper's ablation, section "Hand motion synthesis"):
// the last first, as the planner does, against the first first, on made problems.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/core/json_text.h"
#include "app/job/fields_json.h"
#include "app/motion/hand_motion.h"
#include "app/motion/motion_problem.h"
#include "app/studies/read_items.h"
#include "app/studies/scatter_plot.h"
#include "app/studies/study.h"
#include "app/studies/table_text.h"

namespace pregrasp {
namespace {

// A motion made in one order.
struct OrderFacts {
  int keyframes = 0, keyframes_failed = 0;
  /// From keyframe to keyframe in time, sums and the largest [deg].
  double wrist_turn_deg = 0.0, largest_wrist_turn_deg = 0.0;
  double wrist_travel_m = 0.0;
  double joint_travel_deg = 0.0;  ///< of all joints, the mean
  double largest_jump_deg = 0.0;  ///< of a joint
  int frames = 0, frames_failed = 0, frames_loosened = 0;
  double animation_s = 0.0;
  double seconds = 0.0;

  bool failed() const { return keyframes_failed + frames_failed > 0; }

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("keyframes", self.keyframes);
    visit("keyframes_failed", self.keyframes_failed);
    visit("wrist_turn_deg", self.wrist_turn_deg);
    visit("largest_wrist_turn_deg", self.largest_wrist_turn_deg);
    visit("wrist_travel_m", self.wrist_travel_m);
    visit("joint_travel_deg", self.joint_travel_deg);
    visit("largest_jump_deg", self.largest_jump_deg);
    visit("frames", self.frames);
    visit("frames_failed", self.frames_failed);
    visit("frames_loosened", self.frames_loosened);
    visit("animation_s", self.animation_s);
    visit("seconds", self.seconds);
  }
};

struct ProblemFacts {
  std::uint64_t problem = 0;
  OrderFacts reverse, forward;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("problem", self.problem);
    visit("reverse", self.reverse);
    visit("forward", self.forward);
  }
};

OrderFacts MakeInOrder(const IkSolver& solver, const MotionProblem& problem, MotionConfig config,
                       KeyframeOrder order) {
  const auto start = std::chrono::steady_clock::now();
  config.order = order;
  const HandMotion motion(solver, problem.task, problem.grasp, config, problem.seed);
  MotionState state = motion.Start();
  while (motion.SolveKeyframe(state)) {
  }
  OrderFacts facts;
  facts.keyframes = static_cast<int>(state.keys.size());
  for (std::size_t i = 0; i < state.keys.size(); ++i) {
    facts.keyframes_failed += state.keys[i].failed();
    if (i == 0) continue;
    const HandConfiguration &from = state.keys[i - 1].configuration,
                            &to = state.keys[i].configuration;
    const double turn_deg = RadToDeg(RotationAngle(from.X_WH.linear(), to.X_WH.linear()));
    const HandJoints jumps_deg = (to.q - from.q).cwiseAbs() * RadToDeg(1.0);
    facts.wrist_turn_deg += turn_deg;
    facts.largest_wrist_turn_deg = std::max(facts.largest_wrist_turn_deg, turn_deg);
    facts.wrist_travel_m += (to.X_WH.translation() - from.X_WH.translation()).norm();
    facts.joint_travel_deg += jumps_deg.mean();
    facts.largest_jump_deg = std::max(facts.largest_jump_deg, jumps_deg.maxCoeff());
  }
  motion.Finish(state);
  const MotionSummary summary = motion.Summarize(state);
  facts.frames = summary.frames;
  facts.frames_failed = summary.failed;
  facts.frames_loosened = summary.loosened;
  facts.animation_s = state.task->frames.back().t;
  facts.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return facts;
}

class IkOrder : public Study {
 public:
  explicit IkOrder(const StudySetup& setup) : setup_(setup) {}

  std::int64_t num_items() const override { return setup_.seeds; }

  nlohmann::ordered_json MakeItem(std::int64_t index) const override {
    const MotionProblem problem =
        MakeMotionProblem(setup_.first_seed + static_cast<std::uint64_t>(index));
    const IkSolver solver(HandOf(problem.scene), problem.scene);
    ProblemFacts facts{problem.seed, {}, {}};
    const MotionConfig& config = setup_.planner.motion;
    facts.reverse = MakeInOrder(solver, problem, config, KeyframeOrder::kReverse);
    facts.forward = MakeInOrder(solver, problem, config, KeyframeOrder::kForward);
    return fields::Write(facts);
  }

 private:
  StudySetup setup_;
};

struct Measure {
  const char* text;
  double (*of)(const OrderFacts& facts);
};

constexpr Measure kMeasures[] = {
    {"keyframes without a pose", [](const OrderFacts& f) { return 1.0 * f.keyframes_failed; }},
    {"turn of the wrist between keyframes, sum [deg]",
     [](const OrderFacts& f) { return f.wrist_turn_deg; }},
    {"the same, largest [deg]", [](const OrderFacts& f) { return f.largest_wrist_turn_deg; }},
    {"way of the wrist between keyframes, sum [m]",
     [](const OrderFacts& f) { return f.wrist_travel_m; }},
    {"way of the joints between keyframes, mean sum [deg]",
     [](const OrderFacts& f) { return f.joint_travel_deg; }},
    {"largest jump of a joint [deg]", [](const OrderFacts& f) { return f.largest_jump_deg; }},
    {"frames that fail", [](const OrderFacts& f) { return 1.0 * f.frames_failed; }},
    {"frames loosened", [](const OrderFacts& f) { return 1.0 * f.frames_loosened; }},
    {"length of the animation [s]", [](const OrderFacts& f) { return f.animation_s; }}};

StudyFiles TabulateIkOrder(const std::vector<nlohmann::json>& items) {
  const std::vector<ProblemFacts> problems = ReadItems<ProblemFacts>(items);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::vector<nlohmann::ordered_json> flat;
  ScatterPlot plot;
  plot.title = "Turn of the wrist between keyframes";
  plot.x_label = "first keyframe first [deg]";
  plot.y_label = "last keyframe first [deg]";
  int failed_reverse = 0, failed_forward = 0;
  for (const ProblemFacts& facts : problems) {
    list.push_back(fields::Write(facts));
    for (const auto& [order, made] :
         {std::pair("reverse", &facts.reverse), std::pair("forward", &facts.forward)}) {
      nlohmann::ordered_json row = {{"problem", facts.problem}, {"order", order}};
      row.update(fields::Write(*made));
      flat.push_back(std::move(row));
    }
    failed_reverse += facts.reverse.failed();
    failed_forward += facts.forward.failed();
    plot.points.emplace_back(facts.forward.wrist_turn_deg, facts.reverse.wrist_turn_deg);
  }
  std::vector<std::vector<std::string>> rows = {
      {"mean (standard deviation)", "last first", "first first", "last first has less", "more"}};
  for (const Measure& measure : kMeasures) {
    std::vector<double> reverse, forward;
    int less = 0, more = 0;
    for (const ProblemFacts& facts : problems) {
      reverse.push_back(measure.of(facts.reverse));
      forward.push_back(measure.of(facts.forward));
      less += reverse.back() < forward.back() - 1e-9;
      more += reverse.back() > forward.back() + 1e-9;
    }
    rows.push_back({measure.text, MeanText(reverse), MeanText(forward), std::to_string(less),
                    std::to_string(more)});
  }
  return {{"ik-order.json", FormatJsonIndented(list)},
          {"ik-order.csv", CsvTable(flat)},
          {"ik-order.svg", ToSvg(plot)},
          {"ik-order.md",
           fmt::format("{} problems: a box beside a wall is pushed on by two fingers, then by two "
                       "others, and lifted by five. Solved with the\nlast keyframe first, {} "
                       "motions fail in a keyframe or a frame; with the first one first, {}.\n\n",
                       problems.size(), failed_reverse, failed_forward) +
               MarkdownTable(rows)}};
}

std::string DescribeIkOrderItem(const nlohmann::json& item) {
  const ProblemFacts facts = ReadItems<ProblemFacts>({item}).front();
  return fmt::format("problem {}: wrist turns {:.0f} deg last first, {:.0f} first first{}{}",
                     facts.problem, facts.reverse.wrist_turn_deg, facts.forward.wrist_turn_deg,
                     facts.reverse.failed() ? "; last first fails" : "",
                     facts.forward.failed() ? "; first first fails" : "");
}

}  // namespace

StudyInfo IkOrderStudy() {
  return {.name = "ik-order",
          .text = "hand motions of made problems, keyframes solved last to first and first to last",
          .subject = StudySubject::kMade,
          .make = MakeStudy<IkOrder>,
          .describe = DescribeIkOrderItem,
          .tabulate = TabulateIkOrder};
}

}  // namespace pregrasp
