#include "app/geometry/hull.h"

// The C interface: that of C++ does not compile as C++20. Its macros need the name `qh`.
#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

using Faces = std::vector<std::array<int, 3>>;

// One run of qhull, with what it holds.
class QhullRun {
 public:
  QhullRun() : errors_(std::fopen("/dev/null", "w")) { qh_zero(&state_, errors_); }
  ~QhullRun() {
    qh_freeqhull(&state_, !qh_ALL);
    int blocks = 0, bytes = 0;
    qh_memfreeshort(&state_, &blocks, &bytes);
    if (errors_ != nullptr) std::fclose(errors_);
  }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;

  // Faces as indices into `points`; none when qhull refuses them.
  std::optional<Faces> Run(const MatrixX3& points, const char* options) {
    MatrixX3 copy = points;  // qhull takes coordinates that it may write to
    std::string command = std::string("qhull ") + options;
    if (qh_new_qhull(&state_, 3, static_cast<int>(copy.rows()), copy.data(), False, command.data(),
                     nullptr, errors_) != 0) {
      return std::nullopt;
    }
    Faces faces;
    qhT* qh = &state_;
    facetT* facet = nullptr;
    FORALLfacets {
      std::array<int, 3> face{};
      int corner = 0;
      vertexT *vertex = nullptr, **vertexp = nullptr;
      FOREACHvertex_(facet->vertices) {
        if (corner == 3) return std::nullopt;
        face[corner++] = qh_pointid(qh, vertex->point);
      }
      if (corner < 3) return std::nullopt;
      if (facet->toporient) std::swap(face[0], face[1]);
      faces.push_back(face);
    }
    return faces;
  }

 private:
  qhT state_;
  std::FILE* errors_;
};

// Vertices in the order of the points, so that the result does not depend on qhull's lists.
TriangleMesh Compact(const MatrixX3& points, const Faces& faces) {
  TriangleMesh mesh;
  mesh.V = points;
  mesh.F.resize(static_cast<int>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) mesh.F(static_cast<int>(f), i) = faces[f][i];
  }
  return WeldVertices(mesh, 0.0);
}

// The points that reach farthest along the axes, diagonals and between them.
std::vector<int> FindExtremes(const MatrixX3& points) {
  std::vector<int> extremes;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        int farthest = 0;
        (points * Vector3(x, y, z)).maxCoeff(&farthest);
        extremes.push_back(farthest);
      }
    }
  }
  std::sort(extremes.begin(), extremes.end());
  extremes.erase(std::unique(extremes.begin(), extremes.end()), extremes.end());
  return extremes;
}

struct Farthest {
  double height = 0.0;
  int point = -1;
};

// Keeps those of `outside` that lie farther than `tolerance` outside the hull. Returns the farthest
// one of each face that has any, the farthest first.
std::vector<Farthest> DropInside(const MatrixX3& points, const TriangleMesh& hull, double tolerance,
                                 std::vector<int>& outside) {
  const int faces = static_cast<int>(hull.F.rows());
  MatrixX3 N(faces, 3);
  VectorX offsets(faces);
  for (int f = 0; f < faces; ++f) {
    const Vector3 a = hull.V.row(hull.F(f, 0)), b = hull.V.row(hull.F(f, 1)),
                  c = hull.V.row(hull.F(f, 2));
    const Vector3 cross = (b - a).cross(c - a);
    const double length = cross.norm();
    N.row(f) = (length > 0.0 ? Vector3(cross / length) : Vector3::Zero()).transpose();
    offsets[f] = N.row(f).dot(a);
  }
  std::vector<Farthest> proposals(faces);
  std::vector<int> kept;
  for (const int i : outside) {
    int face = 0;
    const double height = (N * points.row(i).transpose() - offsets).maxCoeff(&face);
    if (height <= tolerance) continue;
    kept.push_back(i);
    if (height > proposals[face].height) proposals[face] = {height, i};
  }
  outside = std::move(kept);
  proposals.erase(std::remove_if(proposals.begin(), proposals.end(),
                                 [](const Farthest& f) { return f.point < 0; }),
                  proposals.end());
  std::sort(proposals.begin(), proposals.end(), [](const Farthest& a, const Farthest& b) {
    return std::make_pair(-a.height, a.point) < std::make_pair(-b.height, b.point);
  });
  return proposals;
}

// Euler's formula; a hull that qhull left open or doubled breaks it.
bool IsBall(const TriangleMesh& mesh) {
  return mesh.F.rows() >= 4 && mesh.F.rows() == 2 * mesh.V.rows() - 4;
}

}  // namespace

TriangleMesh CalcConvexHull(const MatrixX3& points) {
  const auto refuse = [](const std::string& got) {
    throw InputError("", "", "points that enclose a volume", got);
  };
  if (points.rows() < 4) refuse(std::to_string(points.rows()) + " points");
  if (!points.allFinite()) refuse("coordinates that are not finite");
  // Near the origin and of unit size, where qhull's rounding is smallest.
  const Vector3 low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const Vector3 centre = 0.5 * (low + high);
  const double size = (high - low).maxCoeff();
  if (!(size > 0.0)) refuse("points in one place");
  MatrixX3 scaled = (points.rowwise() - centre.transpose()) / size;
  // Triangles as they are first; joggled when merged facets leave a hull that is not one.
  for (const char* options : {"Qt", "QJ"}) {
    const auto faces = QhullRun().Run(scaled, options);
    if (!faces) continue;
    TriangleMesh hull = Compact(points, *faces);
    if (!IsBall(hull)) continue;
    const double volume = CalcVolume(hull);
    if (std::abs(volume) < 1e-12 * size * size * size) break;
    if (volume < 0.0) hull.F.col(0).swap(hull.F.col(1));
    return hull;
  }
  refuse("points in a plane");
  return {};
}

// Quickhull in batches: what lies inside the hull so far is dropped, and each of its faces proposes
// the point farthest outside it. qhull itself only ever sees the chosen points; on a thousand
// points in a plane, as a cut leaves them, it can take seconds.
TriangleMesh CalcReducedHull(const MatrixX3& points, double tolerance, int max_vertices) {
  std::vector<int> chosen = FindExtremes(points);
  std::vector<int> outside(points.rows());
  std::iota(outside.begin(), outside.end(), 0);
  for (;;) {
    ThrowIfInterrupted();
    MatrixX3 subset(static_cast<int>(chosen.size()), 3);
    for (std::size_t i = 0; i < chosen.size(); ++i) subset.row(i) = points.row(chosen[i]);
    TriangleMesh hull = CalcConvexHull(subset);
    const std::vector<Farthest> proposals = DropInside(points, hull, tolerance, outside);
    const int room = max_vertices - static_cast<int>(chosen.size());
    if (proposals.empty() || room <= 0) return hull;
    // Only the outer half at once: one far point often brings its neighbours within tolerance.
    const auto batch = std::min<std::size_t>((proposals.size() + 1) / 2, room);
    const std::size_t before = chosen.size();
    for (std::size_t i = 0; i < batch; ++i) chosen.push_back(proposals[i].point);
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    // Corners may seem to lie outside of slivers, whose planes are uncertain.
    if (chosen.size() == before) return hull;
  }
}

}  // namespace pregrasp
