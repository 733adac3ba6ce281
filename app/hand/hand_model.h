#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/core/math.h"
#include "app/scene/finger.h"

namespace pregrasp {

inline constexpr int kNumHandJoints = 22;
inline constexpr int kNumHandLinks = kNumHandJoints + 1;
/// Degrees of freedom of the free hand: p_WH, then a small rotation of R_WH about world axes, then
/// the joints.
inline constexpr int kNumHandDofs = 6 + kNumHandJoints;

/// Joint angles [rad] in the order of kHandJointNames.
using HandJoints = Eigen::Matrix<double, kNumHandJoints, 1>;
/// A vector or a gradient over the hand's degrees of freedom.
using HandVector = Eigen::Matrix<double, kNumHandDofs, 1>;
using HandMatrix = Eigen::Matrix<double, kNumHandDofs, kNumHandDofs>;

/// The vendor's joint names, palm to tip within a finger: the order of every joint vector.
inline constexpr std::array<const char*, kNumHandJoints> kHandJointNames{
    "FFJ4", "FFJ3", "FFJ2", "FFJ1", "MFJ4", "MFJ3", "MFJ2", "MFJ1", "RFJ4", "RFJ3", "RFJ2",
    "RFJ1", "LFJ5", "LFJ4", "LFJ3", "LFJ2", "LFJ1", "THJ5", "THJ4", "THJ3", "THJ2", "THJ1"};

/// First joint and number of joints of each finger (thumb, index, middle, ring, little).
inline constexpr std::array<std::pair<int, int>, kNumFingers> kFingerJoints{
    {{17, 5}, {0, 4}, {4, 4}, {8, 4}, {12, 5}}};

/// The link that carries a finger's tip.
inline constexpr int DistalLink(Finger finger) {
  const auto [first, count] = kFingerJoints[static_cast<int>(finger)];
  return first + count;
}

/// Where a hand is: the palm H in the world, and its joints.
struct HandConfiguration {
  RigidTransform X_WH = RigidTransform::Identity();
  HandJoints q = HandJoints::Zero();
};

/// A revolute joint. Joint j moves link j + 1; link 0 is the palm.
struct HandJoint {
  int parent = 0;       ///< link, below j + 1
  RigidTransform X_PJ;  ///< the child link's frame in the parent's at q = 0
  Vector3 axis;         ///< unit, in the child's frame
  double lower = 0.0, upper = 0.0;
  double max_speed = 0.0;   ///< [rad/s]
  double max_effort = 0.0;  ///< [N m]
};

struct HandLink {
  std::string name;
  double mass = 0.0;                  ///< [kg]
  Vector3 p_LoLcm = Vector3::Zero();  ///< centre of mass [m]
  Matrix3 I_LLcm = Matrix3::Zero();   ///< about the centre of mass [kg m^2]
};

/// All points within `radius` of the segment from A to B, fixed to a link; a sphere where A = B.
struct HandCapsule {
  std::string name;  ///< "palm/wrist"
  int link = 0;
  Vector3 p_LA = Vector3::Zero(), p_LB = Vector3::Zero();
  double radius = 0.0;
};

/// The sphere at a finger's end.
struct Fingertip {
  int link = 0;
  int capsule = 0;                   ///< whose B end it is
  Vector3 p_LT = Vector3::Zero();    ///< its centre
  double radius = 0.0;               ///< FingertipRadius of the finger
  Vector3 p_LTip = Vector3::Zero();  ///< the vendor's tip frame
};

/// One picture mesh of a link.
struct HandVisual {
  int link = 0;
  std::filesystem::path file;
  std::array<float, 4> rgba{};
};

/// A five-fingered hand as plain values: kinematic tree, limits, inertia and collision capsules.
/// Frames: +z along the finger to its tip, -y to the palmar side, +x to the thumb's side.
struct HandModel {
  std::string name;
  std::array<HandJoint, kNumHandJoints> joints;
  std::array<HandLink, kNumHandLinks> links;
  /// First joint of the chain that moves a link: joints chain_begin[l] .. l - 1 do, in this order.
  std::array<int, kNumHandLinks> chain_begin{};
  std::array<Fingertip, kNumFingers> tips;  ///< by Finger
  std::vector<HandCapsule> capsules;        ///< in link order
  /// Capsule pairs that can collide: on different links that no joint connects, directly or through
  /// links without a capsule.
  std::vector<std::pair<int, int>> self_pairs;
  std::vector<HandVisual> visuals;
  HandJoints q_lower, q_upper;

  const Fingertip& tip(Finger finger) const { return tips[static_cast<int>(finger)]; }
};

/// Reads a URDF of a hand with the joints of kHandJointNames. A collision cylinder must have, in
/// the same link and under the same name, the two spheres at its ends: the three are one capsule; a
/// sphere alone is a capsule of no length.
/// @throws InputError  a file that cannot be read, a missing joint, another chain of links, a
/// collision shape that is no capsule, a fingertip other than FingertipRadius says.
HandModel LoadHandModel(const std::filesystem::path& urdf_file);

/// The right Shadow Hand of assets/hand, read once.
const HandModel& ShadowHand();

/// A hand at ease: fingers slightly curled, thumb opposed. The posture of fingers without a task.
HandJoints RelaxedPosture();

}  // namespace pregrasp
