#include "app/hand/hand_simbody.h"

#include <Simbody.h>

namespace pregrasp {
namespace {

SimTK::Vec3 ToSimbody(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Vector3 FromSimbody(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::Mat33 ToSimbody(const Matrix3& M) {
  return {M(0, 0), M(0, 1), M(0, 2), M(1, 0), M(1, 1), M(1, 2), M(2, 0), M(2, 1), M(2, 2)};
}

SimTK::Rotation ToRotation(const Matrix3& R) { return SimTK::Rotation(ToSimbody(R), true); }

SimTK::Transform ToSimbody(const RigidTransform& X) {
  return {ToRotation(X.linear()), ToSimbody(Vector3(X.translation()))};
}

RigidTransform FromSimbody(const SimTK::Transform& X) {
  Matrix3 R;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) R(i, k) = X.R()[i][k];
  }
  return MakeTransform(R, FromSimbody(X.p()));
}

SimTK::Body::Rigid MakeBody(const HandLink& link) {
  const SimTK::Vec3 com = ToSimbody(link.p_LoLcm);
  const Matrix3& I = link.I_LLcm;
  const SimTK::Inertia about_com(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
  return SimTK::Body::Rigid(
      SimTK::MassProperties(link.mass, com, about_com.shiftFromMassCenter(-com, link.mass)));
}

}  // namespace

struct HandSimbody::Impl {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  std::array<SimTK::MobilizedBodyIndex, kMaxHandLinks> bodies;
  SimTK::State state;
  int num_joints = 0;
};

HandSimbody::HandSimbody(const HandModel& hand) : impl_(std::make_unique<Impl>()) {
  impl_->num_joints = hand.num_joints;
  impl_->bodies[0] = SimTK::MobilizedBody::Free(impl_->matter.Ground(), MakeBody(hand.links[0]))
                         .getMobilizedBodyIndex();
  for (int j = 0; j < hand.num_joints; ++j) {
    const HandJoint& joint = hand.joints[j];
    // A Pin turns about its z axis: both frames get the rotation that takes z to the joint's axis.
    const RigidTransform X_JA = MakeTransform(FrameFromNormal(joint.axis), Vector3::Zero());
    SimTK::MobilizedBody& parent = impl_->matter.updMobilizedBody(impl_->bodies[joint.parent]);
    impl_->bodies[j + 1] =
        SimTK::MobilizedBody::Pin(parent, ToSimbody(RigidTransform(joint.X_PJ * X_JA)),
                                  MakeBody(hand.links[j + 1]), ToSimbody(X_JA))
            .getMobilizedBodyIndex();
  }
  impl_->state = impl_->system.realizeTopology();
}

HandSimbody::~HandSimbody() = default;
HandSimbody::HandSimbody(HandSimbody&&) noexcept = default;

void HandSimbody::SetConfiguration(const HandConfiguration& configuration) {
  body(0).setQToFitTransform(impl_->state, ToSimbody(configuration.X_WH));
  for (int j = 0; j < impl_->num_joints; ++j) {
    body(j + 1).setOneQ(impl_->state, 0, configuration.q[j]);
  }
  impl_->system.realize(impl_->state, SimTK::Stage::Position);
}

RigidTransform HandSimbody::CalcLinkPose(int link) const {
  return FromSimbody(body(link).getBodyTransform(impl_->state));
}

PointJacobian HandSimbody::CalcPointJacobian(int link, const Vector3& p_L) const {
  SimTK::Matrix J;
  impl_->matter.calcStationJacobian(impl_->state, impl_->bodies[link], ToSimbody(p_L), J);
  PointJacobian out = PointJacobian::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      out(i, k) = J(i, 3 + k);
      out(i, 3 + k) = J(i, k);
    }
    for (int j = 0; j < impl_->num_joints; ++j) out(i, 6 + j) = J(i, 6 + j);
  }
  return out;
}

double HandSimbody::CalcTotalMass() const { return impl_->matter.calcSystemMass(impl_->state); }

const SimTK::MultibodySystem& HandSimbody::system() const { return impl_->system; }
const SimTK::SimbodyMatterSubsystem& HandSimbody::matter() const { return impl_->matter; }
const SimTK::MobilizedBody& HandSimbody::body(int link) const {
  return impl_->matter.getMobilizedBody(impl_->bodies[link]);
}
SimTK::State& HandSimbody::state() { return impl_->state; }

HandConfiguration HandSimbody::GetConfiguration(const SimTK::State& state) const {
  HandConfiguration out;
  out.X_WH = FromSimbody(body(0).getMobilizerTransform(state));
  for (int j = 0; j < impl_->num_joints; ++j) out.q[j] = body(j + 1).getOneQ(state, 0);
  return out;
}

}  // namespace pregrasp
