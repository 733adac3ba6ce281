#include "app/hand/hand_mirror.h"

namespace pregrasp {
namespace {

Vector3 Mirrored(const Vector3& v) { return {-v.x(), v.y(), v.z()}; }
Matrix3 Mirrored(const Matrix3& M) {
  const Matrix3 S = Vector3(-1.0, 1.0, 1.0).asDiagonal();
  return S * M * S;
}
RigidTransform Mirrored(const RigidTransform& X) {
  return MakeTransform(Mirrored(Matrix3(X.linear())), Mirrored(Vector3(X.translation())));
}

}  // namespace

void MirrorHand(HandModel* hand) {
  for (int link = 0; link < hand->num_links(); ++link) {
    hand->links[link].p_LoLcm = Mirrored(hand->links[link].p_LoLcm);
    hand->links[link].I_LLcm = Mirrored(hand->links[link].I_LLcm);
  }
  for (int j = 0; j < hand->num_joints; ++j) {
    hand->joints[j].X_PJ = Mirrored(hand->joints[j].X_PJ);
    hand->joints[j].axis = -Mirrored(hand->joints[j].axis);  // a turn is no vector
  }
  for (Fingertip& tip : hand->tips) tip.p_LT = Mirrored(tip.p_LT);
  for (HandCapsule& capsule : hand->capsules) {
    capsule.p_LA = Mirrored(capsule.p_LA);
    capsule.p_LB = Mirrored(capsule.p_LB);
  }
  for (HandVisual& visual : hand->visuals) {
    visual.X_LV = Mirrored(visual.X_LV);
    visual.scale.x() = -visual.scale.x();
  }
}

}  // namespace pregrasp
