#include "render/mesh_cache.h"

#include <cstddef>

#include "app/core/check.h"
#include "render/mesh_surface.h"

namespace pregrasp {
namespace {

void BindFloats(GLuint slot, int count, std::size_t stride, std::size_t offset, GLuint divisor) {
  gl.EnableVertexAttribArray(slot);
  gl.VertexAttribPointer(slot, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                         reinterpret_cast<const void*>(offset));
  gl.VertexAttribDivisor(slot, divisor);
}

void BindInstances(const GlBuffer& instances) {
  gl.BindBuffer(GL_ARRAY_BUFFER, instances.get());
  for (GLuint row = 0; row < 3; ++row) {
    BindFloats(2 + row, 4, sizeof(Instance), row * 4 * sizeof(float), 1);
  }
  BindFloats(5, 4, sizeof(Instance), offsetof(Instance, color), 1);
  BindFloats(6, 4, sizeof(Instance), offsetof(Instance, roughness), 1);
}

GpuSurface UploadSurface(const ShadedSurface& surface, const GlBuffer& instances) {
  using Vertex = ShadedSurface::Vertex;
  GpuSurface gpu{MakeVertexArray(), MakeBuffer(), MakeBuffer(),
                 static_cast<int>(surface.indices.size())};
  gl.BindVertexArray(gpu.vao.get());
  Upload(gpu.vertices, GL_ARRAY_BUFFER, surface.vertices, GL_STATIC_DRAW);
  BindFloats(0, 3, sizeof(Vertex), offsetof(Vertex, p), 0);
  BindFloats(1, 3, sizeof(Vertex), offsetof(Vertex, n), 0);
  BindInstances(instances);
  Upload(gpu.indices, GL_ELEMENT_ARRAY_BUFFER, surface.indices, GL_STATIC_DRAW);
  gl.BindVertexArray(0);
  return gpu;
}

GpuEdges UploadEdges(const std::vector<ShadedEdge>& edges) {
  GpuEdges gpu{MakeVertexArray(), MakeBuffer(), static_cast<int>(edges.size())};
  gl.BindVertexArray(gpu.vao.get());
  Upload(gpu.edges, GL_ARRAY_BUFFER, edges, GL_STATIC_DRAW);
  for (GLuint slot = 0; slot < 4; ++slot) {
    BindFloats(slot, 3, sizeof(ShadedEdge), slot * 3 * sizeof(float), 1);
  }
  gl.BindVertexArray(0);
  return gpu;
}

}  // namespace

MeshCache::MeshCache() : instances_(MakeBuffer()) {}

GpuMesh& MeshCache::Get(const std::shared_ptr<const TriangleMesh>& mesh) {
  PREGRASP_CHECK(mesh != nullptr);
  const auto found = meshes_.find(mesh.get());
  if (found != meshes_.end()) {
    if (found->second.source.lock() == mesh) return found->second;
    meshes_.erase(found);
  }
  GpuMesh& entry = meshes_[mesh.get()];
  entry.source = mesh;
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
