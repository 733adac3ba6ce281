#include "render/mesh_cache.h"

#include <cstddef>

#include "app/core/check.h"
#include "render/mesh_surface.h"

namespace pregrasp {
namespace {

GpuSurface UploadSurface(const ShadedSurface& surface, const GlBuffer& instances) {
  using Vertex = ShadedSurface::Vertex;
  constexpr std::size_t kRow = 4 * sizeof(float);
  GpuSurface gpu{MakeVertexArray(), MakeBuffer(), MakeBuffer(),
                 static_cast<int>(surface.indices.size())};
  gl.BindVertexArray(gpu.vao.get());
  Upload(gpu.vertices, GL_ARRAY_BUFFER, surface.vertices, GL_STATIC_DRAW);
  Upload(gpu.indices, GL_ELEMENT_ARRAY_BUFFER, surface.indices, GL_STATIC_DRAW);
  BindAttributes(0, gpu.vertices, sizeof(Vertex), false,
                 {{0, 3, offsetof(Vertex, p)}, {1, 3, offsetof(Vertex, n)}});
  BindAttributes(1, instances, sizeof(Instance), true,
                 {{2, 4, offsetof(Instance, rows)},
                  {3, 4, offsetof(Instance, rows) + kRow},
                  {4, 4, offsetof(Instance, rows) + 2 * kRow},
                  {5, 4, offsetof(Instance, color)},
                  {6, 4, offsetof(Instance, roughness)}});
  gl.BindVertexArray(0);
  return gpu;
}

GpuEdges UploadEdges(const std::vector<ShadedEdge>& edges) {
  GpuEdges gpu{MakeVertexArray(), MakeBuffer(), static_cast<int>(edges.size())};
  gl.BindVertexArray(gpu.vao.get());
  Upload(gpu.edges, GL_ARRAY_BUFFER, edges, GL_STATIC_DRAW);
  BindAttributes(0, gpu.edges, sizeof(ShadedEdge), true,
                 {{0, 3, offsetof(ShadedEdge, p)},
                  {1, 3, offsetof(ShadedEdge, q)},
                  {2, 3, offsetof(ShadedEdge, n)},
                  {3, 3, offsetof(ShadedEdge, m)}});
  gl.BindVertexArray(0);
  return gpu;
}

}  // namespace

MeshCache::MeshCache() : instances_(MakeBuffer()) {
  gl.BindBuffer(GL_ARRAY_BUFFER, instances_.get());  // makes the name a buffer
}

GpuMesh& MeshCache::Get(const std::shared_ptr<const TriangleMesh>& mesh) {
  PREGRASP_CHECK(mesh != nullptr);
  const auto found = meshes_.find(mesh.get());
  if (found != meshes_.end()) {
    if (found->second.source.lock() == mesh) return found->second;
    meshes_.erase(found);
  }
  GpuMesh& entry = meshes_[mesh.get()];
  entry.source = mesh;
  entry.closed = IsClosedMesh(*mesh);
  for (Eigen::Index i = 0; i < mesh->V.rows(); ++i) {
    entry.bounds_B.extend(Vector3(mesh->V.row(i)));
  }
  return entry;
}

const GpuSurface& MeshCache::Surface(GpuMesh& entry, bool smooth) {
  std::optional<GpuSurface>& surface = smooth ? entry.smooth : entry.flat;
  if (!surface) {
    const auto mesh = entry.source.lock();
    surface = UploadSurface(BuildShadedSurface(*mesh, smooth), instances_);
  }
  return *surface;
}

const GpuEdges& MeshCache::Edges(GpuMesh& entry, bool creases_only) {
  std::optional<GpuEdges>& edges = creases_only ? entry.creases : entry.all_edges;
  if (!edges) edges = UploadEdges(BuildShadedEdges(*entry.source.lock(), creases_only));
  return *edges;
}

void MeshCache::DropDead() {
  for (auto it = meshes_.begin(); it != meshes_.end();) {
    it = it->second.source.expired() ? meshes_.erase(it) : std::next(it);
  }
}

}  // namespace pregrasp
