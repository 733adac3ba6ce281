#pragma once

#include "render/render_scene.h"

namespace pregrasp {

/// A box, triangulated, centred.
TriangleMesh BoxMesh(const Vector3& size);
/// A solid of revolution about z from a profile of (radius, z), bottom to top along the outside.
TriangleMesh RevolvedMesh(const std::vector<Vector2>& profile, int segments);
TriangleMesh BallMesh(double radius);

// Pictures of the kind the program makes, for tests, the benchmark and the eye.

/// A 30 cm ruler that a fingertip has dragged over a table's edge: force, cone, labels, card,
/// footer.
RenderScene RulerScene();
/// A book between books on a shelf with a back wall, and ghosts of where it goes.
RenderScene ShelfScene();
/// A plate on a table, with scores as the colours of its triangles.
RenderScene PlateScene();
/// Many small things: about 70,000 triangles.
RenderScene CrowdedScene();

}  // namespace pregrasp
