#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "app/core/math.h"

namespace pregrasp {

/// What a stream of random numbers is drawn for: part of its key, so that no two purposes ever
/// share numbers.
enum class RngStream : std::uint32_t {
  kTest = 0,
  kPointCloud = 1,
  kGraph = 2,
  kMppi = 3,
  kGrasp = 4,
  kIk = 5,
  kDataset = 6,
  kScript = 7,
  kCertificate = 8,
  kDecomposition = 9,
  kTraining = 10,
};

/// Counter-based generator: Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1,
/// 2, 3", SC 2011). A stream is a pure function of (seed, stream, iteration, sample), so the thread
/// that draws it cannot matter.
class Rng {
 public:
  explicit Rng(std::uint64_t seed, RngStream stream = RngStream::kTest, std::uint32_t iteration = 0,
               std::uint32_t sample = 0)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        counter_{0, static_cast<std::uint32_t>(stream), iteration, sample} {}

  std::uint32_t NextU32() {
    if (next_ == 4) {
      block_ = Philox(counter_, key_);
      ++counter_[0];
      next_ = 0;
    }
    return block_[next_++];
  }

  std::uint64_t NextU64() {
    const std::uint64_t high = NextU32();
    return (high << 32) | NextU32();
  }

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

  /// The bijection itself, public for its known-answer test.
  static std::array<std::uint32_t, 4> Philox(std::array<std::uint32_t, 4> counter,
                                             std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t p0 = 0xD2511F53ULL * counter[0];
      const std::uint64_t p1 = 0xCD9E8D57ULL * counter[2];
      counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0],
                 static_cast<std::uint32_t>(p1),
                 static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1],
                 static_cast<std::uint32_t>(p0)};
      key[0] += 0x9E3779B9U;
      key[1] += 0xBB67AE85U;
    }
    return counter;
  }

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  int next_ = 4;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace pregrasp
