#include "app/pictures/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "app/hand/hand_shapes.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

constexpr int kGhostsShown = 6;  // of an iteration's rollouts: the best

// A scale of scores in three numbers, of as many digits as tell them apart.
RenderLegend ScoreLegend(const std::string& title, double low, double high) {
  RenderLegend legend;
  legend.title = title;
  constexpr int kSteps = 9;
  for (int i = 0; i < kSteps; ++i) legend.scale.push_back(ScoreColor(i / (kSteps - 1.0)));
  constexpr int kMostDigits = 6;
  int digits = 2;
  while (digits < kMostDigits && std::abs(high - low) < 4.0 * std::pow(10.0, -digits)) ++digits;
  for (const double s : {0.0, 0.5, 1.0}) {
    legend.ticks.emplace_back(s, fmt::format("{:.{}f}", low + s * (high - low) + 0.0, digits));
  }
  return legend;
}

Rgba Mixed(const Rgba& a, const Rgba& b, float share_of_b) {
  const float share = 1.0F - share_of_b;
  return {share * a.r + share_of_b * b.r, share * a.g + share_of_b * b.g,
          share * a.b + share_of_b * b.b, 1.0F};
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
    return ShowScores(scores.s_c, all, "best score here");
  }

  // A cut by the picture of what it cuts by, the whole graph by who stayed.
  PictureOverlay Show(const PruneFacts& pruning) const {
    const ScoreFacts& scores = *steps_.FindBefore<ScoreFacts>(step_);
    if (pruning.complete || pruning.cut == "edges") return ShowKept(pruning);
    return pruning.cut == "free"
               ? ShowScores(scores.s_n, pruning.kept, "best score without surroundings")
               : ShowScores(scores.s_c, pruning.kept, "best score here");
  }

  // Which triangles are used by a state that a path may begin with, which by later ones only.
  PictureOverlay ShowKept(const PruneFacts& pruning) const {
    PictureOverlay overlay = ShowMesh(*steps_.FindBefore<MeshFacts>(step_));
    const int count = static_cast<int>(overlay.face_colors.size());
    const Rgba pruned = WithAlpha(NeutralColor(), 1.0F), later = WithAlpha(NeighbourColor(), 1.0F),
               begins = WithAlpha(ObjectColor(), 1.0F);
    std::vector<int> use(count, 0);
    for (const auto& [nodes, rank] :
         {std::pair(&pruning.kept, 1), std::pair(&pruning.initial, 2)}) {
      for (const int node : *nodes) {
        for (const int t : {node / count, node % count}) use[t] = std::max(use[t], rank);
      }
    }
    int triangles[3] = {0, 0, 0};
    for (int t = 0; t < count; ++t) {
      overlay.face_colors[t] = use[t] == 2 ? begins : use[t] == 1 ? later : pruned;
      ++triangles[use[t]];
    }
    overlay.legend.title = fmt::format("{} triangles, by the states that use them", count);
    overlay.legend.swatches = {
        {begins, fmt::format("{}: a path may begin there", triangles[2])},
        {later, fmt::format("{}: only later on a path", triangles[1])},
        {pruned, fmt::format("{}: all their states are pruned", triangles[0])}};
    return overlay;
  }

  // Of each finger the triangles, by stage.
  PictureOverlay Show(const PathFacts& path) const {
    PictureOverlay overlay = ShowMesh(*steps_.FindBefore<MeshFacts>(step_));
    constexpr float kPaler = 0.45F;  // in the last stage
    struct Use {
      std::string text;
      Rgba color;
      int count = 0;
    };
    std::map<int, Use> uses;  // by triangle
    for (const Finger finger : {Finger::kThumb, Finger::kIndex}) {
      std::map<int, std::string> stages;
      std::map<int, Rgba> colors;
      for (std::size_t i = 0; i < path.nodes.size(); ++i) {
        const NodeFacts& node = path.nodes[i];
        const int t = finger == Finger::kThumb ? node.thumb : node.index;
        stages[t] += (stages[t].empty() ? "" : "+") + std::to_string(i + 1);
        const float share = path.nodes.size() > 1 ? kPaler * static_cast<float>(i) /
                                                        static_cast<float>(path.nodes.size() - 1)
                                                  : 0.0F;
        colors.emplace(t, Mixed(FingerColor(finger), {1.0F, 1.0F, 1.0F, 1.0F}, share));
      }
      for (const auto& [t, text] : stages) {
        Use& use = uses[t];
        use.color = use.count++ == 0 ? colors[t] : Mixed(use.color, colors[t], 0.5F);
        use.text += fmt::format("{}{} {}", use.text.empty() ? "" : ", ", FingerName(finger), text);
      }
    }
    for (const auto& [t, use] : uses) {
      overlay.face_colors[t] = use.color;
      overlay.triangle_labels.push_back({t, fmt::format("{}: {}", use.text, t), use.color});
    }
    overlay.legend.title = path.nodes.size() > 1 ? "finger, stages: triangle; later ones paler"
                                                 : "finger, stage: triangle";
    overlay.legend.swatches = {{FingerColor(Finger::kThumb), "thumb may touch"},
                               {FingerColor(Finger::kIndex), "index may touch"}};
    return overlay;
  }

  // The object is where the best plan so far leaves it; outlines are the best of this iteration.
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
    constexpr double kSame = 1e-6;  // [m], from the object itself
    for (const RolloutFacts* rollout : best) {
      const double s = high > low ? (high - rollout->cost.total) / (high - low) : 1.0;
      const RigidTransform X_WO = MakeTransform(rollout->q_WO_end, rollout->p_WO_end);
      if ((X_WO.matrix() - step_.object().X_WB().matrix()).cwiseAbs().maxCoeff() < kSame) continue;
      overlay.ghosts.push_back({X_WO, WithAlpha(ScoreColor(s), 1.0F)});
    }
    overlay.legend = ScoreLegend(
        fmt::format("{} best of {} plans, by cost", best.size(), iteration.rollouts.size()), high,
        low);
    overlay.legend.swatches = {{ObjectColor(), "best plan so far, and its start"}};
    if (const RolloutFacts* plan = FindBestPlan(iteration)) ShowContacts(overlay, plan->stages);
    return overlay;
  }

  // Null where the iteration that found it is not among the steps.
  const RolloutFacts* FindBestPlan(const IterationFacts& last) const {
    for (const StepFacts* at = &step_;; at = &steps_.Get(at->command.node)) {
      const auto* iteration = std::get_if<IterationFacts>(&at->details);
      if (iteration == nullptr || iteration->path != last.path) return nullptr;
      for (const RolloutFacts& rollout : iteration->rollouts) {
        if (rollout.cost.total == last.best.total) return &rollout;
      }
      if (at->command.node.empty()) return nullptr;
    }
  }

  // Where a plan's fingers touch the object at its start, and where these points of it end.
  void ShowContacts(PictureOverlay& overlay, const std::vector<StageFacts>& stages) const {
    const RigidTransform X_from = FindStart(step_, steps_).object().X_WB(),
                         X_to = step_.object().X_WB();
    for (std::size_t i = 0; i < stages.size(); ++i) {
      for (const StageFingerFacts& finger : stages[i]) {
        if (!finger.on || (finger.kept && i > 0)) continue;
        overlay.ways.push_back({finger.finger,
                                {X_from * finger.p_OC, X_to * finger.p_OC},
                                fmt::format("stage {}: {}", i + 1, FingerName(finger.finger))});
      }
    }
  }

  PictureOverlay Show(const CertifyFacts& plan) const {
    PictureOverlay overlay;
    ShowContacts(overlay, plan.stages);
    return overlay;
  }

  PictureOverlay Show(const GraspFacts& grasp) const {
    PictureOverlay overlay;
    AddContacts(overlay, grasp.contacts, grasp.feasible || grasp.hand);
    if (grasp.hand) SetHand(overlay, *grasp.hand);
    if (!grasp.feasible) overlay.colliding = grasp.colliding;
    return overlay;
  }

  // A lift that was not simulated, as its grasp gives way, shows that grasp.
  PictureOverlay Show(const LiftFacts& lift) const {
    PictureOverlay overlay;
    const StepFacts* at = &step_;
    while (at->command.verb != Verb::kCertify && !at->command.node.empty()) {
      at = &steps_.Get(at->command.node);
    }
    if (lift.held || step_.t > at->t) return overlay;
    AddContacts(overlay, lift.grip, true);
    SetHand(overlay, lift.hand);
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

  // Colours triangles by the best score of the shown nodes that use them.
  PictureOverlay ShowScores(const std::vector<double>& scores, const std::vector<int>& shown,
                            const std::string& title) const {
    PictureOverlay overlay = ShowMesh(*steps_.FindBefore<MeshFacts>(step_));
    const int count = static_cast<int>(overlay.face_colors.size());
    std::vector<double> best(count, -1.0);
    const double highest = *std::max_element(scores.begin(), scores.end());
    for (const int node : shown) {
      for (const int t : {node / count, node % count}) best[t] = std::max(best[t], scores[node]);
    }
    for (int t = 0; t < count; ++t) {
      overlay.face_colors[t] = best[t] >= 0.0 && highest > 0.0 ? ScoreColor(best[t] / highest)
                                                               : WithAlpha(NeutralColor(), 1.0F);
    }
    overlay.legend = ScoreLegend(title, 0.0, std::max(0.0, highest));
    if (std::any_of(best.begin(), best.end(), [](double score) { return score < 0.0; })) {
      overlay.legend.swatches = {{WithAlpha(NeutralColor(), 1.0F), "no state of it is kept"}};
    }
    return overlay;
  }

  void AddContacts(PictureOverlay& overlay, const std::vector<GraspContactFacts>& contacts,
                   bool holds) const {
    const RigidTransform X_WO = step_.object().X_WB();
    for (const GraspContactFacts& contact : contacts) {
      Touch(overlay, contact.finger);
      overlay.contacts.push_back({contact.finger, X_WO * contact.p_OC,
                                  X_WO.linear() * contact.nhat_O, X_WO.linear() * contact.f_O,
                                  holds, FingerName(contact.finger)});
    }
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
