#include "app/core/rng.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

// Known answers of the generator's authors (Random123, kat_vectors, philox4x32-10).
TEST(RngTest, PhiloxGivesTheAuthorsKnownAnswers) {
  using Block = std::array<std::uint32_t, 4>;
  EXPECT_EQ(Rng::Philox({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(Rng::Philox({ones, ones, ones, ones}, {ones, ones}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Rng::Philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RngTest, StreamsOfOtherKeysShareNoNumbers) {
  Rng a(1, RngStream::kMppi, 3, 4);
  for (Rng b : {Rng(2, RngStream::kMppi, 3, 4), Rng(1, RngStream::kGraph, 3, 4),
                Rng(1, RngStream::kMppi, 4, 4), Rng(1, RngStream::kMppi, 3, 5)}) {
    Rng copy = a;
    EXPECT_NE(copy.NextU64(), b.NextU64());
  }
}

TEST(RngTest, UniformAndNormalHaveTheirMoments) {
  Rng rng(11);
  constexpr int kCount = 200000;
  double uniform_sum = 0, normal_sum = 0, normal_square = 0;
  for (int i = 0; i < kCount; ++i) {
    const double u = rng.Uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    uniform_sum += u;
    const double x = rng.Normal();
    normal_sum += x;
    normal_square += x * x;
  }
  EXPECT_NEAR(uniform_sum / kCount, 0.5, 5 * 0.2887 / std::sqrt(kCount));
  EXPECT_NEAR(normal_sum / kCount, 0.0, 5 / std::sqrt(kCount));
  EXPECT_NEAR(normal_square / kCount, 1.0, 5 * 1.4142 / std::sqrt(kCount));
}

}  // namespace
}  // namespace pregrasp
