#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "app/core/check.h"
#include "app/core/math.h"

namespace pregrasp {

/// What random numbers are drawn for: part of a stream's key, so that no two purposes ever share
/// numbers. One entry a purpose, drawn from in one place (a test counts them); new ones go last, as
/// an entry's place is its key.
enum class RngStream : std::uint8_t {
  kTest = 1,
  kObjectCloud,
  kComparedCloud,
  kMeshCuts,
  kPieceSamples,
  kTipReach,
  kGraphSamples,
  kScoreProbes,
  kMppiNoise,
  kReleasePlacements,
  kGraspLatent,
  kGraspCompletion,
  kSearchedContacts,
  kSearchedGraspIk,
  kProposedGraspIk,
  kMotionIk,
  kScriptIk,
  kGrowthMoves,
  kGrownGraspIk,
  kItemCloud,
  kItemObject,
  kItemScene,
  kItemGrowth,
  kItemLabel,
  kLabelLatent,
  kLabelCompletion,
  kProbedContacts,
  kProbedLabels,
  kPicturedItems,
  kInitialWeights,
  kBatchOrder,
  kBatchNoise,
  kEvaluationNoise,
  kCompletionProbes,
  kSecondSource,
  kGraspRefinement,
  kRefinedGraspIk,
  kGraspRoom,
  kGraspRoomKept,
  kMotionKey,
  kMotionApproach,
  kMotionFrame,
  kMotionDetour,
  kMotionPolish,
  kMotionProblem,
  kMotionProblemIk,
  kHandMeasures,
  kHandPoses,
  kHandPoseIk,
};

/// Counter-based generator: Philox4x64-10 (Salmon et al., "Parallel random numbers: as easy as 1,
/// 2, 3", SC 2011), key (seed, purpose), counter (block, i, j, k). A stream is a pure function of
/// its seed, purpose and indices, each in full width, so the thread that draws it cannot matter;
/// and as the generator is a bijection of the counter, no two streams of one seed and purpose meet.
class Rng {
 public:
  explicit Rng(std::uint64_t seed, RngStream stream = RngStream::kTest, std::uint64_t i = 0,
               std::uint64_t j = 0, std::uint64_t k = 0)
      : key_{seed, static_cast<std::uint64_t>(stream)}, counter_{0, i, j, k} {}

  /// The k-th stream of a purpose within this stream's purpose: keyed by both purposes, this
  /// stream's seed and its first two indices, wherever in its numbers this one stands. Up to eight
  /// purposes deep. This stream must leave its third index to its parts (zero).
  Rng Split(RngStream stream, std::uint64_t k = 0) const {
    PREGRASP_CHECK(counter_[3] == 0 && key_[1] >> 56 == 0);
    Rng part = *this;
    part.key_[1] = (key_[1] << 8) | static_cast<std::uint64_t>(stream);
    part.counter_ = {0, counter_[1], counter_[2], k};
    part.next_ = 4;
    part.has_spare_ = false;
    return part;
  }

  std::uint64_t NextU64() {
    if (next_ == 4) {
      block_ = Philox(counter_, key_);
      ++counter_[0];
      next_ = 0;
    }
    return block_[next_++];
  }

  std::uint32_t NextU32() { return static_cast<std::uint32_t>(NextU64() >> 32); }

  /// Uniform in [0, 1), 53 bits.
  double Uniform() { return static_cast<double>(NextU64() >> 11) * 0x1.0p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  /// Uniform integer in [0, n); n > 0. Lemire's multiply-shift; the bias is below n / 2^32.
  std::uint32_t UniformInt(std::uint32_t n) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(NextU32()) * n) >> 32);
  }

  /// Standard normal (Box-Muller; one of the pair is kept for the next call).
  double Normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    const double angle = 2.0 * kPi * Uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

  /// Uniform on the unit sphere.
  Vector3 Direction() {
    const double z = Uniform(-1.0, 1.0);
    const double angle = Uniform(0.0, 2.0 * kPi);
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

  /// Uniform over rotations.
  Quaternion Rotation() {
    Eigen::Vector4d v(Normal(), Normal(), Normal(), Normal());
    v.normalize();
    return {v[0], v[1], v[2], v[3]};
  }

  using Block = std::array<std::uint64_t, 4>;
  using Key = std::array<std::uint64_t, 2>;

  /// The bijection itself, public for its known-answer test.
  static Block Philox(Block counter, Key key) {
    for (int round = 0; round < 10; ++round) {
      const Wide p0 = static_cast<Wide>(0xD2E7470EE14C6C93ULL) * counter[0];
      const Wide p1 = static_cast<Wide>(0xCA5A826395121157ULL) * counter[2];
      counter = {static_cast<std::uint64_t>(p1 >> 64) ^ counter[1] ^ key[0],
                 static_cast<std::uint64_t>(p1),
                 static_cast<std::uint64_t>(p0 >> 64) ^ counter[3] ^ key[1],
                 static_cast<std::uint64_t>(p0)};
      key[0] += 0x9E3779B97F4A7C15ULL;
      key[1] += 0xBB67AE8584CAA73BULL;
    }
    return counter;
  }

 private:
  __extension__ typedef unsigned __int128 Wide;

  Key key_;
  Block counter_;
  Block block_{};
  int next_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace pregrasp
