#include "app/geometry/merge_pieces.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

constexpr int kFiner = 4;  // a joint is looked at in so many times the points of a cut's halves

// Two pieces that may become one.
struct Joint {
  std::size_t i = 0, j = 0;
  double protrusion = 0.0;     // a lower bound, until there is a piece [m]
  bool rough = false;          // the bound is that of a coarser hull
  std::optional<Piece> piece;  // without its parts

  bool operator<(const Joint& other) const {
    return std::tie(protrusion, i, j) < std::tie(other.protrusion, other.i, other.j);
  }
};

class Joiner {
 public:
  Joiner(const PieceMaker& maker, double limit, std::vector<Piece>& pieces)
      : maker_(maker), limit_(limit), pieces_(pieces), gone_(pieces.size(), false) {}

  void AddAllJoints() {
    for (std::size_t i = 1; i < pieces_.size(); ++i) AddJoints(i);
  }

  // The joint that reaches least outside, with its piece; null when none is left.
  const Joint* FindBest() {
    while (!joints_.empty()) {
      ThrowIfInterrupted();
      const auto best = std::min_element(joints_.begin(), joints_.end());
      if (best->piece) return &*best;
      const std::vector<const Piece*> members{&pieces_[best->i], &pieces_[best->j]};
      Piece joined;
      if (!best->rough) {
        best->rough = true;
        if (maker_.JoinRoughly(members, joined)) {
          best->protrusion = std::max(best->protrusion, joined.protrusion);
        }
      } else if (maker_.Join(members, joined, kFiner)) {
        best->protrusion = joined.protrusion;
        best->piece = std::move(joined);
      } else {
        joints_.erase(best);
      }
    }
    return nullptr;
  }

  void CarryOut(const Joint& joint) {
    Piece joined = *joint.piece;
    for (const std::size_t k : {joint.i, joint.j}) {
      std::move(pieces_[k].parts.begin(), pieces_[k].parts.end(), std::back_inserter(joined.parts));
      gone_[k] = true;
    }
    joints_.erase(std::remove_if(joints_.begin(), joints_.end(),
                                 [&](const Joint& j) { return gone_[j.i] || gone_[j.j]; }),
                  joints_.end());
    pieces_.push_back(std::move(joined));
    gone_.push_back(false);
    AddJoints(pieces_.size() - 1);
  }

  void DropGone() {
    std::vector<Piece> kept;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (!gone_[i]) kept.push_back(std::move(pieces_[i]));
    }
    pieces_ = std::move(kept);
  }

 private:
  // How far lines between corners of the two hulls leave the solid: some of the joint hull.
  double BoundJoint(const Piece& a, const Piece& b) const {
    double farthest = 0.0;
    constexpr int kLines = 96;
    for (Eigen::Index k = 0; k < kLines; ++k) {
      const Vector3 p = a.hull.V.row((k * 7) % a.hull.V.rows());
      const Vector3 q = b.hull.V.row((k * 5) % b.hull.V.rows());
      farthest = maker_.roughly().CalcAbove(0.5 * (p + q), farthest);
    }
    return farthest;
  }

  void AddJoints(std::size_t i) {
    AlignedBox reach = pieces_[i].bounds;
    reach.min().array() -= limit_;
    reach.max().array() += limit_;
    for (std::size_t j = 0; j < i; ++j) {
      if (gone_[j] || reach.intersection(pieces_[j].bounds).isEmpty()) continue;
      joints_.push_back({i, j, BoundJoint(pieces_[i], pieces_[j]), false, {}});
    }
  }

  const PieceMaker& maker_;
  double limit_;
  std::vector<Piece>& pieces_;
  std::vector<bool> gone_;
  std::vector<Joint> joints_;
};

}  // namespace

void MergePieces(const PieceMaker& maker, double limit, int max_pieces,
                 std::vector<Piece>& pieces) {
  Joiner joiner(maker, limit, pieces);
  joiner.AddAllJoints();
  auto count = static_cast<int>(pieces.size());
  while (const Joint* best = joiner.FindBest()) {
    if (count <= max_pieces && best->protrusion > limit) break;
    joiner.CarryOut(*best);
    --count;
  }
  joiner.DropGone();
}

}  // namespace pregrasp
