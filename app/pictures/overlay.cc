#include "app/pictures/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/hand/hand_shapes.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr int kGhostsShown = 6;  // of an iteration's rollouts: the best

// A scale of scores from 0 to the largest one, in three numbers.
RenderLegend ScoreLegend(const std::string& title, double low, double high) {
  RenderLegend legend;
  legend.title = title;
  constexpr int kSteps = 9;
  for (int i = 0; i < kSteps; ++i) legend.scale.push_back(ScoreColor(i / (kSteps - 1.0)));
  for (const double s : {0.0, 0.5, 1.0}) {
    legend.ticks.emplace_back(s, fmt::format("{:.2f}", low + s * (high - low)));
  }
  return legend;
}

void AppendHand(MatrixX3& points, const HandModel& hand, const HandConfiguration& configuration) {
  for (const RigidTransform& X_WL : CalcLinkPoses(hand, configuration)) {
    points.conservativeResize(points.rows() + 1, 3);
    points.bottomRows<1>() = X_WL.translation().transpose();
  }
}

// The overlay of each kind of step.
class Maker {
 public:
  Maker(const StepFacts& step, const FactsSource& steps, const HandModel& hand)
      : step_(step), steps_(steps), hand_(hand) {}

  PictureOverlay Make() const {
    return std::visit([this](const auto& details) { return Show(details); }, step_.details);
  }

 private:
  template <typename Other>
  PictureOverlay Show(const Other& /*nothing to add*/) const {
    return {};
  }

  PictureOverlay Show(const MeshFacts& mesh) const { return ShowMesh(mesh); }

  PictureOverlay Show(const ScoreFacts& scores) const {
    std::vector<int> all(scores.s_c.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    return ShowScores(scores, all);
  }

  PictureOverlay Show(const PruneFacts& pruning) const {
    return ShowScores(*steps_.FindBefore<ScoreFacts>(step_), pruning.kept);
  }

  PictureOverlay Show(const PathFacts& path) const {
    PictureOverlay overlay = ShowMesh(*steps_.FindBefore<MeshFacts>(step_));
    for (const NodeFacts& node : path.nodes) {
      overlay.face_colors[node.thumb] = FingerColor(Finger::kThumb);
      overlay.face_colors[node.index] = FingerColor(Finger::kIndex);
    }
    overlay.legend.swatches = {{FingerColor(Finger::kThumb), "thumb may touch"},
                               {FingerColor(Finger::kIndex), "index may touch"}};
    return overlay;
  }

  PictureOverlay Show(const IterationFacts& iteration) const {
    std::vector<const RolloutFacts*> best;
    for (const RolloutFacts& rollout : iteration.rollouts) best.push_back(&rollout);
    std::stable_sort(best.begin(), best.end(), [](const RolloutFacts* a, const RolloutFacts* b) {
      return a->cost.total < b->cost.total;
    });
    if (best.size() > kGhostsShown) best.resize(kGhostsShown);
    PictureOverlay overlay;
    overlay.forces = false;
    const double low = best.front()->cost.total, high = best.back()->cost.total;
    for (const RolloutFacts* rollout : best) {
      const double s = high > low ? (high - rollout->cost.total) / (high - low) : 1.0;
      overlay.ghosts.push_back(
          {MakeTransform(rollout->q_WO_end, rollout->p_WO_end), WithAlpha(ScoreColor(s), 0.45F)});
    }
    overlay.legend = ScoreLegend("cost", high, low);
    return overlay;
  }

  PictureOverlay Show(const GraspFacts& grasp) const {
    PictureOverlay overlay;
    for (const GraspContactFacts& contact : grasp.contacts) Touch(overlay, contact.finger);
    if (grasp.hand) SetHand(overlay, *grasp.hand);
    return overlay;
  }

  PictureOverlay Show(const FrameFacts& frame) const {
    PictureOverlay overlay;
    overlay.forces = false;
    overlay.hand = frame.hand.configuration();
    for (const PlaceFacts& place : frame.touching) Touch(overlay, place.finger);
    overlay.focus_W = FocusOnMotion();
    return overlay;
  }

  PictureOverlay ShowMesh(const MeshFacts& facts) const {
    PictureOverlay overlay;
    overlay.forces = false;
    overlay.contact_mesh = std::make_shared<const TriangleMesh>(facts.mesh);
    overlay.face_colors.assign(facts.triangles, WithAlpha(ObjectColor(), 1.0F));
    return overlay;
  }

  // Colours triangles by the best s_c of the shown nodes that use them.
  PictureOverlay ShowScores(const ScoreFacts& scores, const std::vector<int>& shown) const {
    PictureOverlay overlay = ShowMesh(*steps_.FindBefore<MeshFacts>(step_));
    const int count = static_cast<int>(overlay.face_colors.size());
    std::vector<double> best(count, -1.0);
    const double highest = *std::max_element(scores.s_c.begin(), scores.s_c.end());
    for (const int node : shown) {
      for (const int t : {node / count, node % count})
        best[t] = std::max(best[t], scores.s_c[node]);
    }
    for (int t = 0; t < count; ++t) {
      overlay.face_colors[t] = best[t] >= 0.0 && highest > 0.0 ? ScoreColor(best[t] / highest)
                                                               : WithAlpha(NeutralColor(), 1.0F);
    }
    overlay.legend = ScoreLegend("best score here", 0.0, std::max(0.0, highest));
    return overlay;
  }

  static void Touch(PictureOverlay& overlay, Finger finger) {
    overlay.touching[static_cast<int>(finger)] = true;
    overlay.legend.swatches.emplace_back(FingerColor(finger), FingerName(finger));
  }

  void SetHand(PictureOverlay& overlay, const HandFacts& hand) const {
    overlay.hand = hand.configuration();
    AppendHand(overlay.focus_W, hand_, *overlay.hand);
  }

  // What every picture of a motion shows, so that they have one camera: the hand at the keyframes
  // that were solved by then, and headroom for the card of text.
  MatrixX3 FocusOnMotion() const {
    constexpr double kHeadroom = 0.06;  // [m]
    MatrixX3 focus_W(0, 3);
    for (const StepFacts* at = &step_;; at = &steps_.Get(at->command.node)) {
      if (at->command.verb == Verb::kKeyframe) {
        AppendHand(focus_W, hand_, std::get<FrameFacts>(at->details).hand.configuration());
      }
      if (at->stage() != "motion") break;
    }
    const Eigen::Index count = focus_W.rows();
    focus_W.conservativeResize(2 * count, 3);
    focus_W.bottomRows(count) =
        focus_W.topRows(count).rowwise() + Vector3(0.0, 0.0, kHeadroom).transpose();
    return focus_W;
  }

  const StepFacts& step_;
  const FactsSource& steps_;
  const HandModel& hand_;
};

// What one grasp or lift of a path has in common with others that look alike.
std::array<int, 4> KindOf(const GraspFacts& grasp) { return {grasp.feasible}; }
std::array<int, 4> KindOf(const LiftFacts& lift) {
  return {lift.held, lift.pushes, lift.soft, lift.stiff};
}

// Whether no step of the same stage before `step` is of its kind.
template <typename Facts>
bool IsFirstOfItsKind(const StepFacts& step, const FactsSource& steps) {
  const auto kind = KindOf(std::get<Facts>(step.details));
  for (const StepFacts* at = &step; at->command.verb == step.command.verb;) {
    at = &steps.Get(at->command.node);
    const auto* earlier = std::get_if<Facts>(&at->details);
    if (earlier != nullptr && KindOf(*earlier) == kind) return false;
  }
  return true;
}

}  // namespace

PictureOverlay MakeOverlay(const StepFacts& step, const FactsSource& steps, const HandModel& hand) {
  return Maker(step, steps, hand).Make();
}

const StepFacts& FindStart(const StepFacts& step, const FactsSource& steps) {
  const StepFacts* at = &step;
  while (at->command.verb != Verb::kOpen && at->command.verb != Verb::kSettle) {
    at = &steps.Get(at->command.node);
  }
  return *at;
}

bool IsKeyStep(const StepFacts& step, const FactsSource& steps) {
  constexpr int kEvery = 5;
  switch (step.command.verb) {
    case Verb::kOpen:
    case Verb::kScore:
    case Verb::kCertify:
    case Verb::kKeyframe:
      return true;
    case Verb::kPath: {  // of those that are screened, the first alone
      const auto& facts = std::get<PathFacts>(step.details);
      return facts.order == "paper" || facts.rank == 1;
    }
    case Verb::kPrune:
      return std::get<PruneFacts>(step.details).complete;
    case Verb::kIterate: {
      const auto& facts = std::get<IterationFacts>(step.details);
      return facts.iteration == 1 || facts.iteration % kEvery == 0 || !facts.end.empty();
    }
    case Verb::kGrasp:
      return IsFirstOfItsKind<GraspFacts>(step, steps);
    case Verb::kLift:
      return IsFirstOfItsKind<LiftFacts>(step, steps);
    default:
      return false;
  }
}

}  // namespace pregrasp
