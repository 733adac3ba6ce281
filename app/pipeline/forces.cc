#include "app/pipeline/forces.h"

#include <algorithm>
#include <map>

namespace pregrasp {

ForceSplit SplitFingerForce(const World& world, const WorldState& state, Finger finger) {
  const FingertipState& tip = state.fingers[static_cast<int>(finger)];
  const Vector3 nhat_W = state.bodies[0].q_WB * tip.nhat_O;
  ForceSplit split;
  split.normal = -tip.f_W.dot(nhat_W);
  split.tangential = (tip.f_W + split.normal * nhat_W).norm();
  split.limit = world.scene().fingertips.friction * std::max(0.0, split.normal);
  return split;
}

std::vector<SupportForce> CalcSupportForces(const World& world,
                                            const std::vector<ContactPoint>& contacts) {
  constexpr double kTouch = 1e-3;  // [N]
  constexpr double kUsedUp = 0.99;
  const std::vector<Body>& bodies = world.scene().bodies;
  std::map<BodyIndex, SupportForce> by_body;
  for (const ContactPoint& contact : contacts) {
    if (contact.body_a != kObjectBody) continue;  // which is the first body, and a < b
    SupportForce& support = by_body[contact.body_b];
    support.body = contact.body_b;
    const double normal = contact.f_W.dot(contact.nhat_W);  // on b, along the normal from a to b
    support.f_W -= contact.f_W;
    support.split.normal += normal;
    support.split.tangential += (contact.f_W - normal * contact.nhat_W).norm();
    support.split.limit +=
        std::min(bodies[0].friction, bodies[contact.body_b.value].friction) * std::max(0.0, normal);
  }
  std::vector<SupportForce> supports;
  for (auto& [body, support] : by_body) {
    if (support.split.normal < kTouch) continue;
    support.slipping = support.split.tangential > kUsedUp * support.split.limit;
    supports.push_back(support);
  }
  return supports;
}

}  // namespace pregrasp
