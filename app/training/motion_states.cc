#include "app/training/motion_states.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "app/core/interrupt.h"
#include "app/core/rng.h"
#include "app/dynamics/tip_overlap.h"
#include "app/grasp/contact_places.h"
#include "app/trajectory/action.h"
#include "app/trajectory/certify.h"
#include "app/trajectory/simulate_plan.h"

namespace pregrasp {
namespace {

constexpr double kFarShift = 0.01, kFarTurnDeg = 10.0;  // states so far apart count as one apart
constexpr double kLeastApart = 0.4;
constexpr double kStillSpeed = 0.03, kStillTurn = 0.3;  // [m/s], [rad/s]
constexpr double kMaxTravel = 0.03;                     // of a target in a knot [m]

// How unlike two states are.
double CalcApart(const WorldState& a, const WorldState& b) {
  double shift = 0.0, turn_deg = 0.0;
  CalcShift(a, b, &shift, &turn_deg);
  return shift / kFarShift + turn_deg / kFarTurnDeg;
}

class PushSampler {
 public:
  PushSampler(const World& world, const GraspWorld& grasp_world, const MotionStatesConfig& config)
      : world_(world),
        grasp_world_(grasp_world),
        config_(config),
        range_(MakeActionRange(world.scene(), kMaxTravel)),
        first_(world.InitialState()),
        up_W_(-world.scene().gravity.normalized()) {}

  // The end of one push, if it is of use.
  std::optional<ReachedState> Push(const WorldState& start, const ContactPlaces& places,
                                   Rng& rng) const {
    const std::optional<RelativePlan> plan = DrawPlan(places, rng);
    if (!plan) return std::nullopt;
    const PlanOutcome outcome =
        SimulatePlan(world_, grasp_world_.environment(), start, *plan, config_.timing);
    if (outcome.diverged || CalcApart(outcome.end, first_) < kLeastApart) return std::nullopt;
    return ToState(outcome.end);
  }

 private:
  enum class Kind { kSlide, kTilt, kLift, kPinch };

  // Slides nearly always end where the object stays; held ends are rarer than they are to be.
  static Kind DrawKind(Rng& rng) {
    const double u = rng.Uniform();
    if (u < 0.20) return Kind::kSlide;
    if (u < 0.60) return Kind::kTilt;
    return u < 0.88 ? Kind::kLift : Kind::kPinch;
  }

  // A finger that does the same in every knot, as the planner's own proposals do.
  std::optional<FingerStage> DrawFinger(Finger finger, Kind kind, const ContactPlaces& places,
                                        Rng& rng) const {
    const int place = places.DrawAny(finger, rng);
    if (place == ContactPlaces::kNone) return std::nullopt;
    const GraspContact contact = places.At(finger, place);
    const Matrix3 R_WC = places.X_WB().front().linear() * FrameFromNormal(contact.nhat_O);
    const Vector3 into_W = -R_WC.col(2);
    const double angle = rng.Uniform(0.0, 2.0 * kPi);
    const Vector2 aside(std::cos(angle), std::sin(angle));
    const double strength = rng.Uniform(), share = rng.Uniform(), far = rng.Uniform();
    double depth = 0.2 + 0.8 * strength;
    Vector2 tangent = aside * (0.5 + 0.5 * share);
    Vector3 travel_W = R_WC.leftCols<2>() * aside;
    if (kind == Kind::kTilt) {
      tangent = aside * 0.5 * share;
      travel_W = into_W;
    } else if (kind != Kind::kSlide) {
      Vector2 up = (R_WC.transpose() * up_W_).head<2>();
      up = up.norm() < 0.1 ? aside : Vector2(up.normalized());
      tangent = up * (0.7 + 0.3 * share);
      travel_W = R_WC.leftCols<2>() * up + 0.6 * rng.Uniform() * into_W;
    }
    FingerStage stage;
    stage.on = true;
    stage.contact = {true, contact.p_OC, contact.nhat_O};
    FingerStage::Knot knot;
    knot.depth = depth * range_.max_depth;
    knot.tangent = tangent * range_.cone * knot.depth;
    knot.travel_W = travel_W * far * range_.max_travel;
    stage.knots.assign(config_.timing.knots, knot);
    return stage;
  }

  std::optional<RelativePlan> DrawPlan(const ContactPlaces& places, Rng& rng) const {
    const Kind kind = DrawKind(rng);
    const std::uint32_t alone = rng.UniformInt(kNumPlanningFingers);
    const int stages = 1 + static_cast<int>(rng.UniformInt(3));
    std::array<FingerStage, kNumPlanningFingers> fingers;
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (kind != Kind::kPinch && f != static_cast<int>(alone)) continue;
      const auto finger = DrawFinger(static_cast<Finger>(f), kind, places, rng);
      if (!finger) return std::nullopt;
      fingers[f] = *finger;
    }
    if (kind == Kind::kPinch) {
      Placement placement;
      for (int f = 0; f < kNumPlanningFingers; ++f) placement.fingers[f] = fingers[f].contact;
      if (CalcTipGap(grasp_world_.tips(), placement) < 0.0) return std::nullopt;
    }
    RelativePlan plan;
    for (int s = 0; s < stages; ++s) {
      plan.stages.push_back(fingers);
      for (FingerStage& finger : plan.stages.back()) finger.kept = finger.on && s > 0;
    }
    return plan;
  }

  std::optional<ReachedState> ToState(const WorldState& end) const {
    const BodyState& object = end.bodies.front();
    if (object.v_WB.norm() > kStillSpeed || object.w_WB.norm() > kStillTurn) return std::nullopt;
    if (up_W_.dot(object.X_WB() * world_.scene().object().mass_properties->p_BoBcm) < 0.0) {
      return std::nullopt;  // off the table
    }
    ReachedState result;
    result.state = end;
    result.moved = true;
    const std::vector<RigidTransform> X_WB = world_.GetPoses(end);
    const bool stays = SimulateRelease(world_, end).stays;
    for (int f = 0; f < kNumFingers; ++f) {
      const auto finger = static_cast<Finger>(f);
      const FingertipState& tip = end.fingers[f];
      if (!stays && tip.on && tip.touching) {
        if (CalcTipOverlap(end, finger, grasp_world_.tips().radius(finger), X_WB,
                           grasp_world_.environment()) > kTipOverlapAllowed) {
          return std::nullopt;
        }
        const GraspContact contact = grasp_world_.ContactNear(finger, tip.p_OC);
        // One that presses on an edge is in no grasp.
        if ((contact.p_OC - tip.p_OC).norm() > 1e-3 || contact.nhat_O.dot(tip.nhat_O) < 0.9) {
          return std::nullopt;
        }
        result.fixed.push_back({finger, tip.p_OC, tip.nhat_O});
      } else {
        world_.LiftFinger(result.state, finger);
      }
    }
    if (!stays && result.fixed.empty()) return std::nullopt;
    return result;
  }

  const World& world_;
  const GraspWorld& grasp_world_;
  const MotionStatesConfig& config_;
  ActionRange range_;
  WorldState first_;
  Vector3 up_W_;
};

// An end that may be kept.
struct Candidate {
  ReachedState end;
  double room = 0.0;  // GraspRoom there
};

// Of the candidates, held or not, that are apart from all kept, the one with the most room or the
// farthest one; -1 if there is none.
int FindNext(const std::vector<Candidate>& pool, const std::vector<ReachedState>& kept, bool held,
             bool by_room) {
  int best = -1;
  double most = -1.0;
  for (std::size_t i = 0; i < pool.size(); ++i) {
    if (pool[i].end.fixed.empty() == held) continue;
    double apart = std::numeric_limits<double>::infinity();
    for (const ReachedState& other : kept) {
      apart = std::min(apart, CalcApart(pool[i].end.state, other.state));
    }
    const double value = by_room ? pool[i].room : apart;
    if (apart > kLeastApart && value > most) {
      most = value;
      best = static_cast<int>(i);
    }
  }
  return best;
}

}  // namespace

std::vector<ReachedState> SampleMotionStates(const World& world, const GraspWorld& grasp_world,
                                             const GraspRoom& room,
                                             const MotionStatesConfig& config, std::uint64_t seed) {
  std::vector<ReachedState> kept(1);
  kept.front().state = world.InitialState();
  const PushSampler sampler(world, grasp_world, config);
  const ContactPlaces start_places(grasp_world, world.GetPoses(kept.front().state));
  std::vector<Candidate> pool;
  std::vector<int> bases;  // of the candidates, those where the object stays by itself
  for (int i = 0; i < config.pushes; ++i) {
    ThrowIfInterrupted();
    Rng rng(seed, RngStream::kItemGrowth, i);
    std::optional<ReachedState> end;
    if (!bases.empty() && rng.Uniform() < 0.5) {
      // The better of two: a strip has to come far over the edge before it has room for any grasp.
      const Candidate& a = pool[bases[rng.UniformInt(bases.size())]];
      const Candidate& b = pool[bases[rng.UniformInt(bases.size())]];
      const WorldState& base = (a.room > b.room ? a : b).end.state;
      const ContactPlaces places(grasp_world, world.GetPoses(base));
      end = sampler.Push(base, places, rng);
    } else {
      end = sampler.Push(kept.front().state, start_places, rng);
    }
    if (!end) continue;
    if (end->fixed.empty()) bases.push_back(static_cast<int>(pool.size()));
    const double free = room.Calc(world.GetPoses(end->state), end->fixed);
    pool.push_back({std::move(*end), free});
  }
  int misses = 0;
  for (int turn = 0; misses < 4 && static_cast<int>(kept.size()) < config.states; ++turn) {
    const int next = FindNext(pool, kept, turn % 2 == 0, turn % 4 < 2);
    misses = next < 0 ? misses + 1 : 0;
    if (next >= 0) kept.push_back(pool[next].end);
  }
  return kept;
}

}  // namespace pregrasp
