#include "app/dynamics/gjk.h"

#include <array>
#include <cmath>
#include <limits>

#include "app/dynamics/support.h"

namespace pregrasp {
namespace {

constexpr int kMaxIterations = 64;
// Relative gap between the bounds on the squared distance at which the search ends.
constexpr double kGapTolerance = 1e-14;
// The shift leaves at least this much room between the shapes [m], enough for an accurate direction
// and small against their radii of curvature.
constexpr double kRoom = 1e-4;
constexpr double kFlatTetrahedron = 1e-8;
constexpr int kMaxRefinements = 8;
constexpr double kTurnTolerance2 = 1e-14;  // square of an angle [rad^2]

// A vertex of the Minkowski difference B - A, with the points it came from.
struct Vertex {
  Vector3 w, a, b;
};

// Up to four vertices with the weights that give the point nearest to the origin.
struct Simplex {
  std::array<Vertex, 4> vertices;
  std::array<double, 4> weights{};
  int size = 0;

  Vector3 Nearest() const {
    Vector3 v = Vector3::Zero();
    for (int i = 0; i < size; ++i) v += weights[i] * vertices[i].w;
    return v;
  }
};

// Weights of the point of a feature nearest to the origin; zero marks a vertex that is not needed.
using Weights = std::array<double, 4>;

double NearestOnSegment(const Vector3& p, const Vector3& q, double* weight_q) {
  const Vector3 d = q - p;
  const double length2 = d.squaredNorm();
  *weight_q = length2 > 0.0 ? std::min(1.0, std::max(0.0, -p.dot(d) / length2)) : 0.0;
  return (p + *weight_q * d).squaredNorm();
}

// Nearest point of triangle (i, j, k): inside if its projection is, else on an edge.
double NearestOnTriangle(const std::array<Vertex, 4>& v, int i, int j, int k, Weights* weights) {
  const Vector3 &p = v[i].w, &q = v[j].w, &r = v[k].w;
  const Vector3 n = (q - p).cross(r - p);
  const double area2 = n.squaredNorm();
  const double u_p = n.dot(q.cross(r)), u_q = n.dot(r.cross(p)), u_r = n.dot(p.cross(q));
  if (area2 > 0.0 && u_p > 0.0 && u_q > 0.0 && u_r > 0.0) {
    const double sum = u_p + u_q + u_r;
    *weights = {};
    (*weights)[i] = u_p / sum;
    (*weights)[j] = u_q / sum;
    (*weights)[k] = u_r / sum;
    return ((*weights)[i] * p + (*weights)[j] * q + (*weights)[k] * r).squaredNorm();
  }
  double best = std::numeric_limits<double>::infinity();
  const std::array<std::array<int, 2>, 3> edges = {{{i, j}, {j, k}, {k, i}}};
  for (const auto& [from, to] : edges) {
    double weight = 0.0;
    const double distance2 = NearestOnSegment(v[from].w, v[to].w, &weight);
    if (distance2 < best) {
      best = distance2;
      *weights = {};
      (*weights)[from] = 1.0 - weight;
      (*weights)[to] = weight;
    }
  }
  return best;
}

// Reduces the simplex to the feature nearest to the origin. Returns false if the origin is inside.
bool ReduceSimplex(Simplex* simplex) {
  std::array<Vertex, 4>& v = simplex->vertices;
  Weights weights{};
  if (simplex->size == 1) {
    weights[0] = 1.0;
  } else if (simplex->size == 2) {
    double weight = 0.0;
    NearestOnSegment(v[0].w, v[1].w, &weight);
    weights = {1.0 - weight, weight, 0.0, 0.0};
  } else if (simplex->size == 3) {
    NearestOnTriangle(v, 0, 1, 2, &weights);
  } else {
    constexpr std::array<std::array<int, 4>, 4> kFaces = {
        {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
    double best = std::numeric_limits<double>::infinity();
    for (const auto& [i, j, k, opposite] : kFaces) {
      const Vector3 n = (v[j].w - v[i].w).cross(v[k].w - v[i].w);
      const Vector3 to_opposite = v[opposite].w - v[i].w;
      const double side_origin = -n.dot(v[i].w), side_opposite = n.dot(to_opposite);
      // Of a flat tetrahedron no side is the inner one.
      const bool flat = std::abs(side_opposite) <= kFlatTetrahedron * n.norm() * to_opposite.norm();
      if (!flat && side_origin * side_opposite > 0.0) continue;  // the origin is on the inner side
      Weights candidate{};
      const double distance2 = NearestOnTriangle(v, i, j, k, &candidate);
      if (distance2 < best) {
        best = distance2;
        weights = candidate;
      }
    }
    if (std::isinf(best)) return false;
  }
  int kept = 0;
  for (int i = 0; i < simplex->size; ++i) {
    if (weights[i] <= 0.0) continue;
    v[kept] = v[i];
    simplex->weights[kept] = weights[i];
    ++kept;
  }
  simplex->size = kept;
  return true;
}

}  // namespace

CoreDistance CalcCoreDistance(const PlacedConvex& a, const PlacedConvex& b,
                              const Vector3& shift_W) {
  CoreDistance result;
  Simplex simplex;
  Vector3 v = b.p_WP + shift_W - a.p_WP;
  if (v.squaredNorm() == 0.0) v = Vector3::UnitZ();
  double best2 = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Vertex vertex;
    vertex.a = CalcSupport(a, v);
    vertex.b = CalcSupport(b, -v) + shift_W;
    vertex.w = vertex.b - vertex.a;
    const double distance2 = v.squaredNorm();
    if (iteration > 0) {
      bool repeated = false;
      for (int i = 0; i < simplex.size; ++i) {
        repeated = repeated || (simplex.vertices[i].w - vertex.w).squaredNorm() == 0.0;
      }
      if (repeated || distance2 - v.dot(vertex.w) <= kGapTolerance * distance2) break;
    }
    Simplex next = simplex;
    next.vertices[next.size++] = vertex;
    if (!ReduceSimplex(&next)) return result;
    const Vector3 v_next = next.Nearest();
    const double next2 = v_next.squaredNorm();
    if (next2 < 1e-24) return result;
    if (iteration > 0 && next2 >= best2) break;  // rounding has stopped the progress
    best2 = next2;
    simplex = next;
    v = v_next;
  }
  result.apart = true;
  result.distance = v.norm();
  result.nhat_W = v / result.distance;
  for (int i = 0; i < simplex.size; ++i) {
    result.p_WA += simplex.weights[i] * simplex.vertices[i].a;
    result.p_WB += simplex.weights[i] * (simplex.vertices[i].b - shift_W);
  }
  return result;
}

ContactAxis RefineAxis(const PlacedConvex& a, const PlacedConvex& b, const Vector3& nhat_W) {
  const double radius_a = CoreRadius(*a.convex), radius_b = CoreRadius(*b.convex);
  ContactAxis axis{nhat_W, CalcSeparation(a, b, nhat_W), Vector3::Zero(), Vector3::Zero()};
  double shift = 0.0;  // the first time none: of shapes that are apart this is the whole answer
  for (int iteration = 0; iteration < kMaxRefinements; ++iteration) {
    const CoreDistance cores = CalcCoreDistance(a, b, shift * axis.nhat_W);
    if (cores.apart) {
      const double turn2 = (cores.nhat_W - axis.nhat_W).squaredNorm();
      axis.nhat_W = cores.nhat_W;
      axis.separation = CalcSeparation(a, b, axis.nhat_W);
      axis.p_WA = cores.p_WA + radius_a * cores.nhat_W;
      axis.p_WB = cores.p_WB - radius_b * cores.nhat_W;
      if (cores.distance >= kRoom && (shift == 0.0 || turn2 < kTurnTolerance2)) break;
    }
    shift = std::max(0.0, kRoom - (axis.separation + radius_a + radius_b));
  }
  return axis;
}

}  // namespace pregrasp
