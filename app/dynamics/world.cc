#include "app/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/dynamics/contact_set.h"
#include "app/dynamics/contact_solver.h"
#include "app/dynamics/fingertip.h"
#include "app/dynamics/motion.h"
#include "app/dynamics/simbody_model.h"
#include "app/geometry/signed_distance.h"

namespace pregrasp {
namespace {

// What a step needs besides the state. Its content never outlives a step; it is kept per thread for
// its memory.
struct StepScratch {
  std::vector<BodyMotion> motions;
  CollisionScene::Scratch collision;
  std::vector<Contact> contacts;
  ContactSolver solver;
  std::vector<BodyStep> steps;
  std::vector<BodyImpulse> impulses;
};

StepScratch& GetThreadScratch() {
  thread_local StepScratch scratch;
  return scratch;
}

// v and w from the state, the impulse of an acceleration of the centre of mass added.
void Predict(const BodyKernel& kernel, const BodyState& body, const Vector3& a_W, double dt,
             BodyMotion* motion) {
  motion->R_WB = body.q_WB.toRotationMatrix();
  motion->R_WP = kernel.CalcR_WP(motion->R_WB);
  const Vector3 c_W = motion->R_WB * kernel.p_BoBcm;
  motion->p_WB = body.p_WB;
  motion->p_WBcm = body.p_WB + c_W;
  motion->w_WB = body.w_WB;
  motion->v_WBcm = body.v_WB + body.w_WB.cross(c_W) + dt * a_W;
}

// Moves a body to the end of the step. The orientation follows the angular velocity halfway through
// the step, free of torque (second order, where the plain Euler step gains energy while tumbling);
// the angular momentum in W is kept exactly.
void Advance(const BodyKernel& kernel, const BodyMotion& motion, const BodyVelocity& y,
             const BodyVelocity& z, double dt, BodyState* body) {
  const Vector3 inv_I = kernel.inv_sqrt_I_P.cwiseProduct(kernel.inv_sqrt_I_P);
  const Vector3 L_P = kernel.I_P.cwiseProduct(kernel.inv_sqrt_I_P).cwiseProduct(y.w_P);
  const Vector3 w_P = kernel.inv_sqrt_I_P.cwiseProduct(y.w_P);
  const Vector3 w_P_mid =
      w_P - 0.5 * dt * inv_I.cwiseProduct(w_P.cross(L_P)) + kernel.inv_sqrt_I_P.cwiseProduct(z.w_P);
  const Vector3 turn = 0.5 * dt * (motion.R_WP * w_P_mid);
  const Quaternion& q = body->q_WB;
  const Quaternion dq = Quaternion(0.0, turn.x(), turn.y(), turn.z()) * q;
  body->q_WB.coeffs() = (q.coeffs() + dq.coeffs()).normalized();

  const Matrix3 R_WB = body->q_WB.toRotationMatrix();
  const Matrix3 R_WP = kernel.CalcR_WP(R_WB);
  const Vector3 L_W = motion.R_WP * L_P;
  body->w_WB = R_WP * inv_I.cwiseProduct(R_WP.transpose() * L_W);
  const Vector3 c_W = R_WB * kernel.p_BoBcm;
  body->p_WB = motion.p_WBcm + dt * (y.v_W + z.v_W) - c_W;
  body->v_WB = y.v_W - body->w_WB.cross(c_W);
}

}  // namespace

struct World::Impl {
  Scene scene;
  StepConfig config;
  CollisionScene collision;
  SignedDistance object_surface;
  std::vector<BodyKernel> kernels;
  WorldState initial;

  // Simbody models that no thread is using at the moment.
  std::mutex mutex;
  std::vector<std::unique_ptr<SimbodyModel>> models;

  Impl(const Scene& scene_in, const StepConfig& config_in)
      : scene(scene_in),
        config(config_in),
        collision(scene, config.margin),
        object_surface(scene.object().shape) {
    auto model = std::make_unique<SimbodyModel>(scene);
    for (BodyIndex b; b.value < static_cast<int>(scene.bodies.size()); ++b.value) {
      const Body& body = scene.bodies[b.value];
      if (!body.movable()) continue;
      const MassProperties mass = model->GetMassProperties(static_cast<int>(kernels.size()));
      kernels.push_back(MakeBodyKernel(b, mass.mass, mass.p_BoBcm, mass.I_BBcm,
                                       collision.CalcReach(b, mass.p_BoBcm)));
      if (!(kernels.back().I_P.minCoeff() > 0.0)) {
        throw InputError(body.where, body.name + ".inertia", "moments above 0 about every axis",
                         FormatDouble(kernels.back().I_P.minCoeff()));
      }
    }
    initial.bodies = model->GetDefaultState();
    models.push_back(std::move(model));
  }

  std::unique_ptr<SimbodyModel> TakeModel() {
    {
      const std::lock_guard lock(mutex);
      if (!models.empty()) {
        auto model = std::move(models.back());
        models.pop_back();
        return model;
      }
    }
    return std::make_unique<SimbodyModel>(scene);
  }

  void ReturnModel(std::unique_ptr<SimbodyModel> model) {
    const std::lock_guard lock(mutex);
    models.push_back(std::move(model));
  }

  // Of a spring on the object [N s/m].
  double CalcDamping(double stiffness) const {
    return scene.fingertips.damping * std::sqrt(stiffness * kernels[0].mass);
  }

  Energy CalcEnergy(const WorldState& state) {
    std::unique_ptr<SimbodyModel> model = TakeModel();
    const Energy energy = model->CalcEnergy(state.bodies, scene.gravity);
    ReturnModel(std::move(model));
    return energy;
  }

  // Contacts and fingers, from scratch->motions to the solver's velocities. Where a point that was
  // left out would overlap after the step, they are solved again with that point.
  Convergence SolveContacts(const WorldState& state, StepScratch* scratch) const {
    constexpr int kMaxRounds = 6;
    collision.FindContacts(kernels, scratch->motions, state.cache, config.dt, &scratch->collision,
                           &scratch->contacts);
    scratch->solver.SetContacts(config, kernels, scratch->motions, scratch->contacts, state.cache);
    for (int f = 0; f < kNumFingers; ++f) {
      const FingertipState& tip = state.fingers[f];
      if (!tip.on) continue;
      scratch->solver.AddFinger(FingertipLaw(scene.fingertips, tip, config.dt), f, tip,
                                state.bodies[0], kernels[0], scratch->motions[0]);
    }
    Convergence convergence = scratch->solver.Solve(config);
    for (int round = 1; round < kMaxRounds && AddOverlapping(scratch); ++round) {
      scratch->solver.AddPoints(config, kernels, scratch->motions, scratch->contacts);
      convergence = scratch->solver.Solve(config);
    }
    return convergence;
  }

  // Adds the points that the velocities found so far make overlap. Returns whether there are any.
  bool AddOverlapping(StepScratch* scratch) const {
    if (scratch->collision.faces.empty()) return false;
    scratch->steps.resize(kernels.size());
    for (int i = 0; i < static_cast<int>(kernels.size()); ++i) {
      const BodyVelocity &y = scratch->solver.velocity(i), &z = scratch->solver.correction(i);
      scratch->steps[i].shift_W = config.dt * (y.v_W + z.v_W);
      scratch->steps[i].turn_W = scratch->motions[i].R_WP *
                                 kernels[i].inv_sqrt_I_P.cwiseProduct(config.dt * (y.w_P + z.w_P));
    }
    return CollisionScene::AddOverlapping(scratch->motions, scratch->steps, &scratch->contacts);
  }

  // Everything but the bodies, once they have moved.
  void EndStep(const StepScratch& scratch, WorldState* state,
               std::vector<ContactPoint>* contacts) const {
    const ContactSolver& solver = scratch.solver;
    solver.SaveImpulses(scratch.contacts, &state->cache);
    const RigidTransform X_WO = state->bodies[0].X_WB();
    for (const FingerRows& rows : solver.fingers()) {
      AdvanceFinger(object_surface, rows, rows.CalcVelocity(solver.velocity(0)), X_WO,
                    &state->fingers[rows.finger]);
    }
    ++state->step;
    state->t += config.dt;
    if (contacts != nullptr) solver.GetPoints(scratch.contacts, config.dt, contacts);
  }
};

World::World(const Scene& scene, const StepConfig& config) {
  ValidateScene(scene);
  config.Validate();
  impl_ = std::make_unique<Impl>(scene, config);
}

World::~World() = default;
World::World(World&&) noexcept = default;

const Scene& World::scene() const { return impl_->scene; }
const StepConfig& World::config() const { return impl_->config; }
int World::num_movables() const { return static_cast<int>(impl_->kernels.size()); }
BodyIndex World::body_index(MovableIndex movable) const {
  return impl_->kernels.at(movable.value).body;
}
MovableIndex World::movable_index(BodyIndex body) const {
  return impl_->collision.movable_index(body);
}

WorldState World::InitialState() const { return impl_->initial; }

std::vector<RigidTransform> World::GetPoses(const WorldState& state) const {
  std::vector<RigidTransform> X_WB;
  X_WB.reserve(impl_->scene.bodies.size());
  for (const Body& body : impl_->scene.bodies) X_WB.push_back(body.X_WB);
  for (int i = 0; i < num_movables(); ++i) {
    X_WB[body_index(MovableIndex{i}).value] = state.bodies[i].X_WB();
  }
  return X_WB;
}

void World::PutFinger(WorldState& state, Finger finger, const Vector3& p_OC) const {
  const double stiffness = impl_->scene.fingertips.stiffness;
  PlaceFinger(impl_->object_surface, state.bodies[0].X_WB(), p_OC, stiffness,
              impl_->CalcDamping(stiffness), &state.fingers[static_cast<int>(finger)]);
}

void World::SetStiffness(WorldState& state, Finger finger, double stiffness) const {
  FingertipState& tip = state.fingers[static_cast<int>(finger)];
  PREGRASP_CHECK(tip.on && std::isfinite(stiffness) && stiffness > 0.0, FingerName(finger),
                 stiffness);
  ChangeSpring(state.bodies[0], stiffness, impl_->CalcDamping(stiffness), &tip);
}

void World::LiftFinger(WorldState& state, Finger finger) const {
  state.fingers[static_cast<int>(finger)] = {};
}

Convergence World::Step(WorldState& state, std::vector<ContactPoint>* contacts) const {
  const Impl& impl = *impl_;
  StepScratch& scratch = GetThreadScratch();
  const int n = num_movables();
  scratch.motions.resize(n);
  for (int i = 0; i < n; ++i) {
    Vector3 a_W = impl.scene.gravity;
    if (i == 0) a_W += impl.kernels[0].inv_mass * state.f_Ocm_W;
    Predict(impl.kernels[i], state.bodies[i], a_W, impl.config.dt, &scratch.motions[i]);
  }
  const Convergence convergence = impl.SolveContacts(state, &scratch);
  for (int i = 0; i < n; ++i) {
    Advance(impl.kernels[i], scratch.motions[i], scratch.solver.velocity(i),
            scratch.solver.correction(i), impl.config.dt, &state.bodies[i]);
  }
  impl.EndStep(scratch, &state, contacts);
  return convergence;
}

StepTrace World::StepWithTrace(WorldState& state) const {
  StepTrace trace;
  trace.convergence = Step(state, &trace.contacts);
  for (const ContactPoint& contact : trace.contacts) {
    trace.max_penetration = std::max(trace.max_penetration, -contact.phi);
  }
  const Energy energy = impl_->CalcEnergy(state);
  trace.kinetic_energy = energy.kinetic;
  trace.potential_energy = energy.potential;
  return trace;
}

Convergence World::StepWithSimbody(WorldState& state, std::vector<ContactPoint>* contacts) const {
  const Impl& impl = *impl_;
  StepScratch& scratch = GetThreadScratch();
  std::unique_ptr<SimbodyModel> model = impl_->TakeModel();
  model->Predict(state.bodies, impl.kernels, impl.scene.gravity, state.f_Ocm_W, impl.config.dt,
                 &scratch.motions);
  const Convergence convergence = impl.SolveContacts(state, &scratch);
  scratch.solver.SumImpulses(scratch.motions, scratch.contacts, &scratch.impulses);
  model->Advance(scratch.impulses, impl.config.dt, &state.bodies);
  impl_->ReturnModel(std::move(model));
  impl.EndStep(scratch, &state, contacts);
  return convergence;
}

double World::CalcEnergy(const WorldState& state) const {
  const Energy energy = impl_->CalcEnergy(state);
  return energy.kinetic + energy.potential;
}

}  // namespace pregrasp
