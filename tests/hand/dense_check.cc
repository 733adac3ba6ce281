#include "tests/hand/dense_check.h"

#include <fmt/format.h>

#include <cmath>

#include "app/geometry/signed_distance.h"
#include "app/hand/hand_simbody.h"

namespace pregrasp {
namespace {

constexpr int kSamples = 60;  // along an axis: at most .7 mm apart in the longest capsule

std::vector<Vector3> SampleAxis(const RigidTransform& X_WL, const HandCapsule& capsule) {
  std::vector<Vector3> points;
  for (int i = 0; i <= kSamples; ++i) {
    const double t = static_cast<double>(i) / kSamples;
    points.push_back(X_WL * Vector3((1.0 - t) * capsule.p_LA + t * capsule.p_LB));
  }
  return points;
}

}  // namespace

std::vector<std::string> FindFaults(const HandModel& hand, const std::vector<const Shape*>& shapes,
                                    const IkConfig& config, const IkProblem& problem,
                                    const HandConfiguration& configuration, double slack) {
  std::vector<std::string> faults;
  HandSimbody simbody(hand);
  simbody.SetConfiguration(configuration);
  for (int j = 0; j < kMaxHandJoints; ++j) {
    const double q = configuration.q[j];
    if (q < hand.joints[j].lower || q > hand.joints[j].upper) {
      faults.push_back(fmt::format("{} = {} beyond its limits", ShadowHand().joints[j].name, q));
    }
  }
  std::array<bool, kMaxHandCapsules> touches{};
  for (const IkContact& contact : problem.contacts) {
    const Fingertip& tip = hand.tip(contact.finger);
    touches[tip.capsule] = true;
    const RigidTransform X_WL = simbody.CalcLinkPose(tip.link);
    const double error = (X_WL * tip.p_LT - (contact.p_WC + tip.radius * contact.nhat_W)).norm();
    if (error > config.tip_tolerance) {
      faults.push_back(fmt::format("{} tip off by {} m", FingerName(contact.finger), error));
    }
    const double cone = std::acos(X_WL.linear().col(2).dot(-contact.nhat_W));
    if (cone > DegToRad(config.max_cone_deg) + 1e-9) {
      faults.push_back(fmt::format("{} at {} rad", FingerName(contact.finger), cone));
    }
  }
  std::vector<std::vector<Vector3>> axes;
  for (const HandCapsule& capsule : hand.capsules) {
    axes.push_back(SampleAxis(simbody.CalcLinkPose(capsule.link), capsule));
  }
  for (std::size_t body = 0; body < shapes.size(); ++body) {
    const SignedDistance distance(*shapes[body]);
    const RigidTransform X_BW = problem.X_WB[body].inverse();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double allowed = body == 0 && touches[i] ? -config.contact_depth : 0.0;
      for (const Vector3& p_W : axes[i]) {
        const double gap = distance.Calc(X_BW * p_W) - hand.capsules[i].radius;
        if (gap >= allowed - slack) continue;
        faults.push_back(fmt::format("{} in body {} by {} m", hand.capsules[i].name, body, -gap));
        break;
      }
    }
  }
  for (const auto& [i, k] : hand.self_pairs) {
    const double sum = hand.capsules[i].radius + hand.capsules[k].radius;
    double least = 1.0;
    for (const Vector3& a : axes[i]) {
      for (const Vector3& b : axes[k]) least = std::min(least, (a - b).norm());
    }
    if (least < sum - slack) {
      faults.push_back(fmt::format("{} in {} by {} m", hand.capsules[i].name, hand.capsules[k].name,
                                   sum - least));
    }
  }
  return faults;
}

}  // namespace pregrasp
