#include "app/grasp/grasp_world.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

constexpr int kReachPostures = 30000;
constexpr double kReachTail = 1e-3;

}  // namespace

TipPair FindNearestTips(const TipSpheres& tips, const std::vector<GraspContact>& contacts) {
  TipPair nearest;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double gap = CalcTipGap(tips, contacts[k], contacts[i]);
      if (gap >= nearest.gap) continue;
      nearest = {{contacts[k].finger, contacts[i].finger}, gap};
      if (std::isnan(gap)) return nearest;
    }
  }
  return nearest;
}

TipReach MeasureTipReach(const HandModel& hand) {
  constexpr int kPairs = kNumFingers * (kNumFingers - 1) / 2;
  std::array<std::vector<double>, kPairs> distances;
  for (std::vector<double>& pair : distances) pair.reserve(kReachPostures);
  Rng rng(0, RngStream::kTipReach);
  HandPose pose;
  for (int sample = 0; sample < kReachPostures; ++sample) {
    ThrowIfInterrupted();
    HandJoints q = HandJoints::Zero();
    for (int j = 0; j < hand.num_joints; ++j) q[j] = rng.Uniform(hand.q_lower[j], hand.q_upper[j]);
    CalcHandPose(hand, RigidTransform::Identity(), q, &pose);
    std::array<Vector3, kNumFingers> centre;
    for (int f = 0; f < hand.num_fingers; ++f) {
      centre[f] = pose.CalcPoint(hand.tips[f].link, hand.tips[f].p_LT);
    }
    for (int a = 0, pair = 0; a < hand.num_fingers; ++a) {
      for (int b = a + 1; b < hand.num_fingers; ++b) {
        distances[pair++].push_back((centre[a] - centre[b]).norm());
      }
    }
  }
  TipReach reach;
  for (int a = 0, pair = 0; a < hand.num_fingers; ++a) {
    for (int b = a + 1; b < hand.num_fingers; ++b) {
      std::vector<double>& sorted = distances[pair++];
      std::sort(sorted.begin(), sorted.end());
      const int tail = static_cast<int>(kReachTail * kReachPostures);
      reach.nearest[a][b] = reach.nearest[b][a] = sorted[tail];
      reach.farthest[a][b] = reach.farthest[b][a] = sorted[kReachPostures - 1 - tail];
    }
  }
  return reach;
}

GraspWorld::GraspWorld(const Scene& scene, const HandModel& hand,
                       const SurfacePointsConfig& surface)
    : scene_(scene),
      ik_(hand, scene_),
      object_(scene_.object().shape),
      environment_(scene_),
      surface_config_(surface),
      surface_(MakeSurfacePoints(scene_.object().shape, object_, surface)),
      reach_(MeasureTipReach(hand)) {
  PREGRASP_CHECK(scene_.object().movable());
  scene_.tips = hand.tip_spheres();
  object_radius_ = CalcRadiusAbout(surface_, scene_.object().mass_properties->p_BoBcm);
}

GraspContact GraspWorld::ContactNear(Finger finger, const Vector3& p_O) const {
  const FacePoint face = object_.ProjectToFace(p_O);
  return {finger, face.p_B, face.nhat_B};
}

std::vector<RigidTransform> GraspWorld::StartPoses() const {
  std::vector<RigidTransform> X_WB;
  for (const Body& body : scene_.bodies) X_WB.push_back(body.X_WB);
  return X_WB;
}

std::vector<WrenchContact> GraspWorld::ToWrenchContacts(
    const std::vector<GraspContact>& contacts) const {
  const Vector3& p_OOcm = scene_.object().mass_properties->p_BoBcm;
  std::vector<WrenchContact> wrench_contacts;
  wrench_contacts.reserve(contacts.size());
  for (const GraspContact& contact : contacts) {
    wrench_contacts.push_back({contact.p_OC - p_OOcm, -contact.nhat_O});
  }
  return wrench_contacts;
}

WrenchConfig GraspWorld::MakeWrenchConfig(double f_min, const Matrix3& R_WO) const {
  WrenchConfig config;
  config.mu = scene_.fingertips.friction;
  config.mass = scene_.object().mass_properties->mass;
  config.gravity = R_WO.transpose() * scene_.gravity;
  config.f_min = f_min;
  config.f_max = scene_.fingertips.max_force;
  config.torque_scale = object_radius_;
  return config;
}

IkProblem GraspWorld::ToIkProblem(const std::vector<GraspContact>& contacts,
                                  const std::vector<RigidTransform>& X_WB) const {
  IkProblem problem;
  problem.X_WB = X_WB;
  const RigidTransform& X_WO = X_WB.at(0);
  for (const GraspContact& contact : contacts) {
    problem.contacts.push_back(
        {contact.finger, X_WO * contact.p_OC, X_WO.linear() * contact.nhat_O});
  }
  return problem;
}

}  // namespace pregrasp
