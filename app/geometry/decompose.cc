#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <list>
#include <mutex>
#include <string>
#include <utility>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/sha256.h"
#include "app/core/text.h"
#include "app/geometry/cut_finder.h"
#include "app/geometry/hull.h"
#include "app/geometry/merge_pieces.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/piece.h"
#include "app/geometry/revolution.h"
#include "app/geometry/sectors.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/tessellate.h"
#include "app/geometry/triangle_samples.h"
#include "app/scene/shape_visit.h"

namespace pregrasp {
namespace {

constexpr int kTrials = 4;        // cuts that are tried out, the best by pairs
constexpr double kOvercut = 1.6;  // pieces before merging, in multiples of those wanted

// Share of its hull from which on a solid has no cavity worth more than a quarter of the pieces.
constexpr double kFull = 0.9;

class Decomposer {
 public:
  Decomposer(const TriangleMesh& mesh, const DecomposeConfig& config)
      : mesh_(mesh),
        config_(config),
        limit_(config.free_concavity),
        max_pieces_(config.max_pieces),
        maker_(mesh, config),
        cuts_(mesh, maker_.roughly(), maker_.size()) {}

  std::vector<TriangleMesh> Run() {
    Piece whole = maker_.MakeWhole();
    if (whole.protrusion > config_.concavity) {
      // Sectors of a mesh whose corners are not aligned, as of a scan, have no edges to follow.
      const auto revolution = FindRevolution(mesh_);
      if (revolution && revolution->sides > 0) {
        Sectors sectors = CutIntoSectors(maker_, *revolution, config_.concavity, most());
        pieces_ = std::move(sectors.pieces);
        if (!pieces_.empty()) limit_ = std::max(config_.concavity, sectors.protrusion);
      }
      cuts_.FindReflexPlanes();
    }
    if (pieces_.empty()) {
      if (CalcVolume(mesh_) > kFull * whole.volume) max_pieces_ = (max_pieces_ + 3) / 4;
      pieces_.push_back(std::move(whole));
    }
    while (static_cast<int>(pieces_.size()) < most() && CutWorst()) {
    }
    MergePieces(maker_, limit_, max_pieces_, pieces_);
    std::vector<TriangleMesh> hulls;
    hulls.reserve(pieces_.size());
    for (Piece& piece : pieces_) {
      maker_.Finish(piece);
      hulls.push_back(std::move(piece.hull));
    }
    return hulls;
  }

 private:
  int most() const { return static_cast<int>(kOvercut * max_pieces_); }  // pieces before merging

  struct Halves {
    std::vector<Piece> pieces;
    double worst = std::numeric_limits<double>::infinity();
    double sum = 0.0;
  };

  Halves CutAlong(const Piece& piece, const Plane& plane) const {
    Halves halves;
    halves.worst = 0.0;
    for (const Plane& side : {plane, plane.Turned()}) {
      Piece half = maker_.CutBelow(piece, side);
      if (half.parts.empty() || !maker_.CloseRoughly(half)) continue;
      maker_.Measure(half);
      halves.worst = std::max(halves.worst, half.protrusion);
      halves.sum += half.volume;
      halves.pieces.push_back(std::move(half));
    }
    return halves;
  }

  // Of the cuts that pairs favour, the one whose hulls reach least outside.
  Halves FindHalves(const Piece& piece) const {
    Halves best;
    std::vector<Plane> tried;
    for (const Cut& cut : cuts_.Find(piece.parts)) {
      ThrowIfInterrupted();
      const bool similar = std::any_of(tried.begin(), tried.end(), [&](const Plane& other) {
        const double along = other.nhat.dot(cut.plane.nhat);
        const double apart = other.offset - std::copysign(1.0, along) * cut.plane.offset;
        return std::abs(along) > 0.99 && std::abs(apart) < 0.02 * maker_.size();
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
    for (Piece& half : best.pieces) {
      maker_.Close(half);
      maker_.Measure(half);
    }
    return best;
  }

  int FindWorst() const {
    int worst = -1;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].whole || pieces_[i].protrusion <= limit_) continue;
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

  const TriangleMesh& mesh_;
  const DecomposeConfig& config_;
  double limit_;  // how far pieces may reach outside [m]
  int max_pieces_;
  PieceMaker maker_;
  CutFinder cuts_;
  std::vector<Piece> pieces_;
};

std::string HashOf(const TriangleMesh& mesh, const DecomposeConfig& config) {
  std::string bytes;
  const auto add = [&bytes](const auto* data, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(data), count * sizeof(*data));
  };
  const std::array<double, 7> head{static_cast<double>(mesh.V.rows()),
                                   static_cast<double>(mesh.F.rows()),
                                   static_cast<double>(config.max_pieces),
                                   config.concavity,
                                   config.free_concavity,
                                   config.tolerance,
                                   static_cast<double>(config.max_vertices)};
  add(head.data(), head.size());
  add(mesh.V.data(), mesh.V.size());
  add(mesh.F.data(), mesh.F.size());
  return Sha256(bytes);
}

// The hulls of one mesh, which are worked out once per process: a scene's World is built again and
// again. The answer is the same with and without; the last meshes asked for are kept.
std::vector<TriangleMesh> DecomposeOnce(const TriangleMesh& mesh, const DecomposeConfig& config) {
  struct Entry {
    std::string hash;
    std::vector<TriangleMesh> hulls;
  };
  constexpr std::size_t kMostEntries = 64;
  static std::mutex mutex;
  static std::list<Entry> entries;  // the last used first
  const std::string hash = HashOf(mesh, config);
  {
    const std::lock_guard lock(mutex);
    const auto it = std::find_if(entries.begin(), entries.end(),
                                 [&](const Entry& entry) { return entry.hash == hash; });
    if (it != entries.end()) {
      entries.splice(entries.begin(), entries, it);
      return it->hulls;
    }
  }
  std::vector<TriangleMesh> hulls = Decomposer(mesh, config).Run();
  const std::lock_guard lock(mutex);
  entries.push_front({hash, hulls});
  if (entries.size() > kMostEntries) entries.pop_back();
  return hulls;
}

// A leaf's convex pieces: itself, or the hulls that a mesh falls into, which keep its file's name.
struct LeafPieces {
  const RigidTransform& X_BP;
  const DecomposeConfig& config;
  std::vector<ConvexPiece>& pieces;

  void operator()(const Mesh& mesh) const { Add(mesh.mesh, mesh.file); }
  void operator()(const Cloud& cloud) const { Add(cloud.mesh, cloud.file); }
  void operator()(const Union& /*flattened*/) const {}
  template <typename Primitive>
  void operator()(const Primitive& primitive) const {
    pieces.push_back({primitive, X_BP});
  }

 private:
  void Add(const TriangleMesh& mesh, const std::string& file) const {
    for (TriangleMesh& hull : DecomposeOnce(mesh, config)) {
      pieces.push_back({Mesh{file, 1.0, std::move(hull), false, ""}, X_BP});
    }
  }
};

}  // namespace

void DecomposeConfig::Validate() const {
  const auto require = [](bool holds, const char* field, const char* expected, double got) {
    if (!holds) throw InputError("decompose", field, expected, FormatDouble(got));
  };
  require(max_pieces >= 1 && max_pieces <= 256, "max_pieces", "1 to 256", max_pieces);
  require(concavity > 0.0, "concavity", "a length above 0 m", concavity);
  require(free_concavity >= concavity, "free_concavity", "at least concavity", free_concavity);
  require(tolerance > 0.0, "tolerance", "a length above 0 m", tolerance);
  require(max_vertices >= 8 && max_vertices <= 4096, "max_vertices", "8 to 4096", max_vertices);
}

std::vector<ConvexPiece> DecomposeConvex(const Shape& shape, const DecomposeConfig& config) {
  config.Validate();
  std::vector<ConvexPiece> pieces;
  ForEachLeaf(shape, RigidTransform::Identity(), [&](const Shape& leaf, const RigidTransform& X) {
    std::visit(LeafPieces{X, config, pieces}, leaf);
  });
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
