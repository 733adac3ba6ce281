#include "app/geometry/mesh_distance.h"

#include <algorithm>
#include <utility>

#include "app/core/check.h"
#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

constexpr int kLeafSize = 4;

Vector3 Normalized(const Vector3& v) {
  const double length = v.norm();
  return length > 0.0 ? Vector3(v / length) : Vector3::Zero();
}

double AngleBetween(const Vector3& u, const Vector3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

double SquaredDistanceToBox(const Vector3& low, const Vector3& high, const Vector3& p) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double gap = std::max({low[i] - p[i], 0.0, p[i] - high[i]});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

struct MeshDistance::Item {
  AlignedBox box;
  Vector3 centre;
  Triangle triangle;
};

struct MeshDistance::Search {
  double best = std::numeric_limits<double>::infinity();  // squared
  int triangle = -1;
  Hit hit;
};

MeshDistance::MeshDistance(const TriangleMesh& mesh) {
  PREGRASP_CHECK(mesh.F.rows() > 0, "shape is not loaded");
  std::vector<Item> items;
  items.reserve(mesh.F.rows());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    Item item;
    item.box.extend(a).extend(b).extend(c);
    item.centre = item.box.center();
    const Vector3 ab = b - a, ac = c - a;
    const Vector3 cross = ab.cross(ac);
    // The sine of the smallest angle below which the face's own normal is rounding noise; such a
    // triangle counts by its edges only.
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
    const bool flat = cross.norm() <= 1e-10 * longest;
    item.triangle = {a, ab, ac, flat ? Vector3::Zero() : Normalized(cross), f};
    bounds_.extend(item.box);
    items.push_back(item);
  }
  nodes_.reserve(items.size());
  triangles_.reserve(items.size());
  BuildNode(items, 0, static_cast<int>(items.size()), 0);
  BuildPseudonormals(mesh);
}

void MeshDistance::BuildPseudonormals(const TriangleMesh& mesh) {
  std::vector<Vector3> face_normals(mesh.F.rows(), Vector3::Zero());
  for (const Triangle& t : triangles_) face_normals[t.face] = t.nhat;
  std::vector<Vector3> vertex_sums(mesh.V.rows(), Vector3::Zero());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.F(f, i);
      const Vector3 p_a = mesh.V.row(a), p_b = mesh.V.row(mesh.F(f, (i + 1) % 3)),
                    p_c = mesh.V.row(mesh.F(f, (i + 2) % 3));
      vertex_sums[a] += AngleBetween(p_b - p_a, p_c - p_a) * face_normals[f];
    }
  }
  const auto neighbours = FindNeighbours(mesh);
  feature_normals_.reserve(triangles_.size());
  for (const Triangle& t : triangles_) {
    std::array<Vector3, 7> normals;
    normals[0] = t.nhat;
    for (int i = 0; i < 3; ++i) {
      const int across = neighbours[t.face][i];
      normals[1 + i] = Normalized(t.nhat + (across < 0 ? t.nhat : face_normals[across]));
      normals[4 + i] = Normalized(vertex_sums[mesh.F(t.face, i)]);
    }
    feature_normals_.push_back(normals);
  }
}

// Splits at the plane of least surface-area cost over 16 bins of the longest axis of the centres;
// in the middle of the order when all centres fall together.
int MeshDistance::BuildNode(std::vector<Item>& items, int begin, int end, int depth) {
  AlignedBox centres;
  for (int i = begin; i < end; ++i) centres.extend(items[i].centre);
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  int middle = (begin + end) / 2;
  const double low = centres.min()[axis], size = centres.sizes()[axis];
  if (size > 0.0 && depth < kMaxDepth) {
    constexpr int kBins = 16;
    const auto bin_of = [&](const Item& item) {
      return std::min(kBins - 1, static_cast<int>(kBins * (item.centre[axis] - low) / size));
    };
    std::array<AlignedBox, kBins> boxes;
    std::array<int, kBins> counts{};
    for (int i = begin; i < end; ++i) {
      boxes[bin_of(items[i])].extend(items[i].box);
      ++counts[bin_of(items[i])];
    }
    const auto half_area = [](const AlignedBox& box) {
      const Vector3 s = box.sizes();
      return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
    };
    std::array<double, kBins> right_cost{};
    AlignedBox box;
    int count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      box.extend(boxes[b]);
      count += counts[b];
      right_cost[b] = count == 0 ? 0.0 : count * half_area(box);
    }
    box.setEmpty();
    count = 0;
    double best = std::numeric_limits<double>::infinity();
    int best_bin = 0;
    for (int b = 0; b + 1 < kBins; ++b) {
      box.extend(boxes[b]);
      count += counts[b];
      if (count == 0 || count == end - begin) continue;
      const double cost = count * half_area(box) + right_cost[b + 1];
      if (cost < best) {
        best = cost;
        best_bin = b;
      }
    }
    middle = static_cast<int>(
        std::stable_partition(items.begin() + begin, items.begin() + end,
                              [&](const Item& item) { return bin_of(item) <= best_bin; }) -
        items.begin());
  }
  if (end - begin == 1) middle = end;  // a mesh of one triangle: the right child stays empty
  const int node = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  BuildChild(items, begin, middle, node, 0, depth);
  BuildChild(items, middle, end, node, 1, depth);
  return node;
}

void MeshDistance::BuildChild(std::vector<Item>& items, int begin, int end, int node, int side,
                              int depth) {
  AlignedBox box;
  for (int i = begin; i < end; ++i) box.extend(items[i].box);
  nodes_[node].low[side] = box.min();
  nodes_[node].high[side] = box.max();
  nodes_[node].count[side] = end - begin;
  if (end - begin <= kLeafSize) {
    nodes_[node].child[side] = ~static_cast<int>(triangles_.size());
    for (int i = begin; i < end; ++i) triangles_.push_back(items[i].triangle);
    return;
  }
  const int child = BuildNode(items, begin, end, depth + 1);
  nodes_[node].child[side] = child;
}

MeshDistance::Hit MeshDistance::NearestOnEdges(const Triangle& t, const Vector3& p_B) {
  const std::array<Vector3, 3> start{t.a, t.a + t.ab, t.a + t.ac};
  Hit best;
  double best_squared = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vector3 edge = start[(i + 1) % 3] - start[i];
    const double length_squared = edge.squaredNorm();
    const double s = length_squared > 0.0 ? edge.dot(p_B - start[i]) / length_squared : 0.0;
    Hit hit;
    if (s <= 0.0) {
      hit = {start[i], 4 + i};
    } else if (s >= 1.0) {
      hit = {start[(i + 1) % 3], 4 + (i + 1) % 3};
    } else {
      hit = {start[i] + s * edge, 1 + i};
    }
    const double squared = (p_B - hit.p_B).squaredNorm();
    if (squared < best_squared) {
      best_squared = squared;
      best = hit;
    }
  }
  return best;
}

// By Voronoi regions (Ericson 2005, "Real-time collision detection", section 5.1.5).
MeshDistance::Hit MeshDistance::NearestOnTriangle(const Triangle& t, const Vector3& p_B) {
  const Vector3 ap = p_B - t.a;
  const double d1 = t.ab.dot(ap), d2 = t.ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {t.a, 4};
  const Vector3 bp = ap - t.ab;
  const double d3 = t.ab.dot(bp), d4 = t.ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return {t.a + t.ab, 5};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {t.a + (d1 / (d1 - d3)) * t.ab, 1};
  const Vector3 cp = ap - t.ac;
  const double d5 = t.ab.dot(cp), d6 = t.ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return {t.a + t.ac, 6};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {t.a + (d2 / (d2 - d6)) * t.ac, 3};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {t.a + t.ab + s * (t.ac - t.ab), 2};
  }
  // Along the unit normal: more exact than barycentric coordinates on thin triangles.
  return {p_B - t.nhat.dot(ap) * t.nhat, 0};
}

void MeshDistance::SearchLeaf(int first, int count, const Vector3& p_B, Search& search) const {
  for (int i = first; i < first + count; ++i) {
    const Triangle& t = triangles_[i];
    const double height = t.nhat.dot(p_B - t.a);
    if (height * height >= search.best) continue;
    const Hit hit = t.nhat.isZero(0.0) ? NearestOnEdges(t, p_B) : NearestOnTriangle(t, p_B);
    const double squared = (p_B - hit.p_B).squaredNorm();
    if (squared < search.best) {
      search.best = squared;
      search.triangle = i;
      search.hit = hit;
    }
  }
}

NearestPoint MeshDistance::FindNearest(const Vector3& p_B) const {
  struct Entry {
    double squared;
    int child, count;
  };
  std::array<Entry, kStackSize> stack;  // NOLINT: filled before it is read
  int top = 0;
  stack[top++] = {0.0, 0, 0};
  Search search;
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.squared >= search.best) continue;
    if (entry.child < 0) {
      SearchLeaf(~entry.child, entry.count, p_B, search);
      continue;
    }
    const Node& node = nodes_[entry.child];
    const double d0 = SquaredDistanceToBox(node.low[0], node.high[0], p_B);
    const double d1 = node.count[1] > 0 ? SquaredDistanceToBox(node.low[1], node.high[1], p_B)
                                        : std::numeric_limits<double>::infinity();
    const int near = d1 < d0 ? 1 : 0;
    stack[top++] = {near == 0 ? d1 : d0, node.child[1 - near], node.count[1 - near]};
    stack[top++] = {near == 0 ? d0 : d1, node.child[near], node.count[near]};
  }
  NearestPoint nearest;
  nearest.triangle = triangles_[search.triangle].face;
  nearest.p_B = search.hit.p_B;
  nearest.nhat = feature_normals_[search.triangle][search.hit.feature];
  nearest.distance = std::sqrt(search.best);
  return nearest;
}

DistanceSample MeshDistance::CalcWithGradient(const Vector3& p_B) const {
  const NearestPoint nearest = FindNearest(p_B);
  const Vector3 away = p_B - nearest.p_B;
  const bool outside = away.dot(nearest.nhat) >= 0.0;
  const double phi = outside ? nearest.distance : -nearest.distance;
  // Nearer than this the difference is mostly rounding, and the pseudonormal is its limit.
  constexpr double kTouching = 1e-9;  // [m]
  if (nearest.distance < kTouching) {
    // A knife edge between two opposite faces has no pseudonormal.
    return {phi, nearest.nhat.isZero(0.0) ? Vector3::UnitZ() : nearest.nhat};
  }
  return {phi, away / phi};
}

}  // namespace pregrasp
