#pragma once

#include <array>
#include <vector>

#include "app/core/math.h"
#include "render/camera.h"
#include "render/mesh_cache.h"
#include "render/render_scene.h"

namespace pregrasp {

/// One draw call: instances [first, first + count) of a surface.
struct Draw {
  const GpuSurface* surface = nullptr;
  bool closed = false;  ///< its back faces need not be drawn
  int first = 0, count = 1;
  double distance = 0.0;  ///< of its centre along the view [m], for sorting
  Rgba color;
  std::array<float, 4> material{};  ///< as Instance from roughness on
  std::array<float, 16> X_WB{};     ///< for its edges; column-major
  const GpuEdges* all_edges = nullptr;
  const GpuEdges* creases = nullptr;
  bool outline = false;  ///< of a ghost: its edges have its own colour
};

/// A piece of a line as line_vert.glsl reads it.
struct LinePiece {
  float p[3], q[3], color[4], width;
};

/// A scene taken apart into what the passes draw.
struct FrameContent {
  std::vector<Instance> instances;
  std::vector<std::array<float, 4>> face_colors;
  std::vector<Draw> solids;       ///< nearest first
  std::vector<Draw> annotations;  ///< arrows, points and axes
  std::vector<Draw> arrows;       ///< the part of the annotations that shines through bodies
  std::vector<Draw> ghosts;       ///< farthest first
  std::vector<Draw> cones;        ///< farthest first
  std::vector<LinePiece> lines;
  std::vector<Eigen::AlignedBox3d> solid_bounds_W;
};

/// Meshes of annotations, shared by all pictures.
struct AnnotationMeshes {
  AnnotationMeshes();
  std::shared_ptr<const TriangleMesh> shaft, head, cone;
  std::vector<std::shared_ptr<const TriangleMesh>> balls;  ///< coarse to fine
};

/// @throws InputError for numbers that are not finite, or face colours that do not match the faces.
FrameContent CollectContent(const RenderScene& scene, const CameraView& view,
                            const AnnotationMeshes& meshes, MeshCache& cache);

}  // namespace pregrasp
