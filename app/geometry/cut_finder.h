#pragma once

#include <vector>

#include "app/core/rng.h"
#include "app/geometry/distance_bounds.h"
#include "app/geometry/mesh_cut.h"

namespace pregrasp {

/// A plane to cut along, and how much is wrong with it.
struct Cut {
  Plane plane;
  double energy = 0.0;  ///< sum over pairs of points that it leaves on the same side [m^2]
};

/// Looks for planes that part a solid into pieces nearer to convex: those that separate most of the
/// pairs of surface points that do not see each other through the solid.
class CutFinder {
 public:
  /// @param mesh, roughly  of the whole solid; must outlive this. `size` [m] is its diagonal.
  CutFinder(const TriangleMesh& mesh, const DistanceBounds& roughly, double size)
      : mesh_(mesh), roughly_(roughly), size_(size) {}

  /// Lets Find consider planes along the faces at edges where the surface turns inward: natural
  /// cuts, as at the foot of a wall.
  void FindReflexPlanes();

  /// Cuts of a piece made of `parts`, those with the least energy first.
  std::vector<Cut> Find(const std::vector<SolidPart>& parts) const;

 private:
  struct Pair {  // of surface samples, and how far the line between them leaves the solid, squared
    int i, j;
    double energy;
  };

  void AddReflexPlane(const Plane& plane);
  std::vector<Pair> FindPairs(const MatrixX3& P, Rng& rng) const;
  std::vector<Plane> ListPlanes(const MatrixX3& P) const;

  const TriangleMesh& mesh_;
  const DistanceBounds& roughly_;
  double size_;
  std::vector<Plane> reflex_planes_;
};

}  // namespace pregrasp
