#pragma once

#include <cstddef>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/geometry/distance_bounds.h"
#include "app/geometry/hull.h"
#include "app/geometry/mesh_cut.h"

namespace pregrasp {

/// One or, after joining, several parts of a solid, with their joint hull.
struct Piece {
  std::vector<SolidPart> parts;
  TriangleMesh hull;
  AlignedBox bounds;
  double volume = 0.0;      ///< of the hull [m^3]
  double protrusion = 0.0;  ///< of the hull outside the solid [m]
  bool whole = false;       ///< no plane cuts it well
};

/// Makes pieces of one solid: closes their hulls, cuts and joins them.
class PieceMaker {
 public:
  /// `config` must outlive this.
  PieceMaker(const TriangleMesh& mesh, const DecomposeConfig& config);

  /// The whole solid.
  Piece MakeWhole() const;

  /// What of `piece` lies below `plane`, without its hull; no parts where there is nothing.
  Piece CutBelow(const Piece& piece, const Plane& plane) const;

  /// Fills in hull, bounds and volume from the parts; false for a piece without volume. The hull is
  /// finer than the configuration asks for, so that joining again and again loses little.
  bool Close(Piece& piece) const;

  /// The same by an even share of the triangles and coarser, to compare cuts by.
  bool CloseRoughly(Piece& piece) const;

  /// Closes the piece as the configuration asks for.
  void Finish(Piece& piece) const;

  /// Fills in how far the hull reaches outside the solid, by `finer` times the usual points.
  void Measure(Piece& piece, int finer = 1) const;

  /// The pieces `members` as one, measured by `finer` times the usual points but without parts;
  /// false when they have no volume.
  bool Join(const std::vector<const Piece*>& members, Piece& joined, int finer = 1) const;

  /// The same coarser: reaches no farther outside.
  bool JoinRoughly(const std::vector<const Piece*>& members, Piece& joined) const;

  const MeshDistance& distance() const { return distance_; }
  const DistanceBounds& roughly() const { return roughly_; }
  double size() const { return size_; }  ///< the solid's diagonal [m]
  double snap() const;                   ///< corners this near to a cut count as on it [m]

 private:
  bool CloseAround(const MatrixX3& P, double tolerance, Piece& piece) const;
  MatrixX3 GatherPoints(const Piece& piece, std::size_t most) const;

  const TriangleMesh& mesh_;
  const DecomposeConfig& config_;
  MeshDistance distance_;
  DistanceBounds roughly_;
  double size_;
};

}  // namespace pregrasp
