#include "tests/motion/motion_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/geometry/signed_distance.h"
#include "app/hand/hand_simbody.h"

namespace pregrasp {
namespace {

constexpr int kSubsteps = 10;
constexpr int kPoints = 40;             // along an axis: a millimetre apart in the longest capsule
constexpr double kContactDepth = 1e-3;  // [m]

struct Limits {
  double speed, acceleration;
};
constexpr Limits kWrist{1.0, 5.0}, kTurn{3.0, 20.0};
constexpr double kJointAcceleration = 40.0;

RigidTransform Between(const RigidTransform& a, const RigidTransform& b, double s) {
  const Vector3 p = (1.0 - s) * a.translation() + s * b.translation();
  return MakeTransform(Quaternion(a.linear()).slerp(s, Quaternion(b.linear())), p);
}

Vector3 TurnBetween(const RigidTransform& a, const RigidTransform& b) {
  const Eigen::AngleAxisd turn(Matrix3(b.linear() * a.linear().transpose()));
  return turn.angle() * turn.axis();
}

double DistanceToSegment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 ab = b - a;
  const double square = ab.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - a).dot(ab) / square, 0.0, 1.0) : 0.0;
  return (a + t * ab - p).norm();
}

class Auditor {
 public:
  Auditor(const HandModel& hand, const Scene& scene) : hand_(hand), scene_(scene), simbody_(hand) {
    for (const Body& body : scene.bodies) distances_.emplace_back(body.shape);
  }

  // The deepest overlap beyond what is allowed, and between what.
  double FindDeepest(const HandConfiguration& at, const std::vector<RigidTransform>& X_WB,
                     const std::array<bool, kNumFingers>& on, std::string* pair) {
    simbody_.SetConfiguration(at);
    const std::size_t count = hand_.capsules.size();
    std::vector<Vector3> a(count), b(count);
    for (std::size_t i = 0; i < count; ++i) {
      const RigidTransform X_WL = simbody_.CalcLinkPose(hand_.capsules[i].link);
      a[i] = X_WL * hand_.capsules[i].p_LA;
      b[i] = X_WL * hand_.capsules[i].p_LB;
    }
    double deepest = 0.0;
    const auto take = [&](double overlap, const std::string& one, const std::string& other) {
      if (overlap <= deepest) return;
      deepest = overlap;
      *pair = one + " in " + other;
    };
    for (std::size_t i = 0; i < count; ++i) {
      bool touches = false;
      for (int f = 0; f < kNumFingers; ++f) {
        touches |= on[f] && hand_.tips[f].capsule == static_cast<int>(i);
      }
      const double radius = hand_.capsules[i].radius;
      for (std::size_t body = 0; body < distances_.size(); ++body) {
        const double allowed = body == 0 && touches ? kContactDepth : 0.0;
        const RigidTransform X_BW = X_WB[body].inverse();
        const Vector3 middle = X_BW * Vector3(0.5 * (a[i] + b[i]));
        const double reach = radius + 0.5 * (b[i] - a[i]).norm();
        if (distances_[body].Calc(middle) > reach) continue;
        double least = 1.0;
        for (int k = 0; k <= kPoints; ++k) {
          const double s = static_cast<double>(k) / kPoints;
          least =
              std::min(least, distances_[body].Calc(X_BW * Vector3((1.0 - s) * a[i] + s * b[i])));
        }
        take(radius - least - allowed, hand_.capsules[i].name, scene_.bodies[body].name);
      }
    }
    for (const auto& [i, k] : hand_.self_pairs) {
      const double sum = hand_.capsules[i].radius + hand_.capsules[k].radius;
      for (int n = 0; n <= kPoints; ++n) {
        const double s = static_cast<double>(n) / kPoints;
        const double d = DistanceToSegment((1.0 - s) * a[i] + s * b[i], a[k], b[k]);
        if (d < sum) take(sum - d, hand_.capsules[i].name, hand_.capsules[k].name);
      }
    }
    return deepest;
  }

 private:
  const HandModel& hand_;
  const Scene& scene_;
  HandSimbody simbody_;
  std::vector<SignedDistance> distances_;
};

void AddRates(const HandModel& hand, const std::vector<AuditFrame>& frames, std::size_t i,
              MotionAudit* audit) {
  AuditRates& rates = audit->rates[static_cast<int>(frames[i].phase)];
  ++rates.frames;
  double worst = 0.0;
  std::string what;
  const auto take = [&](double value, double limit, double* largest, const char* name) {
    *largest = std::max(*largest, value);
    if (value / limit <= worst) return;
    worst = value / limit;
    what = name;
  };
  struct Speeds {
    Vector3 v = Vector3::Zero(), w = Vector3::Zero();
    HandJoints q = HandJoints::Zero();
  };
  const auto speeds = [&](std::size_t k) {  // of the step into frame k
    Speeds s;
    if (k == 0 || k >= frames.size()) return s;
    const AuditFrame &a = frames[k - 1], &b = frames[k];
    const double rate = 1.0 / (b.t - a.t);
    s.v = rate * (b.hand.X_WH.translation() - a.hand.X_WH.translation());
    s.w = rate * TurnBetween(a.hand.X_WH, b.hand.X_WH);
    s.q = rate * (b.hand.q - a.hand.q);
    return s;
  };
  const Speeds before = speeds(i), after = speeds(i + 1);
  const double rate = 1.0 / (frames[1].t - frames[0].t);
  take(before.v.norm(), kWrist.speed, &rates.wrist, "wrist speed");
  take(before.w.norm(), kTurn.speed, &rates.turn, "wrist turn");
  take(rate * (after.v - before.v).norm(), kWrist.acceleration, &rates.wrist_acceleration,
       "wrist acceleration");
  take(rate * (after.w - before.w).norm(), kTurn.acceleration, &rates.turn_acceleration,
       "wrist turn acceleration");
  for (int j = 0; j < hand.num_joints; ++j) {
    take(std::abs(before.q[j]), hand.joints[j].max_speed, &rates.joint,
         hand.joints[j].name.c_str());
    take(rate * std::abs(after.q[j] - before.q[j]), kJointAcceleration, &rates.joint_acceleration,
         hand.joints[j].name.c_str());
  }
  constexpr double kRounding = 1e-9;
  rates.over += worst > 1.0 + kRounding;
  if (worst > rates.share) {
    rates.share = worst;
    rates.limiting = fmt::format("{} at frame {}", what, i);
  }
}

bool IsStill(const AuditFrame& a, const AuditFrame& b) {
  constexpr double kStill = 2e-4, kReach = 0.1;  // [m]
  return (b.hand.X_WH.translation() - a.hand.X_WH.translation()).norm() < kStill &&
         kReach * TurnBetween(a.hand.X_WH, b.hand.X_WH).norm() < kStill &&
         kReach * (b.hand.q - a.hand.q).cwiseAbs().maxCoeff() < kStill;
}

}  // namespace

std::vector<AuditFrame> FramesOf(const MotionState& state) {
  std::vector<AuditFrame> frames;
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    const MotionFrameTask& task = state.task->frames[i];
    AuditFrame frame{task.t, task.phase, task.X_WB, state.frames[i].configuration, {}};
    for (int f = 0; f < kNumFingers; ++f) frame.on[f] = task.contacts[f].on;
    frames.push_back(std::move(frame));
  }
  return frames;
}

MotionAudit AuditMotion(const HandModel& hand, const Scene& scene,
                        const std::vector<AuditFrame>& frames, double slack) {
  MotionAudit audit;
  audit.frames = static_cast<int>(frames.size());
  Auditor auditor(hand, scene);
  double deepest = 0.0, still = 0.0;
  const auto take = [&](double overlap, double where, const std::string& pair) {
    if (overlap <= deepest) return;
    deepest = overlap;
    audit.worst_pair = fmt::format("{} at frame {:.1f}", pair, where);
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const AuditFrame& frame = frames[i];
    std::string pair;
    const double overlap = auditor.FindDeepest(frame.hand, frame.X_WB, frame.on, &pair);
    audit.worst_frame = std::max(audit.worst_frame, overlap);
    audit.bad_frames += overlap > slack;
    take(overlap, static_cast<double>(i), pair);
    audit.out_of_range += (frame.hand.q.array() < hand.q_lower.array()).any() ||
                          (frame.hand.q.array() > hand.q_upper.array()).any();
    AddRates(hand, frames, i, &audit);
    if (i == 0) continue;
    const AuditFrame& last = frames[i - 1];
    audit.worst_jump =
        std::max(audit.worst_jump, TurnBetween(last.hand.X_WH, frame.hand.X_WH).norm());
    still = IsStill(last, frame) ? still + frame.t - last.t : 0.0;
    audit.longest_still = std::max(audit.longest_still, still);
    std::array<bool, kNumFingers> on;
    for (int f = 0; f < kNumFingers; ++f) on[f] = last.on[f] || frame.on[f];
    bool bad = false;
    for (int k = 1; k < kSubsteps; ++k) {
      const double s = static_cast<double>(k) / kSubsteps;
      HandConfiguration at;
      at.X_WH = Between(last.hand.X_WH, frame.hand.X_WH, s);
      at.q = (1.0 - s) * last.hand.q + s * frame.hand.q;
      std::vector<RigidTransform> X_WB;
      for (std::size_t b = 0; b < frame.X_WB.size(); ++b) {
        X_WB.push_back(Between(last.X_WB[b], frame.X_WB[b], s));
      }
      const double between = auditor.FindDeepest(at, X_WB, on, &pair);
      audit.worst_way = std::max(audit.worst_way, between);
      bad |= between > slack;
      take(between, static_cast<double>(i - 1) + s, pair);
    }
    audit.bad_ways += bad;
  }
  return audit;
}

}  // namespace pregrasp
