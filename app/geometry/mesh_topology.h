#pragma once

#include <array>
#include <utility>
#include <vector>

#include "app/geometry/bounds.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// For each face the face across its edge i, from F(f, i) to F(f, i + 1); -1 where there is none or
/// more than one. #F entries.
std::vector<std::array<int, 3>> FindNeighbours(const TriangleMesh& mesh);

/// Each face's outward unit normal; a face without area borrows that of the neighbour across its
/// longest edge, and has none (zero) only among others without area. #F entries.
/// @param neighbours  FindNeighbours of the same mesh.
std::vector<Vector3> CalcFaceNormals(const TriangleMesh& mesh,
                                     const std::vector<std::array<int, 3>>& neighbours);

/// What keeps a mesh from being a closed two-manifold.
struct MeshDefects {
  int open_edges = 0;      ///< edges with one triangle
  int crowded_edges = 0;   ///< edges with more than two triangles
  int repeated_faces = 0;  ///< faces with the corners of an earlier one, turned round or not
  int turned_edges = 0;    ///< edges whose two triangles run along them the same way

  bool closed() const { return open_edges == 0 && crowded_edges == 0 && turned_edges == 0; }
};
MeshDefects FindDefects(const TriangleMesh& mesh);

/// The corners of each open edge.
std::vector<std::pair<int, int>> FindOpenEdges(const TriangleMesh& mesh);

/// Open edges that hang together.
struct Hole {
  int edges = 0;
  AlignedBox bounds;  ///< of their ends
};
/// Those of most edges first.
std::vector<Hole> FindHoles(const TriangleMesh& mesh);

/// Merges vertices that lie within `tolerance` [m] of one another (the one with the smallest index
/// stays, 0 merges equal ones), and drops faces that lose a corner and vertices without a face.
TriangleMesh WeldVertices(const TriangleMesh& mesh, double tolerance);

/// The faces that `keep` is true for, with the vertices that they use.
TriangleMesh TakeFaces(const TriangleMesh& mesh, const std::vector<bool>& keep);

/// The faces of each of `count` parts, with the vertices that they use.
/// @param part_of  of each face, 0 to count - 1.
std::vector<TriangleMesh> SplitFaces(const TriangleMesh& mesh, const std::vector<int>& part_of,
                                     int count);

/// The faces whose corners no other face has, in any order.
TriangleMesh TakeSingleFaces(const TriangleMesh& mesh);

/// Component (through shared edges) of each face, numbered in the order of their first face.
std::vector<int> LabelComponents(const TriangleMesh& mesh);

/// Turns faces so that neighbours agree, each component as most of its faces are now. Needs a mesh
/// without open or crowded edges. Returns false for a surface with one side only.
bool OrientConsistently(TriangleMesh& mesh);

/// Gives each fan of faces around a vertex a vertex of its own, where several meet in one.
void SplitPinchedVertices(TriangleMesh& mesh);

/// Signed volume, positive when faces are outward [m^3].
double CalcVolume(const TriangleMesh& mesh);
double CalcArea(const TriangleMesh& mesh);

/// Vertices minus edges plus faces: 2 for a ball, 0 for a ring; closed meshes only.
int CalcEulerNumber(const TriangleMesh& mesh);

/// How often the surface winds around p: about 1 inside, 0 outside (generalised winding number).
double CalcWindingNumber(const TriangleMesh& mesh, const Vector3& p);

/// Moves every vertex by X_AB.
TriangleMesh Transformed(const TriangleMesh& mesh, const RigidTransform& X_AB);

/// Adds `other` as a component of its own.
void AppendMesh(TriangleMesh& mesh, const TriangleMesh& other);

}  // namespace pregrasp
