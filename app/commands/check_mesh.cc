#include "app/commands/check_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include "app/core/error.h"
#include "app/geometry/bounds.h"
#include "app/geometry/load_shape.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/read_mesh.h"
#include "app/geometry/tessellate.h"
#include "render/palette.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kHolesNamed = 6;  // in the picture, the largest

// The file's triangles with their corners welded, mended if that is asked for: what its holes are
// looked for in.
TriangleMesh ReadWelded(const MeshCheck& check) {
  TriangleMesh mesh;
  try {
    mesh = ReadTriangles(check.file);
  } catch (const UnreadableFile& error) {
    throw InputError(check.file, "", error.expected, error.got);
  }
  mesh.V *= check.scale;
  if (!mesh.V.allFinite() || mesh.F.rows() == 0) return {};
  const double size = (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).norm();
  mesh = WeldVertices(mesh, 1e-6 * size);
  if (check.repair && mesh.F.rows() > 0) MendMesh(mesh);
  return mesh;
}

RenderScene ComposeHoles(const std::string& title, const TriangleMesh& mesh, double aspect) {
  const Vector3 low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
  RenderScene picture;
  RenderBody body;
  body.mesh = std::make_shared<TriangleMesh>(mesh);
  picture.bodies.push_back(WithLook(body, ObjectColor()));
  for (const auto& [a, b] : FindOpenEdges(mesh)) {
    picture.lines.push_back({{mesh.V.row(a), mesh.V.row(b)}, BadColor(), 4.0F});
  }
  const std::vector<Hole> holes = picture.lines.empty() ? std::vector<Hole>() : FindHoles(mesh);
  for (std::size_t i = 0; i < holes.size() && i < kHolesNamed; ++i) {
    picture.labels.push_back({holes[i].bounds.center(),
                              fmt::format("{} open edges, {:.3g} mm across", holes[i].edges,
                                          1e3 * holes[i].bounds.sizes().maxCoeff()),
                              BadColor()});
  }
  // From the largest hole's side, and from above.
  Vector3 view = Vector3(0.6, -0.8, 0.6).normalized();
  if (!holes.empty()) {
    const Vector3 out = holes[0].bounds.center() - 0.5 * (low + high);
    if (out.norm() > 1e-3 * (high - low).norm()) view = 0.5 * view + out.normalized();
  }
  picture.camera = FrameCamera(mesh.V, view, aspect);
  picture.axes = false;
  picture.caption.title = title;
  picture.caption.lines = {
      holes.empty()
          ? "No open edges."
          : fmt::format("{} open edges in {}, in red.", picture.lines.size(),
                        holes.size() == 1 ? "one place" : fmt::format("{} places", holes.size()))};
  picture.caption.footer = fmt::format("{} triangles, {:.4g} x {:.4g} x {:.4g} m", mesh.F.rows(),
                                       high.x() - low.x(), high.y() - low.y(), high.z() - low.z());
  return picture;
}

}  // namespace

bool IsMeshFile(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {".obj", ".stl", ".ply", ".off", ".dae", ".gltf", ".glb"}) {
    if (extension == known) return true;
  }
  return false;
}

int CheckMesh(const MeshCheck& check) {
  if (!check.picture.empty()) {
    const TriangleMesh mesh = ReadWelded(check);
    if (mesh.F.rows() > 0) {
      const RenderConfig config{1280, 720, RenderQuality::kStill};
      WritePng(
          Renderer().Render(
              ComposeHoles(fs::path(check.file).filename().string(), mesh, 1280.0 / 720.0), config),
          check.picture);
    }
  }
  Mesh given;
  given.file = fs::path(check.file).filename().string();
  given.scale = check.scale;
  given.repair = check.repair;
  Shape shape = given;
  LoadShape(shape, fs::path(check.file).parent_path(), check.file, "");
  const auto* whole = std::get_if<Union>(&shape);
  const Mesh& first = std::get<Mesh>(whole == nullptr ? shape : whole->parts.front().shape);
  if (!first.repaired.empty()) fmt::print("{}: repaired: {}\n", check.file, first.repaired);
  const AlignedBox bounds = CalcBounds(shape);
  const Vector3 size = bounds.sizes();
  fmt::print("{}: closed, {:.4g} x {:.4g} x {:.4g} m, {:.4g} cm^3, {} triangles{}\n", check.file,
             size.x(), size.y(), size.z(), 1e6 * CalcVolume(shape), Tessellate(shape).F.rows(),
             whole == nullptr ? ""
                              : fmt::format(", {} parts that touch or overlap: their union",
                                            whole->parts.size()));
  return 0;
}

}  // namespace pregrasp
