#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/core/math.h"
#include "app/scene/finger.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What a hand's vectors are sized for, so that nothing is allocated where it moves. A hand with
/// fewer joints uses the first of them; those that are left stay at zero, where both their limits
/// are.
inline constexpr int kMaxHandJoints = 22;
inline constexpr int kMaxHandLinks = kMaxHandJoints + 1;
/// Degrees of freedom of the free hand: p_WH, then a small rotation of R_WH about world axes, then
/// the joints.
inline constexpr int kMaxHandDofs = 6 + kMaxHandJoints;
inline constexpr int kMaxHandCapsules = 32;

/// Joint angles [rad] in the order of HandModel::joints.
using HandJoints = Eigen::Matrix<double, kMaxHandJoints, 1>;
/// A vector or a gradient over the hand's degrees of freedom.
using HandVector = Eigen::Matrix<double, kMaxHandDofs, 1>;
using HandMatrix = Eigen::Matrix<double, kMaxHandDofs, kMaxHandDofs>;

/// Where a hand is: the palm H in the world, and its joints.
struct HandConfiguration {
  RigidTransform X_WH = RigidTransform::Identity();
  HandJoints q = HandJoints::Zero();
};

/// A revolute joint. Joint j moves link j + 1; link 0 is the palm.
struct HandJoint {
  std::string name;  ///< its column in motion.csv
  int parent = 0;    ///< link, below j + 1
  RigidTransform X_PJ =
      RigidTransform::Identity();   ///< the child link's frame in the parent's at q = 0
  Vector3 axis = Vector3::UnitZ();  ///< unit, in the child's frame
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
  int link = 0;                    ///< that carries it: the finger's last
  int capsule = 0;                 ///< one of whose ends it is
  Vector3 p_LT = Vector3::Zero();  ///< its centre
  double radius = 0.0;
};

/// Joints first .. first + count - 1 of a hand, palm to tip.
struct FingerJoints {
  int first = 0, count = 0;
};

/// What to draw of a link: a mesh file's triangles or a primitive, at X_LV in the link's frame.
struct HandVisual {
  int link = 0;
  RigidTransform X_LV = RigidTransform::Identity();
  Shape shape;  ///< a Mesh is named and not loaded
  Vector3 scale = Vector3::Ones();
  std::array<float, 4> rgba{};
};

/// The forearm that the hand would have behind it, which its links leave out: a capsule about the
/// palm's -z.
struct HandForearm {
  double radius = 0.015;             ///< [m]
  double begin = 0.032, end = 0.20;  ///< behind the palm's origin [m]
};

/// A hand of two to five fingers, one of them a thumb, as plain values: kinematic tree, limits,
/// inertia and collision capsules. The palm's frame and those of the fingers' last links have +z
/// along the finger to its tip and -y to the palmar side. Joints are those of the fingers from the
/// index on, then the thumb's, palm to tip within a finger.
struct HandModel {
  std::string name;
  std::filesystem::path file;                ///< the description it was read from
  std::vector<std::filesystem::path> files;  ///< that, the URDF and the meshes
  std::string sha256;                        ///< of that file and its URDF
  int num_joints = 0;
  int num_links() const { return num_joints + 1; }
  std::array<HandJoint, kMaxHandJoints> joints;
  std::array<HandLink, kMaxHandLinks> links;
  /// First joint of the chain that moves a link: joints chain_begin[l] .. l - 1 do, in this order.
  std::array<int, kMaxHandLinks> chain_begin{};
  int num_fingers = 0;
  std::array<FingerJoints, kNumFingers> fingers;  ///< by Finger
  std::array<Fingertip, kNumFingers> tips;        ///< by Finger
  std::vector<HandCapsule> capsules;              ///< in link order
  /// Capsule pairs that can collide: on different links that no joint connects, directly or through
  /// links without a capsule, and that the description does not let touch.
  std::vector<std::pair<int, int>> self_pairs;
  std::vector<HandVisual> visuals;
  HandJoints q_lower = HandJoints::Zero(), q_upper = HandJoints::Zero();
  /// At ease: fingers slightly curled, thumb opposed. The posture of fingers without a task.
  HandJoints posture = HandJoints::Zero();
  HandForearm forearm;
  /// The finger whose last link it is.
  std::optional<Finger> FingerOf(int link) const;

  const Fingertip& tip(Finger finger) const { return tips[static_cast<int>(finger)]; }
  TipSpheres tip_spheres() const;
};

/// Whether it is a file that is named, and not a hand below assets/hands.
bool IsHandFile(const std::string& name_or_file);

/// A hand by its name, the folder below assets/hands that holds its hand.lua, or by the path of
/// such a file (hand_file.h). Read once in a process, and kept.
/// @throws InputError  the first of the faults that keep it from being a hand.
const HandModel& FindHand(const std::string& name_or_file);

/// The right Shadow Hand of assets/hands.
const HandModel& ShadowHand();

/// The scene's hand (Scene::hand).
const HandModel& HandOf(const Scene& scene);

/// Gives the scene the hand that it names: its fingertips.
/// @throws InputError as FindHand.
void TakeHand(Scene& scene);

}  // namespace pregrasp
