#include "app/geometry/contact_faces.h"

#include <cmath>
#include <limits>

#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

constexpr double kOnEdge = 1e-7;   // [m]; nearer than this, a point lies on the edge
constexpr double kTip = 1e-5;      // [m]; where a face is narrower, it ends in a point
constexpr double kBeyond = 1e-8;   // [m]; moved so much farther than needed, above rounding
constexpr double kFacing = 0.7;    // the cosine of about 45 degrees
constexpr int kMaxMoves = 32;      // a corner takes two or three
constexpr int kMaxCrossings = 64;  // triangles that one walk passes

// Keeps the nearest of the candidates, the first of equals.
struct Nearest {
  const Vector3& p_B;
  FacePoint best;
  double squared = std::numeric_limits<double>::infinity();

  void Offer(const FacePoint& candidate) {
    const double candidate_squared = (candidate.p_B - p_B).squaredNorm();
    if (!(candidate_squared < squared)) return;
    squared = candidate_squared;
    best = candidate;
  }
};

Vector3 NearestOnSegment(const Vector3& a, const Vector3& b, const Vector3& p) {
  const Vector3 ab = b - a;
  const double squared = ab.squaredNorm();
  const double s = squared > 0.0 ? std::clamp(ab.dot(p - a) / squared, 0.0, 1.0) : 0.0;
  return a + s * ab;
}

}  // namespace

FacePoint ProjectToFace(const Box& box, const Vector3& p_B) {
  const Vector3 half = 0.5 * box.size;
  Vector3 inside;
  for (int k = 0; k < 3; ++k) {
    const double reach = half[k] - CalcEdgeInset(box.size[k]);
    inside[k] = std::clamp(p_B[k], -reach, reach);
  }
  Nearest nearest{p_B, {}};
  for (int axis = 0; axis < 3; ++axis) {
    FacePoint face{inside, Vector3::Zero()};
    face.nhat_B[axis] = internal::SignOf(p_B[axis]);
    face.p_B[axis] = face.nhat_B[axis] * half[axis];
    nearest.Offer(face);
  }
  return nearest.best;
}

FacePoint ProjectToFace(const Cylinder& cylinder, const Vector3& p_B) {
  const double rho = p_B.head<2>().norm();
  const Vector2 radial = internal::RadialDirection(p_B, rho);
  const double half = 0.5 * cylinder.height;
  const double up = internal::SignOf(p_B.z());
  const double reach = half - CalcEdgeInset(cylinder.height);
  const double rim = std::min(rho, cylinder.radius - CalcEdgeInset(2.0 * cylinder.radius));
  Nearest nearest{p_B, {}};
  FacePoint side;
  side.p_B << cylinder.radius * radial, std::clamp(p_B.z(), -reach, reach);
  side.nhat_B << radial, 0.0;
  nearest.Offer(side);
  FacePoint end;
  end.p_B << rim * radial, up * half;
  end.nhat_B << 0.0, 0.0, up;
  nearest.Offer(end);
  return nearest.best;
}

FacePoint ProjectToFace(const Capsule& capsule, const Vector3& p_B) {
  const DistanceSample sample = CalcDistanceWithGradient(capsule, p_B);
  return {p_B - sample.phi * sample.nhat, sample.nhat};
}

FacePoint ProjectToFace(const Sphere& sphere, const Vector3& p_B) {
  const DistanceSample sample = CalcDistanceWithGradient(sphere, p_B);
  return {p_B - sample.phi * sample.nhat, sample.nhat};
}

MeshFaces::MeshFaces(const TriangleMesh& mesh) {
  const std::vector<std::array<int, 3>> neighbours = FindNeighbours(mesh);
  const std::vector<Vector3> nhats = CalcFaceNormals(mesh, neighbours);
  triangles_.resize(mesh.F.rows());
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int i = 0; i < 3; ++i) triangles_[f].p[i] = mesh.V.row(mesh.F(f, i));
    triangles_[f].nhat = nhats[f];
  }
  FindEdges(neighbours);
  near_.resize(triangles_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) ListNearEdges(static_cast<int>(e));
}

void MeshFaces::FindEdges(const std::vector<std::array<int, 3>>& neighbours) {
  const double least_cosine = std::cos(kSharpAngle) - 1e-9;
  for (int f = 0; f < static_cast<int>(triangles_.size()); ++f) {
    Triangle& t = triangles_[f];
    t.across = neighbours[f];
    for (int i = 0; i < 3; ++i) {
      const int g = t.across[i];
      if (g < 0) continue;
      const Vector3& nhat = triangles_[g].nhat;
      if (t.nhat.dot(nhat) >= least_cosine) continue;
      t.across[i] = -1;
      const Vector3& a = t.p[i];
      const Vector3& b = t.p[(i + 1) % 3];
      const bool hollow = t.nhat.cross(nhat).dot(b - a) < 0.0;
      if (!hollow && f < g) edges_.push_back({a, b, {f, g}});
    }
  }
}

// Over each of the edge's faces, triangle by triangle, as far as boxes around them are near.
void MeshFaces::ListNearEdges(int edge) {
  const Edge& e = edges_[edge];
  AlignedBox around;
  around.extend(e.a).extend(e.b);
  const auto is_near = [&](const Triangle& t) {
    AlignedBox box;
    for (const Vector3& p : t.p) box.extend(p);
    return box.squaredExteriorDistance(around) <= kEdgeInset * kEdgeInset;
  };
  std::vector<int> open(e.sides.begin(), e.sides.end());
  for (const int side : e.sides) near_[side].push_back(edge);
  while (!open.empty()) {
    const Triangle& t = triangles_[open.back()];
    open.pop_back();
    for (const int g : t.across) {
      if (g < 0 || (!near_[g].empty() && near_[g].back() == edge)) continue;
      if (!is_near(triangles_[g])) continue;
      near_[g].push_back(edge);
      open.push_back(g);
    }
  }
}

// Straight on over the edges between triangles, as if they were unfolded.
MeshFaces::Walk MeshFaces::WalkOver(const Place& from, Vector3 along, double length) const {
  Walk walk{from};
  for (int crossing = 0; crossing < kMaxCrossings; ++crossing) {
    const Triangle& t = triangles_[walk.end.triangle];
    double step = length - walk.length;
    int out = -1;
    for (int i = 0; i < 3; ++i) {
      const Vector3 inward = t.nhat.cross(t.p[(i + 1) % 3] - t.p[i]);
      const double speed = -inward.dot(along);
      if (!(speed > 1e-12 * inward.norm())) continue;
      const double until = std::max(0.0, inward.dot(walk.end.p - t.p[i]) / speed);
      if (until >= step) continue;
      step = until;
      out = i;
    }
    walk.end.p += step * along;
    walk.length += step;
    if (out < 0) return walk;
    const int next = t.across[out];
    const Vector3 edge = (t.p[(out + 1) % 3] - t.p[out]).normalized();
    const Vector3 beyond = edge.cross(t.nhat);
    if (next < 0) {
      walk.blocked = true;
      walk.head_on = along.dot(beyond);
      return walk;
    }
    const Vector3 beyond_next = edge.cross(triangles_[next].nhat);
    along = along.dot(edge) * edge + along.dot(beyond) * beyond_next;
    walk.end.triangle = next;
  }
  return walk;
}

// The direction in the place's triangle that leads away from the edge's point p_edge.
Vector3 MeshFaces::DirectionInward(const Edge& edge, const Place& place,
                                   const Vector3& p_edge) const {
  const Triangle& t = triangles_[place.triangle];
  const auto flatten = [&](const Vector3& v) { return Vector3(v - t.nhat.dot(v) * t.nhat); };
  const Vector3 away = flatten(place.p - p_edge);
  if (away.norm() > kOnEdge) return away.normalized();
  if (place.triangle == edge.sides[0]) return t.nhat.cross(edge.b - edge.a).normalized();
  if (place.triangle == edge.sides[1]) return t.nhat.cross(edge.a - edge.b).normalized();
  return flatten((t.p[0] + t.p[1] + t.p[2]) / 3.0 - place.p).normalized();
}

// How far to go inward from an edge that is `distance` away; nothing to do if not above 0. A face
// is narrow where the edge across faces this one; where they meet in a corner it is not.
double MeshFaces::CalcWayInside(const Walk& across, double distance) {
  if (!across.blocked) return kEdgeInset - distance;
  if (across.head_on >= kFacing) return CalcEdgeInset(distance + across.length) - distance;
  constexpr double kShareOfWay = 0.9;  // towards a corner's other edge, which then asks for more
  return std::min(kEdgeInset - distance, kShareOfWay * across.length);
}

// Away from the nearest edge that is too near; false if there is none.
bool MeshFaces::MoveInside(Place& place) const {
  double nearest = kEdgeInset;
  Place moved = place;
  bool found = false;
  for (const int e : near_[place.triangle]) {
    const Edge& edge = edges_[e];
    const Vector3 p_edge = NearestOnSegment(edge.a, edge.b, place.p);
    const double distance = (place.p - p_edge).norm();
    if (!(distance < nearest)) continue;
    Vector3 inward = DirectionInward(edge, place, p_edge);
    const Walk across = WalkOver(place, inward, 4.0 * kEdgeInset - distance);
    double way = CalcWayInside(across, distance);
    if (across.blocked && distance + across.length < kTip) {  // a corner: between its edges
      const Triangle& t = triangles_[place.triangle];
      inward = (t.p[0] + t.p[1] + t.p[2]) / 3.0 - place.p;
      way = std::min(kEdgeInset, 0.5 * inward.norm());
      inward.normalize();
    }
    if (way <= 0.0) continue;
    nearest = distance;
    moved = WalkOver(place, inward, way + kBeyond).end;
    found = true;
  }
  place = moved;
  return found;
}

FacePoint MeshFaces::MoveInsideAll(Place place) const {
  for (int move = 0; move < kMaxMoves && MoveInside(place); ++move) {
  }
  return {place.p, triangles_[place.triangle].nhat};
}

FacePoint MeshFaces::Project(const MeshDistance& distance, const Vector3& p_B) const {
  const NearestPoint surface = distance.FindNearest(p_B);
  if (near_[surface.triangle].empty()) return {surface.p_B, triangles_[surface.triangle].nhat};
  Nearest nearest{p_B, {}};
  nearest.Offer(MoveInsideAll({surface.triangle, surface.p_B}));
  for (const int e : near_[surface.triangle]) {
    const Edge& edge = edges_[e];
    const Vector3 p_edge = NearestOnSegment(edge.a, edge.b, surface.p_B);
    if ((surface.p_B - p_edge).norm() > kEdgeInset) continue;
    for (const int side : edge.sides) {
      const Vector3& nhat = triangles_[side].nhat;
      const Vector3 along = p_B - p_edge - nhat.dot(p_B - p_edge) * nhat;
      const Place foot = WalkOver({side, p_edge}, along.normalized(), along.norm()).end;
      nearest.Offer(MoveInsideAll(foot));
    }
  }
  return nearest.best;
}

}  // namespace pregrasp
