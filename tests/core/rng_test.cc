#include "app/core/rng.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "app/core/error.h"

namespace pregrasp {
namespace {

// Known answers of the generator's authors (Random123, kat_vectors, philox4x64-10).
TEST(RngTest, PhiloxGivesTheAuthorsKnownAnswers) {
  EXPECT_EQ(
      Rng::Philox({0, 0, 0, 0}, {0, 0}),
      (Rng::Block{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  const std::uint64_t ones = ~std::uint64_t{0};
  EXPECT_EQ(
      Rng::Philox({ones, ones, ones, ones}, {ones, ones}),
      (Rng::Block{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}));
  EXPECT_EQ(
      Rng::Philox({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
                  {0x452821e638d01377, 0xbe5466cf34e90c6c}),
      (Rng::Block{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}));
}

// Values whose halves, sums and shifts meet: what a key that drops or adds bits would confuse.
constexpr std::array<std::uint64_t, 10> kAwkward = {
    0, 1, 2, 3, 256, 1ULL << 31, 1ULL << 32, (1ULL << 32) + 1, 1ULL << 63, ~0ULL};

TEST(RngTest, NoTwoSeedsPurposesOrIndicesShareTheirFirstNumbers) {
  std::set<std::uint64_t> first;
  std::size_t streams = 0;
  const auto draw = [&](Rng rng) {
    first.insert(rng.NextU64());
    ++streams;
  };
  for (const std::uint64_t seed : kAwkward) {
    for (int stream = 1; stream <= static_cast<int>(RngStream::kEvaluationNoise); ++stream) {
      for (const std::uint64_t i : kAwkward) {
        for (const std::uint64_t j : kAwkward) {
          draw(Rng(seed, static_cast<RngStream>(stream), i, j));
          if (i < 4 && j < 4) draw(Rng(seed, static_cast<RngStream>(stream), i, j, 1ULL << 32));
        }
      }
    }
  }
  EXPECT_EQ(first.size(), streams);
}

TEST(RngTest, PartsOfAStreamShareNoNumbersWithItNorWithEachOther) {
  std::set<std::uint64_t> first;
  std::size_t streams = 0;
  const auto draw = [&](Rng rng) {
    first.insert(rng.NextU64());
    ++streams;
  };
  for (const RngStream whole : {RngStream::kTest, RngStream::kObjectCloud, RngStream::kMppiNoise}) {
    for (const std::uint64_t i : kAwkward) {
      const Rng rng(7, whole, i, 3);
      draw(rng);
      for (const RngStream part : {RngStream::kTest, RngStream::kObjectCloud}) {
        for (const std::uint64_t k : kAwkward) {
          draw(rng.Split(part, k));
          draw(rng.Split(part).Split(part, k));
        }
      }
    }
  }
  EXPECT_EQ(first.size(), streams);
}

TEST(RngTest, APartIsTheSameWhereverItsStreamStands) {
  Rng fresh(5, RngStream::kTest, 1, 2), drawn = fresh;
  drawn.Normal();
  EXPECT_EQ(fresh.Split(RngStream::kMppiNoise, 9).Normal(),
            drawn.Split(RngStream::kMppiNoise, 9).Normal());
}

TEST(RngTest, AStreamThatUsesItsThirdIndexHasNoParts) {
  EXPECT_THROW(Rng(1, RngStream::kTest, 0, 0, 1).Split(RngStream::kTest), InternalError);
}

TEST(RngTest, IntegersCoverTheirRangeEvenly) {
  Rng rng(3);
  constexpr int kCount = 70000;
  std::array<int, 7> counts{};
  for (int i = 0; i < kCount; ++i) {
    const std::uint32_t n = rng.UniformInt(7);
    ASSERT_LT(n, 7U);
    ++counts[n];
  }
  for (const int count : counts) EXPECT_NEAR(count, kCount / 7, 5 * std::sqrt(kCount / 7));
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
