#include "app/geometry/load_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "app/core/error.h"
#include "app/geometry/bounds.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/read_mesh.h"
#include "app/geometry/reconstruct.h"
#include "app/geometry/solids.h"
#include "app/geometry/split_edges.h"

namespace pregrasp {
namespace {

constexpr double kMaxSize = 100.0;  // [m], as for primitives; a larger mesh is a unit error
// What a hand is to pick up; `check` warns of what is larger than 2 m.
constexpr double kMaxObjectSize = 10.0;  // [m]
// Closed parts of a file; of those that touch or overlap, each is asked in every distance.
constexpr int kMaxComponents = 10'000, kMaxSolids = 64;
// Beyond these a number is a wrong unit: air has 1.2 kg/m^3, osmium 22600.
constexpr double kLeastDensity = 0.1, kMostDensity = 1e6;  // [kg/m^3]

std::string Count(int count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

AlignedBox BoundsOfPoints(const MatrixX3& V) {
  return {Vector3(V.colwise().minCoeff()), Vector3(V.colwise().maxCoeff())};
}

void RequireSaneSize(const MatrixX3& V, const std::string& name, const std::string& where,
                     const std::string& field) {
  const double size = BoundsOfPoints(V).sizes().maxCoeff();
  if (size > kMaxSize) {
    throw InputError(where, field, "a shape at most 100 m long (scale = 0.001 for millimetres)",
                     fmt::format("{}, which is {:.6g} m long", name, size));
  }
}

// The object's, before anything is built from it.
void RequireObjectSize(const AlignedBox& bounds, const std::string& where, const std::string& field,
                       bool from_file) {
  const double size = bounds.sizes().maxCoeff();
  if (size <= kMaxObjectSize) return;
  throw InputError(where, field,
                   fmt::format("an object at most {:g} m long, in metres ({})", kMaxObjectSize,
                               from_file ? "scale = 0.001 for a file in millimetres, 0.01 for "
                                           "centimetres"
                                         : "60 mm are 0.06"),
                   fmt::format("one of {:.4g} m", size));
}

void RequireFinitePoints(const MatrixX3& V, const std::string& name, const std::string& where,
                         const std::string& field) {
  for (int v = 0; v < V.rows(); ++v) {
    if (!V.row(v).allFinite()) {
      throw InputError(where, field, "finite coordinates",
                       fmt::format("{}, whose vertex {} is not finite", name, v + 1));
    }
  }
}

void RequireClosed(const TriangleMesh& mesh, const std::string& name, const std::string& where,
                   const std::string& field) {
  const MeshDefects defects = FindDefects(mesh);
  if (defects.open_edges > 0) {
    const std::vector<Hole> holes = FindHoles(mesh);
    const AlignedBox& largest = holes.front().bounds;
    const Vector3 at = (1e4 * largest.center()).array().round().matrix() * 1e-4;
    const bool tiny =
        largest.sizes().maxCoeff() <= kTinyHole * BoundsOfPoints(mesh.V).diagonal().norm();
    throw InputError(
        where, field, tiny ? "a closed mesh, or repair = true" : "a closed mesh",
        fmt::format("{}, which has {}: {} about ({:.4g}, {:.4g}, {:.4g}) m, {:.2g} m "
                    "across",
                    name, Count(defects.open_edges, "open edge", "open edges"),
                    holes.size() == 1 ? std::string("a hole")
                                      : fmt::format("{} holes, the largest", holes.size()),
                    at.x() + 0.0, at.y() + 0.0, at.z() + 0.0, largest.sizes().maxCoeff()));
  }
  if (defects.crowded_edges > 0 && defects.repeated_faces > 0) {
    throw InputError(
        where, field, "a mesh with each face once, or repair = true",
        fmt::format("{}, which has {}, turned round or not", name,
                    Count(defects.repeated_faces, "face given twice", "faces given twice")));
  }
  if (defects.crowded_edges > 0) {
    throw InputError(where, field, "a mesh with two triangles at each edge",
                     fmt::format("{}, which has more at {}", name,
                                 Count(defects.crowded_edges, "edge", "edges")));
  }
}

// Parts with corners of their own, as the file has them, may touch along whole edges.
void KeepPartsApart(const TriangleMesh& raw, TriangleMesh& mesh) {
  if (FindDefects(mesh).crowded_edges == 0) return;
  TriangleMesh apart = TakeFaces(raw, std::vector<bool>(raw.F.rows(), true));
  const MeshDefects defects = FindDefects(apart);
  if (defects.open_edges == 0 && defects.crowded_edges == 0) mesh = std::move(apart);
}

// Faces that two solids with common corners have between them, once for each, are inside of what
// they are together. Without them the mesh is theirs, if it is closed.
void DropInnerWalls(TriangleMesh& mesh) {
  if (FindDefects(mesh).repeated_faces == 0) return;
  TriangleMesh single = TakeSingleFaces(mesh);
  if (single.F.rows() == 0 || FindDefects(single).open_edges > 0) return;
  mesh = std::move(single);
}

// Depth cameras leave points without a place.
void RequireFiniteCloud(const MatrixX3& P, const std::string& name, const std::string& where,
                        const std::string& field) {
  Eigen::Index lost = 0;
  for (Eigen::Index i = 0; i < P.rows(); ++i) lost += P.row(i).allFinite() ? 0 : 1;
  if (lost == 0) return;
  throw InputError(where, field, "a cloud of the points that were seen, with the others left out",
                   fmt::format("{}, with {} of {} points not finite", name, lost, P.rows()));
}

struct Loader {
  const std::filesystem::path& directory;
  const std::string& where;
  std::string field;
  bool object = false;

  template <typename Reader>
  auto Read(const std::string& name, Reader&& read) const {
    try {
      return read();
    } catch (const UnreadableFile& error) {
      throw InputError(where, field, error.expected,
                       error.got.empty() ? name : name + ", " + error.got);
    }
  }

  // The shape itself is loaded: a file's solids may make a union of it.
  void Load(Shape& shape) const {
    if (const auto* mesh = std::get_if<Mesh>(&shape)) {
      shape = LoadMesh(*mesh);
    } else {
      std::visit(*this, shape);
    }
  }

  Shape LoadMesh(const Mesh& mesh) const {
    const std::string name = '"' + mesh.file + '"';
    const TriangleMesh raw = Read(name, [&] { return ReadTriangles(directory / mesh.file); });
    Mending mending;
    const std::vector<TriangleMesh> solids = RepairMesh({mesh.scale * raw.V, raw.F}, name, where,
                                                        field, mesh.repair ? &mending : nullptr);
    Union whole;
    for (const TriangleMesh& solid : solids) {
      whole.parts.push_back({Mesh{mesh.file, mesh.scale, solid, mesh.repair, mending.Text()}});
    }
    if (solids.size() == 1) return whole.parts.front().shape;
    return whole;
  }

  void operator()(Mesh& /*see Load*/) const {}
  void operator()(Cloud& cloud) const {
    const std::string name = '"' + cloud.file + '"';
    const PointFile read = Read(name, [&] { return ReadPoints(directory / cloud.file); });
    cloud.points = cloud.scale * read.P;
    RequireFiniteCloud(cloud.points, name, where, field);
    RequireSaneSize(cloud.points, name, where, field);
    if (object) RequireObjectSize(BoundsOfPoints(cloud.points), where, field, true);
    try {
      cloud.mesh = ReconstructSurface(cloud.points, read.N).mesh;
    } catch (const UnclosedCloud& error) {
      throw InputError(where, field, error.expected, name + ", " + error.got);
    }
  }
  void operator()(Union& whole) const {
    for (std::size_t i = 0; i < whole.parts.size(); ++i) {
      Loader{directory, where, fmt::format("{}[{}]", field, i + 1), object}.Load(
          whole.parts[i].shape);
    }
  }
  template <typename Primitive>
  void operator()(Primitive&) const {}
};

// A mass that its volume cannot have.
void RequireDensity(const Body& body, const std::string& field) {
  const double mass = body.mass_properties->mass;
  const double volume = CalcVolume(body.shape);
  if (mass >= kLeastDensity * volume && mass <= kMostDensity * volume) return;
  throw InputError(body.where, field,
                   fmt::format("a mass in kg of {:g} to {:g} kg/m^3, of a shape in metres",
                               kLeastDensity, kMostDensity),
                   fmt::format("{:.3g} kg in {:.3g} m^3", mass, volume));
}

void FillMassProperties(Body& body) {
  MassProperties& given = *body.mass_properties;
  const MassProperties uniform = CalcMassProperties(body.shape, given.mass);
  if (!body.com_given && given.p_BoBcm.isZero(0.0)) given.p_BoBcm = uniform.p_BoBcm;
  if (given.I_BBcm.isZero(0.0)) given.I_BBcm = uniform.I_BBcm;
}

}  // namespace

std::vector<TriangleMesh> RepairMesh(const TriangleMesh& raw, const std::string& name,
                                     const std::string& where, const std::string& field,
                                     Mending* mending) {
  RequireFinitePoints(raw.V, name, where, field);
  RequireSaneSize(raw.V, name, where, field);
  const double size = BoundsOfPoints(raw.V).diagonal().norm();
  TriangleMesh mesh = WeldVertices(raw, 0.0);
  if (mesh.F.rows() > 0 && FindDefects(mesh).open_edges > 0) {
    // Formats without shared vertices may round the same corner in two ways.
    TriangleMesh welded = WeldVertices(raw, 1e-6 * size);
    if (FindDefects(welded).open_edges == 0) mesh = std::move(welded);
  }
  if (mesh.F.rows() == 0) {
    throw InputError(where, field, "a closed mesh", name + ", whose triangles have no area");
  }
  KeepPartsApart(raw, mesh);
  DropInnerWalls(mesh);
  if (mending != nullptr && !FindDefects(mesh).closed()) *mending = MendMesh(mesh);
  if (FindDefects(mesh).crowded_edges > 0) SplitCrowdedEdges(mesh);
  RequireClosed(mesh, name, where, field);
  if (!OrientConsistently(mesh)) {
    throw InputError(where, field, "a mesh with an inside and an outside",
                     name + ", whose surface has one side only");
  }
  SplitPinchedVertices(mesh);
  const auto require_at_most = [&](int most, int count, const char* what) {
    if (count <= most) return;
    throw InputError(where, field, fmt::format("at most {} {}", most, what),
                     fmt::format("{}, which has {}", name, count));
  };
  const std::vector<int> label = LabelComponents(mesh);
  require_at_most(kMaxComponents, 1 + *std::max_element(label.begin(), label.end()),
                  "closed parts");
  std::vector<TriangleMesh> solids = SeparateSolids(mesh);
  require_at_most(kMaxSolids, static_cast<int>(solids.size()),
                  "closed parts that touch or overlap");
  // A sheet folded back on itself is closed and holds nothing.
  double volume = 0.0;
  for (const TriangleMesh& solid : solids) volume += CalcVolume(solid);
  if (volume < 1e-9 * size * size * size) {
    throw InputError(where, field, "a mesh that encloses a volume",
                     fmt::format("{}, which encloses {:.3g} m^3", name, volume));
  }
  return solids;
}

void LoadShape(Shape& shape, const std::filesystem::path& directory, const std::string& where,
               const std::string& field) {
  Loader{directory, where, field}.Load(shape);
}

void LoadShapes(Scene& scene, const std::filesystem::path& directory) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    Body& body = scene.bodies[b];
    const std::string field = b == 0 ? "object.shape" : fmt::format("environment[{}].shape", b);
    const bool from_file = std::holds_alternative<Mesh>(body.shape);
    Loader{directory, body.where, field, b == 0}.Load(body.shape);
    if (b == 0) {
      RequireObjectSize(CalcBounds(body.shape), body.where, field, from_file);
    }
    if (!body.movable()) continue;
    RequireDensity(body, b == 0 ? "object.mass" : fmt::format("environment[{}].mass", b));
    FillMassProperties(body);
  }
}

}  // namespace pregrasp
