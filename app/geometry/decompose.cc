#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "app/core/error.h"
#include "app/core/rng.h"
#include "app/core/text.h"
#include "app/geometry/cut_finder.h"
#include "app/geometry/distance_bounds.h"
#include "app/geometry/hull.h"
#include "app/geometry/mesh_cut.h"
#include "app/geometry/mesh_distance.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/tessellate.h"
#include "app/geometry/triangle_samples.h"

namespace pregrasp {
namespace {

constexpr int kTrials = 4;         // cuts that are tried out, the best by pairs
constexpr int kHullSamples = 160;  // points of a hull that judge how far it reaches outside
constexpr int kOvercut = 3;        // pieces before merging, in multiples of those wanted

// One or, after merging, several parts of the solid, with their joint hull.
struct Piece {
  std::vector<SolidPart> parts;
  TriangleMesh hull;
  AlignedBox bounds;
  double protrusion = 0.0;  // of the hull outside the solid [m]
  bool whole = false;       // no plane cuts it well
};

class Decomposer {
 public:
  Decomposer(const TriangleMesh& mesh, const DecomposeConfig& config)
      : mesh_(mesh),
        config_(config),
        distance_(mesh),
        roughly_(distance_),
        size_(distance_.bounds().sizes().norm()),
        cuts_(mesh, roughly_, size_) {}

  std::vector<TriangleMesh> Run() {
    Piece all;
    all.parts.push_back(MakeSolidPart(mesh_));
    Close(all);
    if (all.protrusion > config_.concavity) cuts_.FindReflexPlanes();
    pieces_.push_back(std::move(all));
    while (static_cast<int>(pieces_.size()) < kOvercut * config_.max_pieces && CutWorst()) {
    }
    Merge();
    Improve();
    std::vector<TriangleMesh> hulls;
    hulls.reserve(pieces_.size());
    for (Piece& piece : pieces_) hulls.push_back(std::move(piece.hull));
    return hulls;
  }

 private:
  struct Halves {
    std::vector<Piece> pieces;  // one when the other has no volume
    double worst = std::numeric_limits<double>::infinity();
    double sum = 0.0;
  };

  // Fills in hull, bounds and protrusion from the parts; false for a piece without volume.
  bool Close(Piece& piece) const {
    std::vector<Vector3> points;
    for (const SolidPart& part : piece.parts) AppendHullPoints(part, distance_, points);
    MatrixX3 P(static_cast<int>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) P.row(i) = points[i].transpose();
    return CloseAround(P, piece);
  }

  bool CloseAround(const MatrixX3& P, Piece& piece) const {
    try {
      piece.hull = CalcReducedHull(P, config_.tolerance, config_.max_vertices);
    } catch (const InputError&) {
      return false;
    }
    piece.bounds = {Vector3(piece.hull.V.colwise().minCoeff()),
                    Vector3(piece.hull.V.colwise().maxCoeff())};
    piece.protrusion = CalcFarthestOutside(piece.hull);
    return true;
  }

  double CalcFarthestOutside(const TriangleMesh& hull) const {
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
    Rng rng(0, RngStream::kDecomposition, 2);
    VisitSamples(
        sums, kHullSamples, rng, [&](int f) { return FaceOf(hull, f); }, visit);
    return farthest;
  }

  Halves CutAlong(const Piece& piece, const Plane& plane) const {
    Halves halves;
    halves.worst = 0.0;
    for (const Plane& side : {plane, plane.Turned()}) {
      Piece half;
      for (const SolidPart& part : piece.parts) {
        half.parts.push_back(CutBelow(part, side, 1e-9 * size_));
        if (half.parts.back().surface.empty()) half.parts.pop_back();
      }
      if (half.parts.empty() || !Close(half)) continue;
      halves.worst = std::max(halves.worst, half.protrusion);
      halves.sum += half.protrusion;
      halves.pieces.push_back(std::move(half));
    }
    return halves;
  }

  // Of the cuts that pairs favour, the one whose hulls reach least outside.
  Halves FindHalves(const Piece& piece) const {
    Halves best;
    std::vector<Plane> tried;
    for (const Cut& cut : cuts_.Find(piece.parts)) {
      const bool similar = std::any_of(tried.begin(), tried.end(), [&](const Plane& other) {
        const double along = other.nhat.dot(cut.plane.nhat);
        const double apart = other.offset - std::copysign(1.0, along) * cut.plane.offset;
        return std::abs(along) > 0.99 && std::abs(apart) < 0.02 * size_;
      });
      if (similar) continue;
      tried.push_back(cut.plane);
      Halves halves = CutAlong(piece, cut.plane);
      if (halves.pieces.size() == 2 &&
          std::make_pair(halves.worst, halves.sum) < std::make_pair(best.worst, best.sum)) {
        best = std::move(halves);
      }
      if (tried.size() == kTrials) break;
    }
    return best;
  }

  int FindWorst() const {
    int worst = -1;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].whole || pieces_[i].protrusion <= config_.concavity) continue;
      if (worst < 0 || pieces_[i].protrusion > pieces_[worst].protrusion) {
        worst = static_cast<int>(i);
      }
    }
    return worst;
  }

  // Cuts the piece that reaches farthest outside; false when none is left to cut.
  bool CutWorst() {
    const int worst = FindWorst();
    if (worst < 0) return false;
    Halves halves = FindHalves(pieces_[worst]);
    if (halves.pieces.empty()) {
      pieces_[worst].whole = true;
      return true;
    }
    pieces_.erase(pieces_.begin() + worst);
    for (Piece& half : halves.pieces) pieces_.push_back(std::move(half));
    return true;
  }

  // Two pieces that may become one. The protrusion of their joint hull is worked out when `exact`;
  // before that it is a lower bound.
  struct Joint {
    double protrusion = 0.0;
    bool exact = false;
    std::size_t i = 0, j = 0;

    bool operator<(const Joint& other) const {
      return std::tie(protrusion, i, j) < std::tie(other.protrusion, other.i, other.j);
    }
  };

  // How far lines between corners of the two hulls leave the solid: some of the joint hull.
  double BoundJoint(const Piece& a, const Piece& b) const {
    double farthest = 0.0;
    constexpr int kLines = 24;
    for (int k = 0; k < kLines; ++k) {
      const Vector3 p = a.hull.V.row((k * 7) % a.hull.V.rows());
      const Vector3 q = b.hull.V.row((k * 5) % b.hull.V.rows());
      farthest = roughly_.CalcAbove(0.5 * (p + q), farthest);
    }
    return farthest;
  }

  bool CloseJoint(const Joint& joint, Piece& piece) const {
    const MatrixX3 &V = pieces_[joint.i].hull.V, &W = pieces_[joint.j].hull.V;
    MatrixX3 P(V.rows() + W.rows(), 3);
    P << V, W;
    return CloseAround(P, piece);
  }

  void AddJoints(std::size_t i, const std::vector<bool>& gone, std::vector<Joint>& joints) const {
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      if (j == i || gone[j]) continue;
      AlignedBox reach = pieces_[i].bounds;
      reach.min().array() -= config_.concavity;
      reach.max().array() += config_.concavity;
      if (reach.intersection(pieces_[j].bounds).isEmpty()) continue;
      joints.push_back({BoundJoint(pieces_[i], pieces_[j]), false, i, j});
    }
  }

  // The joint that reaches least outside, worked out; none left when false.
  bool FindBestJoint(std::vector<Joint>& joints, Joint& best, Piece& piece) const {
    while (!joints.empty()) {
      const auto it = std::min_element(joints.begin(), joints.end());
      Piece closed;
      if (!CloseJoint(*it, closed)) {
        joints.erase(it);
        continue;
      }
      const bool was_exact = it->exact;
      it->exact = true;
      it->protrusion = closed.protrusion;
      if (was_exact || it == std::min_element(joints.begin(), joints.end())) {
        best = *it;
        piece = std::move(closed);
        return true;
      }
    }
    return false;
  }

  // Joins two pieces again and again, those first whose joint hull reaches least outside, as long
  // as it reaches no farther than allowed or there are too many pieces.
  void Merge() {
    std::vector<bool> gone(pieces_.size(), false);
    std::vector<Joint> joints;
    for (std::size_t i = pieces_.size(); i-- > 0;) {
      gone[i] = true;  // each pair once
      AddJoints(i, gone, joints);
    }
    gone.assign(pieces_.size(), false);
    auto count = static_cast<int>(pieces_.size());
    Joint best;
    Piece joined;
    while (FindBestJoint(joints, best, joined)) {
      if (count <= config_.max_pieces && joined.protrusion > config_.concavity) break;
      for (const std::size_t k : {best.i, best.j}) {
        std::move(pieces_[k].parts.begin(), pieces_[k].parts.end(),
                  std::back_inserter(joined.parts));
        gone[k] = true;
      }
      joints.erase(std::remove_if(joints.begin(), joints.end(),
                                  [&](const Joint& j) { return gone[j.i] || gone[j.j]; }),
                   joints.end());
      pieces_.push_back(std::move(joined));
      joined = {};
      gone.push_back(false);
      --count;
      AddJoints(pieces_.size() - 1, gone, joints);
    }
    std::vector<Piece> kept;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (!gone[i]) kept.push_back(std::move(pieces_[i]));
    }
    pieces_ = std::move(kept);
  }

  // Cuts the worst piece and joins two others in exchange, while that makes the worst less bad.
  void Improve() {
    for (int round = 0; round < 2 * config_.max_pieces; ++round) {
      const int worst = FindWorst();
      if (worst < 0) return;
      const double before = pieces_[worst].protrusion;
      Halves halves = FindHalves(pieces_[worst]);
      if (halves.pieces.empty() || halves.worst >= before) {
        pieces_[worst].whole = true;
        continue;
      }
      if (static_cast<int>(pieces_.size()) >= config_.max_pieces && !JoinBelow(before, worst)) {
        return;
      }
      // Joining has moved the worst piece to the front or left it in place.
      const int now = FindWorst();
      pieces_.erase(pieces_.begin() + now);
      for (Piece& half : halves.pieces) pieces_.push_back(std::move(half));
    }
  }

  // Joins the two pieces, not `except`, that reach least outside together, if that is less than
  // `limit`.
  bool JoinBelow(double limit, int except) {
    std::vector<bool> gone(pieces_.size(), false);
    std::vector<Joint> joints;
    gone[except] = true;
    for (std::size_t i = pieces_.size(); i-- > 0;) {
      if (gone[i]) continue;
      gone[i] = true;
      AddJoints(i, gone, joints);
    }
    joints.erase(std::remove_if(joints.begin(), joints.end(),
                                [&](const Joint& j) { return j.protrusion >= limit; }),
                 joints.end());
    Joint best;
    Piece joined;
    if (!FindBestJoint(joints, best, joined) || joined.protrusion >= limit) return false;
    for (const std::size_t k : {best.i, best.j}) {
      std::move(pieces_[k].parts.begin(), pieces_[k].parts.end(), std::back_inserter(joined.parts));
    }
    pieces_.erase(pieces_.begin() + std::max(best.i, best.j));
    pieces_.erase(pieces_.begin() + std::min(best.i, best.j));
    pieces_.push_back(std::move(joined));
    return true;
  }

  const TriangleMesh& mesh_;
  const DecomposeConfig& config_;
  MeshDistance distance_;
  DistanceBounds roughly_;
  double size_;
  CutFinder cuts_;
  std::vector<Piece> pieces_;
};

void Decompose(const Shape& shape, const RigidTransform& X_BP, const DecomposeConfig& config,
               std::vector<ConvexPiece>& pieces) {
  if (const auto* whole = std::get_if<Union>(&shape)) {
    for (const PlacedShape& part : whole->parts) {
      Decompose(part.shape, X_BP * part.X_BP, config, pieces);
    }
    return;
  }
  const TriangleMesh* mesh = nullptr;
  std::string file;
  if (const auto* read = std::get_if<Mesh>(&shape)) {
    mesh = &read->mesh;
    file = read->file;
  } else if (const auto* cloud = std::get_if<Cloud>(&shape)) {
    mesh = &cloud->mesh;
    file = cloud->file;
  } else {
    pieces.push_back({shape, X_BP});
    return;
  }
  for (TriangleMesh& hull : Decomposer(*mesh, config).Run()) {
    pieces.push_back({Mesh{file, 1.0, std::move(hull)}, X_BP});
  }
}

}  // namespace

void DecomposeConfig::Validate() const {
  const auto require = [](bool holds, const char* field, const char* expected, double got) {
    if (!holds) throw InputError("decompose", field, expected, FormatDouble(got));
  };
  require(max_pieces >= 1 && max_pieces <= 256, "max_pieces", "1 to 256", max_pieces);
  require(concavity > 0.0, "concavity", "a length above 0 m", concavity);
  require(tolerance > 0.0, "tolerance", "a length above 0 m", tolerance);
  require(max_vertices >= 8 && max_vertices <= 4096, "max_vertices", "8 to 4096", max_vertices);
}

std::vector<ConvexPiece> DecomposeConvex(const Shape& shape, const DecomposeConfig& config) {
  config.Validate();
  std::vector<ConvexPiece> pieces;
  Decompose(shape, RigidTransform::Identity(), config, pieces);
  return pieces;
}

double CalcProtrusion(const Shape& shape, const std::vector<ConvexPiece>& pieces) {
  const SignedDistance distance(shape);
  double farthest = 0.0;
  for (const ConvexPiece& piece : pieces) {
    const TriangleMesh mesh = Transformed(Tessellate(piece.shape), piece.X_BP);
    for (int f = 0; f < mesh.F.rows(); ++f) {
      const Triangle t = FaceOf(mesh, f);
      // About every 2 mm, as far as that is a reasonable number.
      const double longest =
          std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
      const int per_edge = std::clamp(static_cast<int>(longest / 0.002), 2, 40);
      for (int i = 0; i <= per_edge; ++i) {
        for (int j = 0; i + j <= per_edge; ++j) {
          const double s = static_cast<double>(i) / per_edge, u = static_cast<double>(j) / per_edge;
          farthest =
              std::max(farthest, distance.Calc(t[0] + s * (t[1] - t[0]) + u * (t[2] - t[0])));
        }
      }
    }
  }
  return farthest;
}

}  // namespace pregrasp
