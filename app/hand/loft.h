#pragma once

#include <vector>

#include "app/scene/shape.h"

namespace pregrasp {

// Closed solids for pictures, from sections and profiles. Dimensions are in millimetres, meshes in
// metres.

/// A section across z, about (x, y), in millimetres: a superellipse |x/rx|^n + |y/ry|^n = 1; with
/// n = 0 a flat oval, two half circles joined by straight lines, like a row of capsules.
struct Section {
  double z, x, y, rx, ry, n;
};

/// A skin over sections of increasing z whose ends are rounded by `low` and `high`.
TriangleMesh Loft(const std::vector<Section>& sections, double low, double high);

/// A drum along x of half length `half`, its rims rounded.
TriangleMesh Drum(double half, double radius, double rim);

TriangleMesh Ball(double radius);

/// Two flat ears in y-z planes, from x = inner to outer on either side: each a disc about z with a
/// neck to z_foot, which may lie above or below.
TriangleMesh Fork(double inner, double outer, double z, double radius, double z_foot);

/// Side by side in one mesh.
TriangleMesh Merge(const std::vector<TriangleMesh>& parts);

TriangleMesh Placed(TriangleMesh mesh, const RigidTransform& X);

}  // namespace pregrasp
