#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/finger.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Mass, centre of mass and inertia of a body, all in its own frame B.
struct MassProperties {
  double mass = 0.0;                  ///< [kg]
  Vector3 p_BoBcm = Vector3::Zero();  ///< centre of mass [m]
  Matrix3 I_BBcm = Matrix3::Zero();   ///< about the centre of mass, in B's axes [kg m^2]
};

/// A rigid body: the object, a fixed part of the environment, or a movable neighbour.
struct Body {
  std::string name;
  Shape shape;
  RigidTransform X_WB = RigidTransform::Identity();  ///< at the start
  double friction = 0.4;                             ///< a pair of bodies uses the smaller
  /// Present if and only if the body moves. Uniform density unless the scene gives a centre of mass
  /// or an inertia.
  std::optional<MassProperties> mass_properties;
  bool com_given = false;  ///< the scene named p_BoBcm, so that zero means the frame's origin
  std::string where;       ///< file:line that defines it, for messages

  bool movable() const { return mass_properties.has_value(); }
};

/// What the fingers are, to the physics: point springs with a friction cone (see docs of
/// app/dynamics).
struct FingertipConfig {
  double friction = 0.8;    ///< coefficient between a fingertip and any body
  double max_force = 12.0;  ///< cap on |f| [N]
  double stiffness = 50.0;  ///< k of f = -k (p - p_target) while pushing [N/m], the paper's value
  /// Damping as a multiple of sqrt(k m): b = damping * sqrt(k * object mass) (findings: .7 is
  /// needed for light objects).
  double damping = 0.7;
  /// k while a grasp closes and lifts [N/m], with the same damping ratio: a position-controlled
  /// finger's. The Shadow Hand of MuJoCo Menagerie (shadow_hand/right_hand.xml) has position gains
  /// of 1 N m/rad at knuckle and proximal joint; at the levers of 4 to 10 cm that a bent and a
  /// straight finger have, that is 100 to 600 N/m at the tip.
  double grasp_stiffness = 300.0;
};

/// A camera that a scene may fix; otherwise the picture is framed automatically.
struct CameraConfig {
  Vector3 p_WCam = Vector3::Zero();
  Vector3 p_WTarget = Vector3::Zero();
  double fov_deg = 35.0;  ///< vertical field of view
};

/// What the hand of scenes that name none is called.
inline constexpr char kDefaultHand[] = "shadow_right";

/// Everything in the world at the start, as plain values. Body 0 is the object; the environment
/// follows in file order.
struct Scene {
  std::string name;
  std::vector<Body> bodies;
  FingertipConfig fingertips;
  std::string hand = kDefaultHand;   ///< a name below assets/hands, or a file (hand_model.h)
  TipSpheres tips;                   ///< that hand's
  Vector3 gravity{0.0, 0.0, -9.81};  ///< [m/s^2]
  std::optional<CameraConfig> camera;
  std::string file;   ///< the scene file, as given; empty for a scene built in a script
  std::string where;  ///< file:line of the scene, for messages; may be empty

  const Body& object() const { return bodies.at(0); }
  Body& object() { return bodies.at(0); }
  double object_weight() const { return object().mass_properties->mass * gravity.norm(); }
};

/// Checks what can be checked without geometry: names (present, unique, [A-Za-z0-9_-]+), sizes,
/// masses, inertias a rigid body can have, friction, finite numbers within reason, rotations, the
/// camera, an object with mass, at least one body of environment.
/// @throws InputError that names the first offending field and, where known, its file and line.
void ValidateScene(const Scene& scene);

/// Where a scene departs from the project's physical rules (fingertip friction above 1, environment
/// friction outside 0.2 to 0.6, gravity other than 9.81, fingertip force above 15 N, a grasp's
/// stiffness outside 150 to 600 N/m), one sentence each; empty means within the rules.
std::vector<std::string> RuleDepartures(const Scene& scene);

}  // namespace pregrasp
