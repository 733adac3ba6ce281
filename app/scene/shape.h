#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/core/math.h"

namespace pregrasp {

/// A triangle mesh as plain numbers: V vertices (#V x 3) [m] and F faces (#F x 3), outward by the
/// right-hand rule.
struct TriangleMesh {
  MatrixX3 V;
  MatrixX3i F;
};

// Shapes in their own frame B, centred, SI units.

/// An axis-aligned box with full edge lengths `size` [m].
struct Box {
  Vector3 size = Vector3::Zero();
};

/// A cylinder about z from -height/2 to height/2 [m].
struct Cylinder {
  double radius = 0.0;
  double height = 0.0;
};

/// A capsule about z; `height` is that of the cylindrical part, without the caps [m].
struct Capsule {
  double radius = 0.0;
  double height = 0.0;
};

struct Sphere {
  double radius = 0.0;
};

/// A closed triangle mesh read from `file`, scaled, in the file's own frame.
struct Mesh {
  std::string file;  ///< as the user wrote it
  double scale = 1.0;
  TriangleMesh mesh;     ///< what it holds: outward, closed, already scaled; filled in by LoadShape
  bool repair = false;   ///< whether what the file has wrong may be mended (MendMesh)
  std::string repaired;  ///< what was; filled in by LoadShape
};

/// A surface given by points only; pregrasp reconstructs a closed mesh from them.
struct Cloud {
  std::string file;  ///< as the user wrote it
  double scale = 1.0;
  MatrixX3 points;    ///< as read, scaled [m]
  TriangleMesh mesh;  ///< the reconstruction; filled in by LoadShape
};

struct PlacedShape;

/// Several shapes, rigidly placed in one frame; they may overlap.
struct Union {
  std::vector<PlacedShape> parts;
};

using Shape = std::variant<Box, Cylinder, Capsule, Sphere, Mesh, Cloud, Union>;

/// One part of a Union: X_BP places the part's frame P in the body's.
struct PlacedShape {
  Shape shape;
  RigidTransform X_BP = RigidTransform::Identity();
};

/// "box", "cylinder", "capsule", "sphere", "mesh", "cloud" or "union": the constructor's name in a
/// scene file.
const char* ShapeKind(const Shape& shape);

}  // namespace pregrasp
