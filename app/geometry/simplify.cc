#include "app/geometry/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <tuple>
#include <utility>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

constexpr double kSpread = 1e-6;
// Ties directions that the planes leave free to the middle of the faces; so weak that a corner
// moves by some nanometres.
constexpr double kTie = 1e-9;

// Sums over faces gone into a vertex, by area: squared distance to their planes, x^T A x - 2 b.x +
// c, and to their places, area |x|^2 - 2 first.x + second.
struct Quadric {
  Matrix3 A = Matrix3::Zero();
  Vector3 b = Vector3::Zero();
  double c = 0.0;
  double area = 0.0;
  Vector3 first = Vector3::Zero();
  double second = 0.0;

  void AddFace(const FacePlane& plane, double weight) {
    const double d = plane.nhat.dot(plane.p);
    A += weight * plane.nhat * plane.nhat.transpose();
    b += weight * d * plane.nhat;
    c += weight * d * d;
  }
  void AddPlace(const Vector3& p, double weight) {
    area += weight;
    first += weight * p;
    second += weight * p.squaredNorm();
  }
  void Add(const Quadric& other) {
    A += other.A;
    b += other.b;
    c += other.c;
    area += other.area;
    first += other.first;
    second += other.second;
  }
  double OffSurface(const Vector3& x) const {
    return std::max(0.0, x.dot(A * x) - 2.0 * b.dot(x) + c);
  }
  double AlongSurface(const Vector3& x) const {
    return std::max(0.0, area * x.squaredNorm() - 2.0 * first.dot(x) + second);
  }
  // A mean, not a sum: a rim of little area is no cheaper to flatten than a broad one.
  double Cost(const Vector3& x) const {
    return area > 0.0 ? (OffSurface(x) + kSpread * AlongSurface(x)) / area : 0.0;
  }
  Vector3 Best() const {
    const double tie = kTie * area;
    return (A + tie * Matrix3::Identity()).ldlt().solve(b + kTie * first);
  }
};

class Collapser {
 public:
  Collapser(const TriangleMesh& mesh, const std::vector<FacePlane>& planes) {
    const Vector3 low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
    centre_ = 0.5 * (low + high);  // quadrics lose digits far from the origin
    for (int v = 0; v < mesh.V.rows(); ++v) {
      points_.push_back(mesh.V.row(v).transpose() - centre_);
    }
    quadrics_.resize(points_.size());
    faces_of_.resize(points_.size());
    stamp_.resize(points_.size(), 0);
    for (int f = 0; f < mesh.F.rows(); ++f) {
      faces_.push_back({mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)});
      const Vector3 cross = CrossOf(faces_[f]);
      const double area = 0.5 * cross.norm();
      FacePlane plane{points_[faces_[f][0]],
                      area > 0.0 ? Vector3(0.5 / area * cross) : Vector3::Zero()};
      if (!planes.empty()) plane = {planes[f].p - centre_, planes[f].nhat};
      for (const int v : faces_[f]) {
        quadrics_[v].AddFace(plane, area / 3.0);
        quadrics_[v].AddPlace(points_[v], area / 3.0);
        faces_of_[v].push_back(f);
      }
    }
    alive_.assign(faces_.size(), true);
    num_faces_ = static_cast<int>(faces_.size());
  }

  TriangleMesh Run(int target) {
    // What was refused may have become possible: go on until a round changes nothing.
    for (int before = -1; num_faces_ > target && num_faces_ != before;) {
      before = num_faces_;
      PushAll();
      while (num_faces_ > target && !queue_.empty()) {
        ThrowIfInterrupted();
        const auto [cost, a, b, stamp] = queue_.top();
        queue_.pop();
        if (stamp_[a] + stamp_[b] != stamp || Gone(a) || Gone(b)) continue;
        const Vector3 p = Place(a, b).p;
        if (MayCollapse(a, b, p)) Collapse(a, b, p);
      }
      queue_ = {};
    }
    return Finish();
  }

 private:
  // Few bytes, as most of the time goes into moving them about the queue: where the edge's ends
  // come to lie is worked out again when its turn has come.
  struct Entry {
    double cost;
    int a, b;  // a < b; b goes into a
    int stamp;

    bool operator<(const Entry& other) const {  // the queue's top is the largest
      return std::tie(other.cost, other.a, other.b) < std::tie(cost, a, b);
    }
  };

  bool Gone(int v) const { return faces_of_[v].empty(); }

  Vector3 CrossOf(const std::array<int, 3>& face) const {
    return (points_[face[1]] - points_[face[0]]).cross(points_[face[2]] - points_[face[0]]);
  }

  void FindNeighbours(int v, std::vector<int>& result) const {
    result.clear();
    for (const int f : faces_of_[v]) {
      for (const int w : faces_[f]) {
        if (w != v) result.push_back(w);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
  }

  struct Placement {
    Vector3 p;
    double cost;
  };

  // Where an edge's ends go best.
  Placement Place(int a, int b) const {
    Quadric joint = quadrics_[a];
    joint.Add(quadrics_[b]);
    const Vector3 middle = 0.5 * (points_[a] + points_[b]);
    const Vector3 best = joint.Best();
    // Far from the edge the solution is that of an ill-posed system.
    const double reach = 2.0 * (points_[a] - points_[b]).norm();
    if (best.allFinite() && (best - middle).norm() <= reach) return {best, joint.Cost(best)};
    Placement placement{middle, joint.Cost(middle)};
    for (const int end : {a, b}) {
      const double at_end = joint.Cost(points_[end]);
      if (at_end < placement.cost) placement = {points_[end], at_end};
    }
    return placement;
  }

  void Push(int a, int b) {
    if (a > b) std::swap(a, b);
    queue_.push({Place(a, b).cost, a, b, stamp_[a] + stamp_[b]});
  }

  void PushAll() {
    for (int v = 0; v < static_cast<int>(points_.size()); ++v) {
      FindNeighbours(v, of_a_);
      for (const int w : of_a_) {
        if (w > v) Push(v, w);
      }
    }
  }

  bool MayCollapse(int a, int b, const Vector3& p) {
    FindNeighbours(a, of_a_);
    FindNeighbours(b, of_b_);
    common_.clear();
    std::set_intersection(of_a_.begin(), of_a_.end(), of_b_.begin(), of_b_.end(),
                          std::back_inserter(common_));
    if (common_.size() != 2) return false;
    // The last tetrahedron stays.
    if (of_a_.size() == 3 && of_b_.size() == 3) return false;
    return !TurnsOver(a, b, p) && !TurnsOver(b, a, p);
  }

  // Whether moving v to p turns or flattens a face that does not hold w.
  bool TurnsOver(int v, int w, const Vector3& p) const {
    for (const int f : faces_of_[v]) {
      std::array<Vector3, 3> corners;
      bool shared = false;
      for (int i = 0; i < 3; ++i) {
        shared = shared || faces_[f][i] == w;
        corners[i] = faces_[f][i] == v ? p : points_[faces_[f][i]];
      }
      if (shared) continue;
      const Vector3 before = CrossOf(faces_[f]);
      const Vector3 after = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      constexpr double kCosLimit = 0.2;
      if (after.dot(before) <= kCosLimit * after.norm() * before.norm()) return true;
      const double longest = std::max({(corners[1] - corners[0]).squaredNorm(),
                                       (corners[2] - corners[1]).squaredNorm(),
                                       (corners[0] - corners[2]).squaredNorm()});
      constexpr double kThinnest = 1e-3;  // height over longest edge
      if (after.norm() < kThinnest * longest && after.norm() < before.norm()) return true;
    }
    return false;
  }

  void Collapse(int a, int b, const Vector3& p) {
    points_[a] = p;
    quadrics_[a].Add(quadrics_[b]);
    std::vector<int> kept;
    for (const int f : faces_of_[b]) {
      std::array<int, 3>& face = faces_[f];
      if (std::find(face.begin(), face.end(), a) != face.end()) {
        alive_[f] = false;
        --num_faces_;
        for (const int v : face) {
          if (v != b) faces_of_[v].erase(std::find(faces_of_[v].begin(), faces_of_[v].end(), f));
        }
      } else {
        *std::find(face.begin(), face.end(), b) = a;
        kept.push_back(f);
      }
    }
    faces_of_[b].clear();
    faces_of_[a].insert(faces_of_[a].end(), kept.begin(), kept.end());
    std::sort(faces_of_[a].begin(), faces_of_[a].end());
    ++stamp_[a];
    FindNeighbours(a, of_a_);
    for (const int v : of_a_) Push(a, v);
  }

  TriangleMesh Finish() const {
    TriangleMesh mesh;
    mesh.V.resize(static_cast<int>(points_.size()), 3);
    for (std::size_t v = 0; v < points_.size(); ++v) {
      mesh.V.row(static_cast<int>(v)) = (points_[v] + centre_).transpose();
    }
    std::vector<int> new_index(points_.size(), -1);
    int count = 0;
    for (std::size_t v = 0; v < points_.size(); ++v) {
      if (Gone(static_cast<int>(v))) continue;
      mesh.V.row(count) = mesh.V.row(static_cast<int>(v)).eval();
      new_index[v] = count++;
    }
    mesh.V.conservativeResize(count, 3);
    mesh.F.resize(num_faces_, 3);
    int row = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (!alive_[f]) continue;
      for (int i = 0; i < 3; ++i) mesh.F(row, i) = new_index[faces_[f][i]];
      ++row;
    }
    return mesh;
  }

  Vector3 centre_;
  std::vector<Vector3> points_;
  std::vector<Quadric> quadrics_;
  std::vector<std::vector<int>> faces_of_;
  std::vector<int> stamp_;
  std::vector<std::array<int, 3>> faces_;
  std::vector<bool> alive_;
  int num_faces_ = 0;
  std::priority_queue<Entry> queue_;
  std::vector<int> of_a_, of_b_, common_;  // scratch: neighbours of an edge's ends
};

}  // namespace

TriangleMesh SplitLongEdges(const TriangleMesh& mesh, double max_edge) {
  std::vector<Vector3> points;
  points.reserve(mesh.V.rows());
  for (int v = 0; v < mesh.V.rows(); ++v) points.emplace_back(mesh.V.row(v));
  std::vector<std::array<int, 3>> faces;
  std::map<std::pair<int, int>, std::array<int, 2>> faces_at;  // an edge's two faces
  const auto attach = [&](int f) {
    for (int i = 0; i < 3; ++i) {
      auto& pair = faces_at
                       .try_emplace(std::minmax(faces[f][i], faces[f][(i + 1) % 3]),
                                    std::array<int, 2>{-1, -1})
                       .first->second;
      (pair[0] < 0 ? pair[0] : pair[1]) = f;
    }
  };
  using Item = std::tuple<double, int, int>;
  std::priority_queue<Item> queue;
  const auto push = [&](int a, int b) {
    const double length = (points[a] - points[b]).norm();
    // The negated numbers settle ties: smaller ones first.
    if (length > max_edge) queue.emplace(length, -std::min(a, b), -std::max(a, b));
  };
  for (int f = 0; f < mesh.F.rows(); ++f) {
    faces.push_back({mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)});
    attach(f);
  }
  for (const auto& [edge, pair] : faces_at) push(edge.first, edge.second);
  while (!queue.empty()) {
    ThrowIfInterrupted();
    const auto [length, minus_a, minus_b] = queue.top();
    queue.pop();
    const int a = -minus_a, b = -minus_b;
    const auto it = faces_at.find({a, b});
    PREGRASP_CHECK(it != faces_at.end(), a, b);
    const std::array<int, 2> pair = it->second;
    faces_at.erase(it);
    const auto middle = static_cast<int>(points.size());
    points.emplace_back(0.5 * (points[a] + points[b]));
    for (const int f : pair) {
      if (f < 0) continue;
      int i = 0;
      while (std::minmax(faces[f][i], faces[f][(i + 1) % 3]) != std::minmax(a, b)) ++i;
      const int u = faces[f][i], v = faces[f][(i + 1) % 3], w = faces[f][(i + 2) % 3];
      faces[f] = {u, middle, w};
      const auto added = static_cast<int>(faces.size());
      faces.push_back({middle, v, w});
      auto& at_vw = faces_at.at(std::minmax(v, w));
      (at_vw[0] == f ? at_vw[0] : at_vw[1]) = added;
      faces_at[std::minmax(middle, w)] = {f, added};
      auto& at_um =
          faces_at.try_emplace(std::minmax(u, middle), std::array<int, 2>{-1, -1}).first->second;
      (at_um[0] < 0 ? at_um[0] : at_um[1]) = f;
      auto& at_mv =
          faces_at.try_emplace(std::minmax(middle, v), std::array<int, 2>{-1, -1}).first->second;
      (at_mv[0] < 0 ? at_mv[0] : at_mv[1]) = added;
      push(middle, w);
    }
    push(a, middle);
    push(middle, b);
  }
  TriangleMesh result;
  result.V.resize(static_cast<int>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) result.V.row(static_cast<int>(v)) = points[v];
  result.F.resize(static_cast<int>(faces.size()), 3);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int i = 0; i < 3; ++i) result.F(static_cast<int>(f), i) = faces[f][i];
  }
  return result;
}

TriangleMesh SimplifyMesh(const TriangleMesh& mesh, const std::vector<FacePlane>& planes,
                          int target) {
  PREGRASP_CHECK(planes.empty() || static_cast<int>(planes.size()) == mesh.F.rows(), planes.size());
  return Collapser(mesh, planes).Run(target);
}

void FlipFlatEdges(TriangleMesh& mesh, double tolerance) {
  const auto point = [&](int v) -> Vector3 { return mesh.V.row(v); };
  const auto normal = [&](int a, int b, int c) -> Vector3 {
    return (point(b) - point(a)).cross(point(c) - point(a));
  };
  const auto angle_at = [&](int v, int a, int b) {
    const Vector3 u = point(a) - point(v), w = point(b) - point(v);
    return std::atan2(u.cross(w).norm(), u.dot(w));
  };
  constexpr int kMaxRounds = 100;
  bool changed = true;
  for (int round = 0; round < kMaxRounds && changed; ++round) {
    changed = false;
    auto neighbours = FindNeighbours(mesh);
    std::set<std::pair<int, int>> edges;
    for (int f = 0; f < mesh.F.rows(); ++f) {
      for (int i = 0; i < 3; ++i) edges.insert(std::minmax(mesh.F(f, i), mesh.F(f, (i + 1) % 3)));
    }
    std::vector<bool> touched(mesh.F.rows(), false);
    for (int f = 0; f < mesh.F.rows(); ++f) {
      for (int i = 0; i < 3 && !touched[f]; ++i) {
        const int g = neighbours[f][i];
        if (g < 0 || touched[g]) continue;
        const int a = mesh.F(f, i), b = mesh.F(f, (i + 1) % 3), c = mesh.F(f, (i + 2) % 3);
        int j = 0;
        while (mesh.F(g, j) != b || mesh.F(g, (j + 1) % 3) != a) ++j;
        const int d = mesh.F(g, (j + 2) % 3);
        if (edges.count(std::minmax(c, d)) > 0) continue;
        const Vector3 n = normal(a, b, c), m = normal(b, a, d);
        if (n.cross(m).norm() > tolerance * n.norm() * m.norm() || n.dot(m) <= 0.0) continue;
        // Both new triangles must lie the same way: the four corners are convex.
        const Vector3 first = normal(a, d, c), second = normal(b, c, d);
        const double scale = (n + m).norm();
        if (first.dot(n) <= 1e-9 * scale * scale || second.dot(n) <= 1e-9 * scale * scale) continue;
        if (angle_at(c, a, b) + angle_at(d, a, b) <= kPi + 1e-9) continue;  // Delaunay already
        edges.erase(std::minmax(a, b));
        edges.insert(std::minmax(c, d));
        mesh.F.row(f) << a, d, c;
        mesh.F.row(g) << b, c, d;
        touched[f] = touched[g] = true;
        changed = true;
      }
    }
  }
}

}  // namespace pregrasp
