#include "app/dynamics/simbody_model.h"

#include <Simbody.h>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

SimTK::Vec3 ToSimTK(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Vector3 FromSimTK(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

SimTK::Rotation ToSimTK(const Quaternion& q) {
  return SimTK::Rotation(SimTK::Quaternion(SimTK::Vec4(q.w(), q.x(), q.y(), q.z())));
}

SimTK::MassProperties ToSimTK(const MassProperties& mass) {
  const Matrix3& I = mass.I_BBcm;
  const SimTK::Inertia central(SimTK::Vec3(I(0, 0), I(1, 1), I(2, 2)),
                               SimTK::Vec3(I(0, 1), I(0, 2), I(1, 2)));
  const SimTK::Vec3 p_BoBcm = ToSimTK(mass.p_BoBcm);
  return {mass.mass, p_BoBcm, central.shiftFromMassCenter(p_BoBcm, mass.mass)};
}

}  // namespace

// Each movable has a Free mobilizer whose outboard frame M is the body frame moved to the centre of
// mass. Its q are then the orientation and the position of the centre of mass, its u the angular
// velocity and the velocity of the centre of mass, all in Ground.
struct SimbodyModel::Impl {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  std::vector<SimTK::MobilizedBody::Free> bodies;
  SimTK::State state;
  SimTK::Vector_<SimTK::SpatialVec> forces;  // by mobilized body, Ground first
  SimTK::Vector f, du, momentum, u_mid, qdot;

  // Generalized positions start at this index of the state's q and u.
  int q_index(int i) const { return bodies[i].getFirstQIndex(state); }
  int u_index(int i) const { return bodies[i].getFirstUIndex(state); }

  void SetState(const std::vector<BodyState>& states) {
    SimTK::Vector& q = state.updQ();
    SimTK::Vector& u = state.updU();
    for (std::size_t i = 0; i < states.size(); ++i) {
      const BodyState& body = states[i];
      const Vector3 c_W = body.q_WB * FromSimTK(bodies[i].getBodyMassCenterStation(state));
      const Vector3 p_WBcm = body.p_WB + c_W;
      const Vector3 v_WBcm = body.v_WB + body.w_WB.cross(c_W);
      const double values[] = {body.q_WB.w(), body.q_WB.x(), body.q_WB.y(), body.q_WB.z(),
                               p_WBcm.x(),    p_WBcm.y(),    p_WBcm.z()};
      for (int k = 0; k < 7; ++k) q[q_index(i) + k] = values[k];
      for (int k = 0; k < 3; ++k) {
        u[u_index(i) + k] = body.w_WB[k];
        u[u_index(i) + 3 + k] = v_WBcm[k];
      }
    }
  }

  void GetState(std::vector<BodyState>* states) const {
    for (std::size_t i = 0; i < states->size(); ++i) {
      BodyState& body = (*states)[i];
      const int k = q_index(i);
      const SimTK::Vector& q = state.getQ();
      body.q_WB = Quaternion(q[k], q[k + 1], q[k + 2], q[k + 3]);
      body.p_WB = FromSimTK(bodies[i].getBodyOriginLocation(state));
      body.w_WB = FromSimTK(bodies[i].getBodyAngularVelocity(state));
      body.v_WB = FromSimTK(bodies[i].getBodyOriginVelocity(state));
    }
  }

  // Sets body i's entry of `forces` to a force at the centre of mass and a torque.
  void SetForce(int i, const Vector3& torque, const Vector3& force) {
    const Vector3 c_W =
        FromSimTK(bodies[i].getBodyRotation(state) * bodies[i].getBodyMassCenterStation(state));
    forces[bodies[i].getMobilizedBodyIndex()] =
        SimTK::SpatialVec(ToSimTK(torque + c_W.cross(force)), ToSimTK(force));
  }

  // du = M^-1 J^T forces.
  void CalcVelocityChange() {
    matter.multiplyBySystemJacobianTranspose(state, forces, f);
    matter.multiplyByMInv(state, f, du);
  }
};

SimbodyModel::SimbodyModel(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  for (const Body& body : scene.bodies) {
    if (!body.movable()) continue;
    const MassProperties& mass = *body.mass_properties;
    const Quaternion q_WB = Quaternion(body.X_WB.linear()).normalized();
    const Vector3 p_WBcm = body.X_WB.translation() + q_WB * mass.p_BoBcm;
    try {
      SimTK::MobilizedBody::Free mobilized(impl_->matter.updGround(), SimTK::Transform(),
                                           SimTK::Body::Rigid(ToSimTK(mass)),
                                           SimTK::Transform(ToSimTK(mass.p_BoBcm)));
      mobilized.setDefaultTransform(SimTK::Transform(ToSimTK(q_WB), ToSimTK(p_WBcm)));
      impl_->bodies.push_back(mobilized);
    } catch (const std::exception&) {
      const auto moments = mass.I_BBcm.diagonal();
      throw InputError(body.where, body.name + ".inertia", "an inertia that a body can have",
                       FormatDouble(moments.x()) + ", " + FormatDouble(moments.y()) + ", " +
                           FormatDouble(moments.z()));
    }
  }
  impl_->state = impl_->system.realizeTopology();
  impl_->system.realizeModel(impl_->state);
  impl_->system.realize(impl_->state, SimTK::Stage::Velocity);
  impl_->forces.resize(impl_->matter.getNumBodies());
  impl_->forces.setToZero();
}

SimbodyModel::~SimbodyModel() = default;

int SimbodyModel::num_bodies() const { return static_cast<int>(impl_->bodies.size()); }

MassProperties SimbodyModel::GetMassProperties(int i) const {
  const SimTK::MassProperties& from = impl_->bodies[i].getBodyMassProperties(impl_->state);
  MassProperties mass;
  mass.mass = from.getMass();
  mass.p_BoBcm = FromSimTK(from.getMassCenter());
  const SimTK::Mat33 I = from.calcCentralInertia().toMat33();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) mass.I_BBcm(r, c) = I(r, c);
  }
  return mass;
}

std::vector<BodyState> SimbodyModel::GetDefaultState() const {
  std::vector<BodyState> bodies(impl_->bodies.size());
  impl_->GetState(&bodies);
  return bodies;
}

Energy SimbodyModel::CalcEnergy(const std::vector<BodyState>& bodies, const Vector3& gravity) {
  impl_->SetState(bodies);
  impl_->system.realize(impl_->state, SimTK::Stage::Velocity);
  Energy energy;
  energy.kinetic = impl_->matter.calcKineticEnergy(impl_->state);
  for (const auto& body : impl_->bodies) {
    energy.potential -= body.getBodyMass(impl_->state) *
                        gravity.dot(FromSimTK(body.findMassCenterLocationInGround(impl_->state)));
  }
  return energy;
}

void SimbodyModel::Predict(const std::vector<BodyState>& bodies,
                           const std::vector<BodyKernel>& kernels, const Vector3& gravity,
                           const Vector3& f_Ocm_W, double dt, std::vector<BodyMotion>* motions) {
  Impl& m = *impl_;
  m.SetState(bodies);
  m.system.realize(m.state, SimTK::Stage::Position);
  for (int i = 0; i < num_bodies(); ++i) {
    Vector3 f_W = m.bodies[i].getBodyMass(m.state) * gravity;
    if (i == 0) f_W += f_Ocm_W;
    m.SetForce(i, Vector3::Zero(), f_W);
  }
  m.CalcVelocityChange();
  m.state.updU() += dt * m.du;
  m.system.realize(m.state, SimTK::Stage::Velocity);
  motions->resize(bodies.size());
  for (int i = 0; i < num_bodies(); ++i) {
    const SimTK::MobilizedBody& body = m.bodies[i];
    BodyMotion& motion = (*motions)[i];
    const SimTK::Rotation& R = body.getBodyRotation(m.state);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) motion.R_WB(r, c) = R[r][c];
    }
    motion.R_WP = motion.R_WB * kernels[i].R_BP;
    motion.p_WB = FromSimTK(body.getBodyOriginLocation(m.state));
    motion.p_WBcm = FromSimTK(body.findMassCenterLocationInGround(m.state));
    motion.w_WB = FromSimTK(body.getBodyAngularVelocity(m.state));
    motion.v_WBcm = FromSimTK(
        body.findStationVelocityInGround(m.state, body.getBodyMassCenterStation(m.state)));
  }
}

void SimbodyModel::Advance(const std::vector<BodyImpulse>& impulses, double dt,
                           std::vector<BodyState>* bodies) {
  Impl& m = *impl_;
  for (int i = 0; i < num_bodies(); ++i) m.SetForce(i, impulses[i].angular, impulses[i].linear);
  m.CalcVelocityChange();
  m.state.updU() += m.du;
  m.system.realize(m.state, SimTK::Stage::Velocity);
  m.matter.multiplyByM(m.state, m.state.getU(), m.momentum);

  // The velocity halfway: gyroscopic forces act for half a step; the corrections come on top.
  m.matter.calcResidualForceIgnoringConstraints(
      m.state, SimTK::Vector(), SimTK::Vector_<SimTK::SpatialVec>(), SimTK::Vector(), m.f);
  m.matter.multiplyByMInv(m.state, m.f, m.du);
  m.u_mid = m.state.getU() - 0.5 * dt * m.du;
  for (int i = 0; i < num_bodies(); ++i) {
    m.SetForce(i, impulses[i].angular_correction, impulses[i].linear_correction);
  }
  m.CalcVelocityChange();
  m.u_mid += m.du;
  m.matter.multiplyByN(m.state, false, m.u_mid, m.qdot);
  m.state.updQ() += dt * m.qdot;
  m.system.realize(m.state, SimTK::Stage::Time);
  m.matter.normalizeQuaternions(m.state);

  // Momentum does not change while the body turns.
  m.system.realize(m.state, SimTK::Stage::Position);
  m.matter.multiplyByMInv(m.state, m.momentum, m.du);
  m.state.updU() = m.du;
  m.system.realize(m.state, SimTK::Stage::Velocity);
  m.GetState(bodies);
}

}  // namespace pregrasp
