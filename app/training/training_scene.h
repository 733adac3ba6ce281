#pragma once

#include <string>
#include <vector>

#include "app/core/rng.h"
#include "app/scene/scene.h"
#include "app/training/object_families.h"

namespace pregrasp {

/// A way a body can lie on level ground.
struct RestingPose {
  Matrix3 R_WO = Matrix3::Identity();
  /// Share of the directions from the centre of mass that the face it lies on takes up: how often a
  /// tumbled body comes to rest so.
  double share = 0.0;
};

/// The faces of the hull above which the centre of mass lies, facing down; shares sum to 1.
std::vector<RestingPose> FindRestingPoses(const MatrixX3& surface_O, const Vector3& p_OOcm);

/// An object with what its scenes need, computed once.
struct SceneObject {
  TrainingObject object;
  MassProperties mass;
  MatrixX3 surface;  ///< vertices of its tessellation, in O
  std::vector<RestingPose> resting;
};
SceneObject MakeSceneObject(TrainingObject object);

/// An object among surroundings, to learn in: not necessarily at rest, as it is not while a finger
/// holds it.
struct TrainingScene {
  /// "free", or the surface it lies on ("table", "edge") followed by what else there is: "tilted",
  /// "raised", "wall", "neighbours", "ceiling".
  std::string kind;
  Scene scene;
};

/// Draws a scene: a resting pose, turned at random; a table, whole or with its edge under the
/// object; walls, neighbours or a shelf above at gaps from nothing to some centimetres; sometimes
/// tilted about a level axis by up to 45 degrees or raised by up to 4 cm; one in eight without
/// surroundings and in any orientation.
TrainingScene SampleTrainingScene(const SceneObject& object, Rng rng);

/// Draws the start of a motion: the object at rest on a table, whole or with its edge near or under
/// the object, and more often than not in tight surroundings: walls, neighbours, a compartment
/// whose walls stand on three or four sides ("pen"), a shelf above. One in twelve without
/// surroundings, as it rests.
TrainingScene SampleRestingScene(const SceneObject& object, Rng rng);

/// Every body's pose with the surroundings moved away from the object by `relief` [m], each body
/// against its own direction to the object at their nearest points. Another part of the body that
/// is nearly as near, off that direction, is then nearer than `relief` more than it was.
/// @param P_O  points of the object's surface.
std::vector<RigidTransform> MoveSurroundingsAway(const Scene& scene, const MatrixX3& P_O,
                                                 double relief);

}  // namespace pregrasp
