#include "app/geometry/merge_pieces.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace pregrasp {
namespace {

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

class Joiner {
 public:
  Joiner(const PieceMaker& maker, double limit, std::vector<Piece>& pieces)
      : maker_(maker), limit_(limit), pieces_(pieces), gone_(pieces.size(), false) {}

  void AddAllJoints(int except) {
    if (except >= 0) gone_[except] = true;
    for (std::size_t i = pieces_.size(); i-- > 0;) {
      if (gone_[i]) continue;
      gone_[i] = true;  // each pair once
      AddJoints(i);
    }
    gone_.assign(pieces_.size(), false);
  }

  // The joint that reaches least outside, worked out; none left when false.
  bool FindBest(Joint& best, Piece& piece) {
    while (!joints_.empty()) {
      const auto it = std::min_element(joints_.begin(), joints_.end());
      Piece joined;
      if (!maker_.Join({&pieces_[it->i], &pieces_[it->j]}, joined)) {
        joints_.erase(it);
        continue;
      }
      const bool was_exact = it->exact;
      it->exact = true;
      it->protrusion = joined.protrusion;
      if (was_exact || it == std::min_element(joints_.begin(), joints_.end())) {
        best = *it;
        piece = std::move(joined);
        return true;
      }
    }
    return false;
  }

  void Replace(const Joint& joint, Piece joined) {
    gone_[joint.i] = gone_[joint.j] = true;
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
    constexpr int kLines = 24;
    for (int k = 0; k < kLines; ++k) {
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
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      if (j == i || gone_[j] || reach.intersection(pieces_[j].bounds).isEmpty()) continue;
      joints_.push_back({BoundJoint(pieces_[i], pieces_[j]), false, i, j});
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
  joiner.AddAllJoints(-1);
  auto count = static_cast<int>(pieces.size());
  Joint best;
  Piece joined;
  while (joiner.FindBest(best, joined)) {
    if (count <= max_pieces && joined.protrusion > limit) break;
    joiner.Replace(best, std::move(joined));
    joined = {};
    --count;
  }
  joiner.DropGone();
}

bool JoinBestPair(const PieceMaker& maker, double limit, int except, std::vector<Piece>& pieces) {
  Joiner joiner(maker, limit, pieces);
  joiner.AddAllJoints(except);
  Joint best;
  Piece joined;
  if (!joiner.FindBest(best, joined) || joined.protrusion >= limit) return false;
  joiner.Replace(best, std::move(joined));
  joiner.DropGone();
  return true;
}

}  // namespace pregrasp
