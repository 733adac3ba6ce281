#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/geometry/mend_mesh.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// Reads the files that a scene's Mesh and Cloud shapes name, relative to `directory`, through
/// assimp; checks that a mesh is closed, two-manifold and of positive volume (orienting it
/// outward), and reconstructs a closed mesh from a cloud. A mesh whose closed parts touch or
/// overlap becomes a union of meshes. Then fills in a movable body's centre of mass and inertia, of
/// uniform density, where the scene gave none: a centre of mass counts as given when it is not zero
/// or `com_given` is set, an inertia when it is not zero.
/// @throws InputError naming the body's file:line: missing file, unknown format, open mesh, NaN,
/// too few points.
void LoadShapes(Scene& scene, const std::filesystem::path& directory);

/// The same for one shape and its parts. `where` and `field` are those of the messages.
void LoadShape(Shape& shape, const std::filesystem::path& directory, const std::string& where,
               const std::string& field);

/// Makes a mesh as the rest of pregrasp needs it from triangles as they come: welds vertices,
/// leaves out walls between solids that share corners, takes solids apart that meet in an edge,
/// checks that it is closed, and turns it
/// outward; a component inside another is a cavity.
/// @param name  what messages call it, with its quotes: "\"cup.obj\"".
/// @param mending  where given, the mesh is mended (MendMesh), and this says how.
/// @return one mesh, or, where solids touch or overlap, those whose union it is (SeparateSolids).
/// @throws InputError
std::vector<TriangleMesh> RepairMesh(const TriangleMesh& raw, const std::string& name,
                                     const std::string& where, const std::string& field,
                                     Mending* mending = nullptr);

}  // namespace pregrasp
