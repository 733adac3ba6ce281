#include "app/pictures/forces.h"

#include <algorithm>
#include <map>

namespace pregrasp {

ForceSplit SplitFingerForce(const Scene& scene, const Quaternion& q_WO, const FingerFacts& finger) {
  const Vector3 nhat_W = q_WO * finger.nhat_O;
  ForceSplit split;
  split.normal = 0.0 - finger.f_W.dot(nhat_W);  // 0, not -0, of no force
  split.tangential = (finger.f_W + split.normal * nhat_W).norm();
  split.limit = scene.fingertips.friction * std::max(0.0, split.normal);
  return split;
}

std::vector<SupportForce> CalcSupportForces(const Scene& scene,
                                            const std::vector<ContactFacts>& contacts) {
  constexpr double kTouch = 1e-3;  // [N]
  constexpr double kUsedUp = 0.99;
  const std::vector<Body>& bodies = scene.bodies;
  std::map<int, SupportForce> by_body;
  for (const ContactFacts& contact : contacts) {
    if (contact.a != 0) continue;  // the object is body 0, and a < b
    SupportForce& support = by_body[contact.b];
    support.body = contact.b;
    const double normal = contact.f_W.dot(contact.nhat_W);  // on b, along the normal from a to b
    support.f_W -= contact.f_W;
    support.split.normal += normal;
    support.split.tangential += (contact.f_W - normal * contact.nhat_W).norm();
    support.split.limit +=
        std::min(bodies[0].friction, bodies[contact.b].friction) * std::max(0.0, normal);
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
