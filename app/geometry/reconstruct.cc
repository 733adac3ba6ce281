#include "app/geometry/reconstruct.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/geometry/cloud_doubts.h"
#include "app/geometry/cloud_flood.h"
#include "app/geometry/cloud_planes.h"
#include "app/geometry/iso_surface.h"
#include "app/geometry/mesh_distance.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/point_hull.h"
#include "app/geometry/simplify.h"
#include "app/geometry/surface_height.h"

namespace pregrasp {
namespace {

const char* const kClosed = "points all over a closed surface";

constexpr int kMinPoints = 100;
constexpr int kMaxPoints = 15'000;
constexpr int kTrianglesKept = 8'000;
constexpr int kMaxHandles = 10;           // more are a thin wall that broke
constexpr int kMaxCells = 16'000;         // that the surface crosses, about
constexpr double kCellPerSpacing = 0.75;  // of the grid that the surface is taken from

// Every point once, at most kMaxPoints of them, evenly over the file's order.
std::vector<int> ChoosePoints(const MatrixX3& points) {
  std::vector<int> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) { return std::make_tuple(points(i, 0), points(i, 1), points(i, 2)); };
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::make_pair(key(i), i) < std::make_pair(key(j), j); });
  order.erase(
      std::unique(order.begin(), order.end(), [&](int i, int j) { return key(i) == key(j); }),
      order.end());
  std::sort(order.begin(), order.end());
  if (order.size() <= kMaxPoints) return order;
  std::vector<int> chosen;
  for (std::size_t k = 0; k < kMaxPoints; ++k)
    chosen.push_back(order[k * order.size() / kMaxPoints]);
  return chosen;
}

// How thick the cloud is where it is thinnest [m], along a principal axis.
double CalcThickness(const MatrixX3& P) {
  const MatrixX3 D = P.rowwise() - P.colwise().mean();
  const Matrix3 spread = D.transpose() * D;
  const VectorX across = D * Eigen::SelfAdjointEigenSolver<Matrix3>(spread).eigenvectors().col(0);
  return across.maxCoeff() - across.minCoeff();
}

// Turns nodes over whose neighbours, but for two, are all on the other side: specks and spikes,
// which would give handles. The corner of a wall one node thick keeps its three.
void DropSpecks(ScalarGrid& grid) {
  constexpr int kMostOfThem = 24;  // of 26
  constexpr int kRounds = 4;
  const std::array<std::size_t, 3> step = StepsOf(grid);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<float> before = grid.values;
    VisitInner(grid, [&](int x, int y, int z) {
      const std::size_t corner = grid.Index(x - 1, y - 1, z - 1), at = grid.Index(x, y, z);
      int across = 0;
      double sum = 0.0;
      for (int k = 0; k < 27; ++k) {
        const float value =
            before[corner + k % 3 * step[0] + k / 3 % 3 * step[1] + k / 9 * step[2]];
        if ((value < 0.0F) == (before[at] < 0.0F)) continue;
        ++across;
        sum += value;
      }
      if (across >= kMostOfThem) grid.values[at] = static_cast<float>(sum / across);
    });
  }
}

// Averages each node with its neighbours, 1 2 1 along each axis, after cutting values off at
// `limit`. Takes handles away that noise made, and thins walls.
void Smooth(ScalarGrid& grid, double limit) {
  const auto cut = static_cast<float>(limit);
  for (float& value : grid.values) value = std::clamp(value, -cut, cut);
  for (const std::size_t step : StepsOf(grid)) {
    const std::vector<float> before = grid.values;
    VisitInner(grid, [&](int x, int y, int z) {
      const std::size_t at = grid.Index(x, y, z);
      grid.values[at] = 0.25F * (before[at - step] + 2.0F * before[at] + before[at + step]);
    });
  }
}

// Fills pockets that cannot be reached from outside.
void FillPockets(ScalarGrid& grid) {
  GridMarks marks(grid.values.size());
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = grid.values[i] < 0.0F ? 1 : 0;
  FloodFromCorner(grid, marks);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i] == 0) grid.values[i] = static_cast<float>(-1e-3 * grid.cell);
  }
}

// The implicit surface on a grid: heights over the planes near the points, beyond them outside
// where the flood reaches and inside elsewhere. Planes say little far from their points, so that
// both sides are spread to within `distance` of these.
ScalarGrid Evaluate(const SampledCloud& cloud, const CloudFlood& flood, double distance) {
  const double area = cloud.spacing * cloud.spacing * static_cast<double>(cloud.P.rows());
  const double cell = std::max(kCellPerSpacing * cloud.spacing, std::sqrt(area / kMaxCells));
  const double band = 1.15 * flood.radius() + cell;
  constexpr std::uint8_t kInside = 0, kNear = 1, kOutside = 2;
  ScalarGrid grid = GridAround(cloud, cell, 1.5 * band);
  GridMarks marks(grid.values.size(), kInside);
  for (int i = 0; i < cloud.P.rows(); ++i) {
    VisitBall(grid, cloud.P.row(i), band,
              [&](int x, int y, int z) { marks[grid.Index(x, y, z)] = kNear; });
  }
  const auto visit_all = [&](auto&& visit) {
    for (int z = 0; z < grid.count[2]; ++z) {
      for (int y = 0; y < grid.count[1]; ++y) {
        ThrowIfInterrupted();
        for (int x = 0; x < grid.count[0]; ++x) visit(grid.Index(x, y, z), grid.Node(x, y, z));
      }
    }
  };
  visit_all([&](std::size_t at, const Vector3& p) {
    if (flood.Reaches(p)) marks[at] = kOutside;
  });
  SpreadMark(grid, kInside, band - distance, marks);
  SurfaceHeight height(cloud);
  visit_all([&](std::size_t at, const Vector3& p) {
    const double side = marks[at] == kOutside ? band : -band;
    grid.values[at] = static_cast<float>(marks[at] == kNear ? height.Calc(p) : side);
  });
  DropSpecks(grid);
  return grid;
}

// The component with the largest volume.
TriangleMesh LargestComponent(const TriangleMesh& mesh) {
  if (mesh.F.rows() == 0) return mesh;
  const std::vector<int> label = LabelComponents(mesh);
  const int count = 1 + *std::max_element(label.begin(), label.end());
  std::vector<double> volume(count, 0.0);
  const Vector3 origin = mesh.V.row(0);
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)).transpose() - origin;
    const Vector3 b = mesh.V.row(mesh.F(f, 1)).transpose() - origin;
    const Vector3 c = mesh.V.row(mesh.F(f, 2)).transpose() - origin;
    volume[label[f]] += a.dot(b.cross(c));
  }
  const auto largest =
      static_cast<int>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  std::vector<bool> keep(label.size());
  std::transform(label.begin(), label.end(), keep.begin(), [&](int of) { return of == largest; });
  return TakeFaces(mesh, keep);
}

// How far the grid's surface is from the points, mean, by its values between nodes [m].
double MeanHeight(const ScalarGrid& grid, const MatrixX3& P) {
  double sum = 0.0;
  for (int i = 0; i < P.rows(); ++i) {
    const Vector3 q = (P.row(i).transpose() - grid.p_min) / grid.cell;
    const std::array<int, 3> at{static_cast<int>(q.x()), static_cast<int>(q.y()),
                                static_cast<int>(q.z())};
    double height = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      const std::array<int, 3> up{corner % 2, corner / 2 % 2, corner / 4};
      double weight = 1.0;
      for (int k = 0; k < 3; ++k) weight *= up[k] == 1 ? q[k] - at[k] : 1.0 - (q[k] - at[k]);
      height += weight * grid.values[grid.Index(at[0] + up[0], at[1] + up[1], at[2] + up[2])];
    }
    sum += std::abs(height);
  }
  return sum / static_cast<double>(P.rows());
}

// The surface as the grid has it, or smoothed where that takes handles away and fits the points
// about as well.
TriangleMesh ExtractBest(const SampledCloud& cloud, ScalarGrid grid) {
  ScalarGrid smooth = grid;
  const auto extract = [](ScalarGrid& field) {
    FillPockets(field);
    return LargestComponent(ExtractSurface(field));
  };
  TriangleMesh sharp_mesh = extract(grid);
  if (sharp_mesh.F.rows() == 0 || CalcEulerNumber(sharp_mesh) == 2) return sharp_mesh;
  Smooth(smooth, 1.5 * grid.cell);
  TriangleMesh smooth_mesh = extract(smooth);
  if (smooth_mesh.F.rows() == 0 || CalcEulerNumber(smooth_mesh) <= CalcEulerNumber(sharp_mesh)) {
    return sharp_mesh;
  }
  constexpr double kAboutAsWell = 0.08;  // in spacings
  const double more = MeanHeight(smooth, cloud.P) - MeanHeight(grid, cloud.P);
  return more < kAboutAsWell * cloud.spacing ? smooth_mesh : sharp_mesh;
}

// Of pairs of neighbours on one sheet, how many have normals to opposite sides. Two sides of a thin
// plate are no such pair: each lies behind the other.
double CalcFlippedShare(const SampledCloud& cloud) {
  constexpr int kLooked = 6;
  constexpr double kParallel = 0.9, kBeside = 0.2, kBehind = 0.05;
  int pairs = 0, flipped = 0;
  for (Eigen::Index i = 0; i < cloud.P.rows(); ++i) {
    for (int k = 0; k < kLooked; ++k) {
      const int j = cloud.near[i][k];
      const Vector3 d = (cloud.P.row(j) - cloud.P.row(i)).transpose();
      const double along = cloud.N.row(i).dot(cloud.N.row(j)), off = cloud.N.row(i).dot(d),
                   off_back = -cloud.N.row(j).dot(d), apart = d.norm();
      if (std::abs(along) < kParallel || std::abs(off) > kBeside * apart) continue;
      ++pairs;
      const bool plate = off < -kBehind * apart && off_back < -kBehind * apart;
      flipped += along < 0.0 && !plate ? 1 : 0;
    }
  }
  return pairs == 0 ? 0.0 : static_cast<double>(flipped) / pairs;
}

// True when the points' own normals serve; else they get those of planes.
bool TakeNormals(const MatrixX3& normals, const std::vector<int>& chosen, SampledCloud& cloud) {
  if (normals.rows() > 0) cloud.N = TakeRows(normals, chosen);
  bool usable =
      cloud.N.rows() > 0 && cloud.N.allFinite() && cloud.N.rowwise().squaredNorm().minCoeff() > 0.0;
  if (usable) {
    constexpr double kMostFlipped = 0.1;  // estimated normals point to either side
    cloud.N.rowwise().normalize();
    usable = CalcFlippedShare(cloud) < kMostFlipped;
  }
  if (!usable) FitPlanes(cloud);
  return usable;
}

void RequireThickness(const SampledCloud& cloud) {
  const double thickness = CalcThickness(cloud.P);
  if (thickness >= 0.5 * cloud.spacing) return;
  throw UnclosedCloud(kClosed,
                      fmt::format("which lie within {:.2f} mm of a plane", 1e3 * thickness));
}

void RequireOneObject(const CloudDoubts& doubts) {
  if (doubts.sheet_share == 0.0) return;
  throw UnclosedCloud(
      "the points of one object, without what it stands on",
      fmt::format("{:.0f} % of whose points lie in a sheet that reaches beyond all others",
                  100.0 * doubts.sheet_share));
}

// Where points end along a rim, that is why no surface closes, whatever else it looks like.
void RequireNoRim(const CloudDoubts& doubts) {
  if (!doubts.has_rim()) return;
  throw UnclosedCloud(
      "points all over a closed surface, from every side",
      fmt::format("whose points end along a rim, {} of them, one at ({:.3g}, {:.3g}, {:.3g}) m",
                  doubts.rim_points, doubts.p_rim.x(), doubts.p_rim.y(), doubts.p_rim.z()));
}

void RequireSolid(const TriangleMesh& mesh, int euler_number, double spacing,
                  const CloudDoubts& doubts) {
  if (mesh.F.rows() == 0 || CalcVolume(mesh) <= 0.0) {
    RequireNoRim(doubts);
    throw UnclosedCloud(kClosed, "around which no closed surface was found");
  }
  const int handles = 1 - euler_number / 2;
  if (handles > kMaxHandles) {
    RequireNoRim(doubts);
    throw UnclosedCloud(
        "points denser than the shape's walls are thick",
        fmt::format("whose points are {:.1f} mm apart and give {} holes", 1e3 * spacing, handles));
  }
}

}  // namespace

Reconstruction ReconstructSurface(const MatrixX3& points, const MatrixX3& normals) {
  PREGRASP_CHECK(normals.rows() == 0 || normals.rows() == points.rows(), normals.rows());
  const std::vector<int> chosen = ChoosePoints(points);
  if (chosen.size() < kMinPoints) {
    throw UnclosedCloud(fmt::format("at least {} points", kMinPoints),
                        fmt::format("which has {}", chosen.size()));
  }
  SampledCloud cloud;
  cloud.P = TakeRows(points, chosen);
  FindNeighbourhoods(cloud);
  RequireThickness(cloud);
  const CloudDoubts doubts = FindCloudDoubts(cloud);
  RequireOneObject(doubts);
  const bool has_normals = TakeNormals(normals, chosen, cloud);
  CloudFlood flood = OrientOutward(cloud, has_normals);
  const double distance = 0.75 * cloud.widest;
  flood.Spread(distance);
  const PointHull hull(cloud);
  DropStrays(cloud);

  TriangleMesh mesh = ExtractBest(cloud, Evaluate(cloud, flood, distance));
  Reconstruction result;
  result.spacing = cloud.spacing;
  result.euler_number = mesh.F.rows() == 0 ? 0 : CalcEulerNumber(mesh);
  RequireSolid(mesh, result.euler_number, cloud.spacing, doubts);
  // A sheet with both of its sides is no thicker than its points are apart.
  constexpr double kSheet = 2.0;  // in spacings
  if (2.0 * CalcVolume(mesh) < kSheet * cloud.spacing * CalcArea(mesh)) RequireNoRim(doubts);
  hull.PullIn(mesh);
  result.mesh = SimplifyMesh(mesh, {}, kTrianglesKept);

  const MeshDistance to_mesh(result.mesh);
  std::vector<double> errors;
  errors.reserve(chosen.size());
  for (const int i : chosen) {
    ThrowIfInterrupted();
    errors.push_back(std::abs(to_mesh.Calc(points.row(i))));
  }
  result.mean_error =
      std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
  result.p99_error = Percentile(errors, 0.99);
  if (result.p99_error > 2.0 * cloud.widest) {
    RequireNoRim(doubts);
    throw UnclosedCloud(kClosed, fmt::format("of which some lie {:.1f} mm off the surface found",
                                             1e3 * result.p99_error));
  }
  return result;
}

}  // namespace pregrasp
