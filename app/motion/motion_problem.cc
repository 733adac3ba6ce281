#include "app/motion/motion_problem.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/ease.h"
#include "app/core/rng.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/signed_distance.h"
#include "app/hand/solvable_problem.h"

namespace pregrasp {
namespace {

// The parts of a motion [s], and how high the lift is [m].
constexpr double kPush = 0.8, kWait = 0.8, kStand = 0.4, kTakeOver = 0.1, kClose = 0.6;
constexpr double kLift = 1.2, kRise = 0.10;

using Contacts = std::array<Placement::Contact, kNumFingers>;

Body FixedBox(const char* name, const Vector3& size, const RigidTransform& X_WB) {
  Body body;
  body.name = name;
  body.shape = Box{size};
  body.X_WB = X_WB;
  return body;
}

// The hand's fingers `used`, with their contacts from a solvable problem's truth.
Contacts ContactsOf(const SolvableProblem& solvable, const std::vector<Finger>& used) {
  Contacts contacts{};
  const RigidTransform X_OW = solvable.problem.X_WB.front().inverse();
  for (const IkContact& contact : solvable.problem.contacts) {
    if (std::find(used.begin(), used.end(), contact.finger) == used.end()) continue;
    contacts[static_cast<int>(contact.finger)] = {true, X_OW * contact.p_WC,
                                                  Vector3(X_OW.linear() * contact.nhat_W)};
  }
  return contacts;
}

class Path {
 public:
  Path(const World& world, const Vector3& way, double yaw)
      : world_(world), start_(world.InitialState()), way_(way), yaw_(yaw) {
    state_ = start_;
    rows.push_back({state_, {}});
  }

  // For `seconds`, the fingers of `contacts` on, from share `from` of the way to share `to`, and
  // up.
  void Run(double seconds, const Contacts& contacts, double from, double to, double rise) {
    const double dt = world_.config().dt;
    const int steps = static_cast<int>(std::lround(seconds / dt));
    const double z = state_.bodies[0].p_WB.z();
    for (int i = 1; i <= steps; ++i) {
      const double s = Ease(static_cast<double>(i) / steps);
      const double share = from + s * (to - from);
      state_.t += dt;
      BodyState& body = state_.bodies[0];
      body.p_WB = start_.bodies[0].p_WB + share * way_;
      body.p_WB.z() = z + s * rise;
      body.q_WB =
          Quaternion(Eigen::AngleAxisd(share * yaw_, Vector3::UnitZ())) * start_.bodies[0].q_WB;
      for (int f = 0; f < kNumFingers; ++f) {
        state_.fingers[f].on = state_.fingers[f].touching = contacts[f].on;
        state_.fingers[f].p_OC = contacts[f].p_OC;
        state_.fingers[f].nhat_O = contacts[f].nhat_O;
      }
      rows.push_back({state_, {}});
    }
  }

  void Clear() { rows = {{state_, {}}}; }
  double t() const { return state_.t; }

  std::vector<TraceRow> rows;

 private:
  const World& world_;
  WorldState start_, state_;
  Vector3 way_;
  double yaw_;
};

}  // namespace

MotionProblem MakeMotionProblem(std::uint64_t seed) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    PREGRASP_CHECK(attempt < 1000, seed);
    Rng rng(seed, RngStream::kMotionProblem, attempt);
    // A five-finger pose of which all contacts are known to be within reach, and another for the
    // second stage on the same box.
    const SolvableProblem solvable = MakeSolvableProblem(IkObject::kBox, 5, false, rng);
    MotionProblem problem;
    problem.seed = seed;
    Body box;
    box.name = "box";
    box.shape = solvable.shapes[0];
    box.mass_properties = CalcMassProperties(box.shape, 0.2);
    box.X_WB = solvable.problem.X_WB[0];
    problem.scene.name = "generated";
    const double table = 1.6;
    const Vector3 size = std::get<Box>(box.shape).size;
    const double radius = 0.5 * size.head<2>().norm();
    const double side = rng.Uniform(0.0, 2.0 * kPi);
    const double gap = rng.Uniform(0.03, 0.12);
    const double length = rng.Uniform(0.05, 0.12);
    const double heading = side + rng.Uniform(0.6, 2.0 * kPi - 0.6);  // not into the wall
    const double yaw = rng.Uniform(-0.5, 0.5);
    const RigidTransform X_WWall =
        MakeTransform(RotationFromRpy({0.0, 0.0, side}), box.X_WB.translation()) *
        MakeTransform(Matrix3(Matrix3::Identity()),
                      Vector3(radius + length + gap + 0.01, 0.0, 0.0));
    problem.scene.bodies = {
        box,
        FixedBox("table", {table, table, 0.02},
                 MakeTransform(Matrix3(Matrix3::Identity()), Vector3(0.0, 0.0, -0.01))),
        FixedBox("wall", {0.02, 0.4, 0.24}, X_WWall)};
    const Vector3 way = length * Vector3(std::cos(heading), std::sin(heading), 0.0);
    const World world(problem.scene);
    const IkSolver solver(HandOf(problem.scene), problem.scene);

    // Stages: thumb and index, then thumb and middle; the truth shows that each is within reach on
    // its own, at the start and, checked here, along the way.
    const Contacts all = ContactsOf(solvable, {Finger::kThumb, Finger::kIndex, Finger::kMiddle,
                                               Finger::kRing, Finger::kLittle});
    const Contacts first = ContactsOf(solvable, {Finger::kThumb, Finger::kIndex});
    const Contacts second = ContactsOf(solvable, {Finger::kMiddle, Finger::kRing});
    Path path(world, way, yaw);
    path.Run(kPush, first, 0.0, 0.5, 0.0);
    path.Run(kWait, {}, 0.5, 0.5, 0.0);
    path.Run(kPush, second, 0.5, 1.0, 0.0);
    path.Run(kStand, second, 1.0, 1.0, 0.0);
    const std::vector<TraceRow> trace = path.rows;
    path.Clear();
    path.Run(kTakeOver, second, 1.0, 1.0, 0.0);
    const double closing_t = path.t();
    path.Run(kClose, all, 1.0, 1.0, 0.0);
    const double lift_t = path.t();
    path.Run(kLift, all, 1.0, 1.0, kRise);
    const std::vector<TraceRow> lift = path.rows;
    const RigidTransform X_WO_end = trace.back().state.bodies[0].X_WB();

    // The grasp at the end of the way, and free of the wall.
    MotionFrameTask end;
    end.X_WB = world.GetPoses(trace.back().state);
    end.contacts = all;
    IkProblem ik = MakeIkProblem(end);
    ik.warm_start = solvable.truth;
    ik.warm_start->X_WH = X_WO_end * solvable.problem.X_WB[0].inverse() * solvable.truth.X_WH;
    const IkResult grasp = solver.Solve({}, ik, Rng(seed, RngStream::kMotionProblemIk, attempt, 0));
    if (!grasp.solved()) continue;
    // Each stage has a solution at its ends.
    const auto solves = [&](const WorldState& state, const Contacts& contacts) {
      MotionFrameTask frame;
      frame.X_WB = world.GetPoses(state);
      frame.contacts = contacts;
      return solver
          .Solve({}, MakeIkProblem(frame), Rng(seed, RngStream::kMotionProblemIk, attempt, 1))
          .solved();
    };
    if (!solves(trace.front().state, first) || !solves(trace[trace.size() / 2].state, second)) {
      continue;
    }
    problem.grasp = grasp.configuration();
    problem.task = BuildMotionTask(world, trace, {lift, closing_t, lift_t}, {});
    return problem;
  }
}

}  // namespace pregrasp
