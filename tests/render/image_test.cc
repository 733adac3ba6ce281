#include "render/image.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/rng.h"

namespace pregrasp {
namespace {

std::filesystem::path TestFile(const std::string& name) {
  return std::filesystem::path(::testing::TempDir()) / name;
}

std::string Bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Image RandomImage(int width, int height) {
  Image image{width, height, {}};
  Rng rng(7);
  for (int i = 0; i < width * height * 3; ++i) {
    image.rgb.push_back(static_cast<std::uint8_t>(rng.UniformInt(256)));
  }
  return image;
}

TEST(PngTest, WhatIsWrittenIsReadBack) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(16, 9), std::pair(123, 45)}) {
    const Image image = RandomImage(width, height);
    WritePng(image, TestFile("round_trip.png"));
    const Image back = ReadPng(TestFile("round_trip.png"));
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.rgb, image.rgb);
  }
}

TEST(PngTest, TheSameImageGivesTheSameBytes) {
  const Image image = RandomImage(64, 48);
  WritePng(image, TestFile("a.png"));
  WritePng(image, TestFile("b.png"));
  EXPECT_EQ(Bytes(TestFile("a.png")), Bytes(TestFile("b.png")));
}

TEST(PngTest, AFileThatCannotBeWrittenOrReadIsAnInputError) {
  EXPECT_THROW(WritePng(RandomImage(2, 2), "/nonexistent/folder/a.png"), InputError);
  EXPECT_THROW(ReadPng("/nonexistent/folder/a.png"), InputError);
}

TEST(PngTest, AnInterruptLeavesNoFile) {
  RequestInterrupt();
  EXPECT_THROW(WritePng(RandomImage(32, 32), TestFile("interrupted.png")), Interrupted);
  ClearInterrupt();
  EXPECT_FALSE(std::filesystem::exists(TestFile("interrupted.png")));
}

TEST(PngTest, DamagedFilesAreInputErrors) {
  WritePng(RandomImage(32, 32), TestFile("whole.png"));
  const std::string whole = Bytes(TestFile("whole.png"));
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{7}, std::size_t{30}, whole.size() / 2}) {
    std::ofstream(TestFile("cut.png"), std::ios::binary) << whole.substr(0, length);
    EXPECT_THROW(ReadPng(TestFile("cut.png")), InputError) << length;
  }
  std::ofstream(TestFile("text.png")) << "not a picture at all";
  EXPECT_THROW(ReadPng(TestFile("text.png")), InputError);
}

}  // namespace
}  // namespace pregrasp
