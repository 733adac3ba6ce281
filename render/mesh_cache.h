#pragma once

#include <map>
#include <memory>
#include <optional>

#include "app/core/math.h"
#include "app/scene/shape.h"
#include "render/gl_objects.h"

namespace pregrasp {

/// What the shaders read for each thing drawn (attributes 2 to 6).
struct Instance {
  float rows[12];  ///< X_WB, possibly with scale, as three rows of four
  float color[4];  ///< linear light, opacity
  float roughness, metallic;
  float first_color;  ///< index of the first of its face colours, or -1
  float annotation;   ///< 1: takes no shadow and no occlusion
};

struct GpuSurface {
  GlVertexArray vao;
  GlBuffer vertices, indices;
  int index_count = 0;
};

struct GpuEdges {
  GlVertexArray vao;
  GlBuffer edges;
  int count = 0;
};

/// A mesh on the GPU side; its parts are made when first asked for.
struct GpuMesh {
  std::weak_ptr<const TriangleMesh> source;
  Eigen::AlignedBox3d bounds_B;
  bool closed = false;  ///< its inside is never seen
  std::optional<GpuSurface> smooth, flat;
  std::optional<GpuEdges> all_edges, creases;
};

/// Keeps meshes on the GPU side while their owners live. A pointer that comes again for another
/// mesh is told from the old one by its weak pointer.
class MeshCache {
 public:
  MeshCache();

  GpuMesh& Get(const std::shared_ptr<const TriangleMesh>& mesh);
  const GpuSurface& Surface(GpuMesh& entry, bool smooth);
  const GpuEdges& Edges(GpuMesh& entry, bool creases_only);
  /// Forgets meshes that nobody else holds.
  void DropDead();

  /// The buffer that all instances of a picture are written to.
  const GlBuffer& instances() const { return instances_; }
  std::size_t size() const { return meshes_.size(); }

 private:
  GlBuffer instances_;
  std::map<const TriangleMesh*, GpuMesh> meshes_;
};

}  // namespace pregrasp
