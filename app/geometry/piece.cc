#include "app/geometry/piece.h"

#include <algorithm>
#include <limits>

#include "app/core/error.h"
#include "app/core/rng.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/triangle_samples.h"

namespace pregrasp {
namespace {

// Points of a hull that judge how far it reaches outside: one on each square of so many times the
// length that it may, but not too few or too many.
constexpr double kSampleSpacing = 4.0;
constexpr int kFewestSamples = 160, kMostSamples = 1500;

// Share of the solid's diagonal, so that cuts through the corners of a polygon make no slivers.
constexpr double kSnap = 1e-6;

// Shares of the hulls' tolerance: until they are finished, and to compare cuts by.
constexpr double kWorkingShare = 0.5;
constexpr double kRoughShare = 4.0;

// At most so many triangles span a hull.
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kFew = 1000;

MatrixX3 GatherCorners(const std::vector<const Piece*>& members) {
  int rows = 0;
  for (const Piece* member : members) rows += static_cast<int>(member->hull.V.rows());
  MatrixX3 P(rows, 3);
  int next = 0;
  for (const Piece* member : members) {
    P.middleRows(next, member->hull.V.rows()) = member->hull.V;
    next += static_cast<int>(member->hull.V.rows());
  }
  return P;
}

}  // namespace

PieceMaker::PieceMaker(const TriangleMesh& mesh, const DecomposeConfig& config)
    : mesh_(mesh),
      config_(config),
      distance_(mesh),
      roughly_(distance_),
      size_(distance_.bounds().sizes().norm()) {}

double PieceMaker::snap() const { return kSnap * size_; }

Piece PieceMaker::MakeWhole() const {
  Piece whole;
  whole.parts.push_back(MakeSolidPart(mesh_));
  Close(whole);
  Measure(whole);
  return whole;
}

Piece PieceMaker::CutBelow(const Piece& piece, const Plane& plane) const {
  Piece below;
  for (const SolidPart& part : piece.parts) {
    below.parts.push_back(pregrasp::CutBelow(part, plane, snap()));
    if (below.parts.back().surface.empty()) below.parts.pop_back();
  }
  return below;
}

MatrixX3 PieceMaker::GatherPoints(const Piece& piece, std::size_t most) const {
  std::size_t triangles = 0;
  for (const SolidPart& part : piece.parts) triangles += part.surface.size();
  const std::size_t stride = 1 + triangles / most;
  std::vector<Vector3> points;
  for (const SolidPart& part : piece.parts) AppendHullPoints(part, distance_, stride, points);
  MatrixX3 P(static_cast<int>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) P.row(i) = points[i].transpose();
  return P;
}

bool PieceMaker::Close(Piece& piece) const {
  return CloseAround(GatherPoints(piece, kAll), kWorkingShare * config_.tolerance, piece);
}

bool PieceMaker::CloseRoughly(Piece& piece) const {
  return CloseAround(GatherPoints(piece, kFew), kRoughShare * config_.tolerance, piece);
}

void PieceMaker::Finish(Piece& piece) const {
  CloseAround(GatherPoints(piece, kAll), config_.tolerance, piece);
}

bool PieceMaker::CloseAround(const MatrixX3& P, double tolerance, Piece& piece) const {
  if (P.rows() < 4) return false;
  try {
    piece.hull = CalcReducedHull(P, tolerance, config_.max_vertices);
  } catch (const InputError&) {
    return false;
  }
  piece.bounds = {Vector3(piece.hull.V.colwise().minCoeff()),
                  Vector3(piece.hull.V.colwise().maxCoeff())};
  piece.volume = CalcVolume(piece.hull);
  return true;
}

void PieceMaker::Measure(Piece& piece, int finer) const {
  const TriangleMesh& hull = piece.hull;
  double farthest = 0.0;
  const auto visit = [&](const Vector3& p) { farthest = roughly_.CalcAbove(p, farthest); };
  std::vector<double> sums;
  double sum = 0.0;
  for (int f = 0; f < hull.F.rows(); ++f) {
    const Triangle t = FaceOf(hull, f);
    sums.push_back(sum += AreaOf(t));
    visit((t[0] + t[1] + t[2]) / 3.0);
    for (int i = 0; i < 3; ++i) {
      if (hull.F(f, i) < hull.F(f, (i + 1) % 3)) visit(0.5 * (t[i] + t[(i + 1) % 3]));
    }
  }
  Rng rng(0, RngStream::kPieceSamples);
  const double spacing = kSampleSpacing * config_.concavity;
  const int samples =
      static_cast<int>(std::clamp<double>(sum / (spacing * spacing), kFewestSamples, kMostSamples));
  VisitSamples(
      sums, finer * samples, rng, [&](int f) { return FaceOf(hull, f); }, visit);
  piece.protrusion = farthest;
}

bool PieceMaker::Join(const std::vector<const Piece*>& members, Piece& joined, int finer) const {
  if (!CloseAround(GatherCorners(members), kWorkingShare * config_.tolerance, joined)) return false;
  Measure(joined, finer);
  return true;
}

bool PieceMaker::JoinRoughly(const std::vector<const Piece*>& members, Piece& joined) const {
  if (!CloseAround(GatherCorners(members), kRoughShare * config_.tolerance, joined)) return false;
  Measure(joined);
  return true;
}

}  // namespace pregrasp
