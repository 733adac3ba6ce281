#include "app/core/gzip.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

TEST(GzipTest, InflateGivesBackWhatWasDeflated) {
  std::string bytes;
  for (unsigned i = 0; i < 200'000; ++i) bytes += static_cast<char>(i * i / 7);
  for (const std::string& text : {std::string(), std::string("one line\n"), bytes}) {
    EXPECT_EQ(Inflate(Deflate(text), "test"), text);
  }
  EXPECT_EQ(Deflate(bytes), Deflate(bytes));
}

TEST(GzipTest, CutShortDamagedAndLongerFilesAreRefused) {
  const std::string packed = Deflate(std::string(5000, 'x'));
  EXPECT_THROW(Inflate(packed.substr(0, packed.size() - 1), "test"), InputError);
  EXPECT_THROW(Inflate(packed + "more", "test"), InputError);
  std::string damaged = packed;
  damaged[packed.size() / 2] ^= 1;
  EXPECT_THROW(Inflate(damaged, "test"), InputError);
  EXPECT_THROW(Inflate("plain text", "test"), InputError);
}

}  // namespace
}  // namespace pregrasp
