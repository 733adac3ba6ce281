#include <algorithm>
#include <array>
#include <limits>

#include "app/hand/ik_terms.h"

namespace pregrasp::internal {
namespace {

// A direction counts like a second point this far from the tip [m]: about a finger's thickness.
constexpr double kDirectionArm = 0.02;
// The direction, in the distal frame, that should meet the surface: between tip and pad.
const Vector3 kTouchDirection = Vector3(0.0, -0.5, 1.0).normalized();

// How far from a warm start its perturbations are.
constexpr double kNearPosition = 0.03;  // [m]
constexpr double kNearAngle = 0.3;      // [rad]

HandJoints SamplePosture(const IkTerms& terms, Rng& rng) {
  HandJoints q = terms.reference.q;
  for (int f = 0; f < terms.hand.num_fingers; ++f) {
    if (!terms.touch.touching[f]) continue;
    const auto [first, count] = terms.hand.fingers[f];
    for (int j = first; j < first + count; ++j) {
      q[j] = rng.Uniform(terms.hand.q_lower[j], terms.hand.q_upper[j]);
    }
  }
  return q;
}

// The palm's pose that brings the posture's tips and touch directions nearest to the contacts.
// Where they leave a freedom (one contact, or two along one line), `tie` decides.
RigidTransform AlignPalm(const IkTerms& terms, const HandPose& pose_H, const Matrix3& tie) {
  std::array<Vector3, kNumFingers> p_HT;
  Vector3 mean_H = Vector3::Zero();
  Vector3 mean_W = Vector3::Zero();
  for (int i = 0; i < terms.num_contacts; ++i) {
    p_HT[i] = pose_H.CalcPoint(terms.contacts[i].link, terms.contacts[i].p_LT);
    mean_H += p_HT[i] / terms.num_contacts;
    mean_W += terms.contacts[i].p_WTarget / terms.num_contacts;
  }
  Matrix3 C = 1e-6 * kDirectionArm * kDirectionArm * tie;
  for (int i = 0; i < terms.num_contacts; ++i) {
    const Vector3 touch_H = pose_H.R_WL[terms.contacts[i].link] * kTouchDirection;
    C += (terms.contacts[i].p_WTarget - mean_W) * (p_HT[i] - mean_H).transpose() -
         kDirectionArm * kDirectionArm * terms.contacts[i].nhat_W * touch_H.transpose();
  }
  const Eigen::JacobiSVD<Matrix3> svd(C, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) = -U.col(2);
  const Matrix3 R_WH = U * svd.matrixV().transpose();
  return MakeTransform(R_WH, mean_W - R_WH * mean_H);
}

}  // namespace

HandConfiguration SampleNear(const HandModel& hand, const HandConfiguration& centre, Rng& rng) {
  HandVector step;
  for (int i = 0; i < 3; ++i) step[i] = rng.Uniform(-kNearPosition, kNearPosition);
  for (int i = 3; i < kMaxHandDofs; ++i) step[i] = rng.Uniform(-kNearAngle, kNearAngle);
  HandConfiguration near = Advance(centre, step);
  near.q = near.q.cwiseMax(hand.q_lower).cwiseMin(hand.q_upper);
  return near;
}

HandConfiguration SampleStart(const IkTerms& terms, Rng& rng, IkPoint* scratch) {
  if (terms.num_contacts == 0) return SampleNear(terms.hand, terms.reference, rng);
  HandConfiguration best;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < terms.config.start_candidates; ++i) {
    scratch->configuration.q = SamplePosture(terms, rng);
    const Matrix3 tie = rng.Rotation().toRotationMatrix();
    CalcHandPose(terms.hand, RigidTransform::Identity(), scratch->configuration.q, &scratch->pose);
    scratch->configuration.X_WH = AlignPalm(terms, scratch->pose, tie);
    if (CalcContactCost(terms, scratch) >= least) continue;
    CalcDistances(terms, LeastSquaresInfluence(terms), scratch);
    if (scratch->cost >= least) continue;
    least = scratch->cost;
    best = scratch->configuration;
  }
  return best;
}

}  // namespace pregrasp::internal
