#pragma once

#include <vector>

#include "app/geometry/signed_distance.h"
#include "app/scene/shape.h"

namespace pregrasp {

struct SurfacePointsConfig {
  /// No point of a flat face is farther than this from a sample [m].
  double spacing = 2e-3;
  /// The spacing is raised until about so many points do.
  int max_points = 20000;

  void Validate() const;
};

/// Points spread densely over an object's outer surface, with outward unit normals, in its frame O
/// (#points x 3). Edges and corners, which have no normal, are left out.
struct SurfacePoints {
  MatrixX3 P;
  MatrixX3 N;
  double spacing = 0.0;  ///< [m], as made
};

/// The same points for the same shape: a grid over each triangle of its tessellation, the middle of
/// each cell projected to the true surface; what lies inside another part of a union is left out.
SurfacePoints MakeSurfacePoints(const Shape& shape, const SignedDistance& distance,
                                const SurfacePointsConfig& config);

/// How far a fingertip sphere that touches a point may still overlap, each in [m].
struct TouchSlack {
  double object = 0.0;
  double environment = 0.0;
};

/// Whether a fingertip sphere of `radius` that touches p_O from outside (normal nhat_O) overlaps
/// neither the object nor the environment by more than `slack`.
/// @param X_WB  one pose per scene body, the object first.
bool CanTouch(const Vector3& p_O, const Vector3& nhat_O, double radius, const TouchSlack& slack,
              const SignedDistance& object, const EnvironmentDistance& environment,
              const std::vector<RigidTransform>& X_WB);

/// The largest distance of a surface point from p_O: the radius by which torques are divided when
/// p_O is the centre of mass.
double CalcRadiusAbout(const SurfacePoints& points, const Vector3& p_O);

}  // namespace pregrasp
