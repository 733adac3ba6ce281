#include "render/jpeg.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

// A ramp from black to red, downwards to blue.
Image Ramp(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.rgb.push_back(static_cast<std::uint8_t>(255 * x / width));
      image.rgb.push_back(0);
      image.rgb.push_back(static_cast<std::uint8_t>(255 * y / height));
    }
  }
  return image;
}

TEST(JpegTest, APictureIsAWholeFileOfItsSizeAndTheSameEachTime) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(160, 90), std::pair(33, 17)}) {
    const std::string bytes = EncodeJpeg(Ramp(width, height), 80);
    EXPECT_EQ(bytes.substr(0, 3), "\xff\xd8\xff");
    EXPECT_EQ(bytes.substr(bytes.size() - 2), "\xff\xd9");
    EXPECT_EQ(bytes, EncodeJpeg(Ramp(width, height), 80));
    const std::size_t frame = bytes.find("\xff\xc0");  // then length, precision, height, width
    ASSERT_NE(frame, std::string::npos);
    const auto word = [&](std::size_t at) {
      return 256 * static_cast<std::uint8_t>(bytes[at]) + static_cast<std::uint8_t>(bytes[at + 1]);
    };
    EXPECT_EQ(word(frame + 5), height);
    EXPECT_EQ(word(frame + 7), width);
  }
}

TEST(JpegTest, LessQualityIsLessBytes) {
  EXPECT_LT(EncodeJpeg(Ramp(160, 90), 30).size(), EncodeJpeg(Ramp(160, 90), 90).size());
}

}  // namespace
}  // namespace pregrasp
