#include "app/networks/safetensors.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "app/core/error.h"
#include "app/core/rng.h"

namespace pregrasp {
namespace {

TensorFile MakeFile() {
  TensorFile file;
  file.metadata = {{"architecture", "{\"widths\": [1, 2]}"}, {"units", "m, rad"}};
  file.tensors["b.weight"] = MakeTensor<float>({2, 3}, {1, 2, 3, 4, 5, 6.5F});
  file.tensors["a.count"] = MakeTensor<std::int64_t>({2}, {-7, std::int64_t{1} << 40});
  file.tensors["mask"] = MakeTensor<std::uint8_t>({3}, {0, 1, 255});
  file.tensors["scalar"] = MakeTensor<double>({}, {0.1});
  file.tensors["empty"] = MakeTensor<std::int32_t>({0, 4}, {});
  return file;
}

// A file of one header, given as text, and `data` bytes of data.
std::string MakeBytes(const std::string& header, std::size_t data) {
  std::string bytes(8, '\0');
  const std::uint64_t size = header.size();
  std::memcpy(bytes.data(), &size, 8);
  return bytes + header + std::string(data, '\1');
}

TEST(SafetensorsTest, WhatIsWrittenReadsBack) {
  const TensorFile file = MakeFile();
  const TensorFile read = ParseTensors(SerializeTensors(file), "test");
  EXPECT_EQ(read.metadata, file.metadata);
  EXPECT_EQ(read.Get<float>("b.weight", {2, -1}), (std::vector<float>{1, 2, 3, 4, 5, 6.5F}));
  EXPECT_EQ(read.Get<std::int64_t>("a.count", {2}),
            (std::vector<std::int64_t>{-7, std::int64_t{1} << 40}));
  EXPECT_EQ(read.Get<std::uint8_t>("mask", {3}), (std::vector<std::uint8_t>{0, 1, 255}));
  EXPECT_EQ(read.Get<double>("scalar", {}), std::vector<double>{0.1});
  EXPECT_TRUE(read.Get<std::int32_t>("empty", {0, 4}).empty());
  EXPECT_EQ(SerializeTensors(read), SerializeTensors(file));
}

TEST(SafetensorsTest, TheBytesAreThoseOfTheFormat) {
  TensorFile file;
  file.metadata["k"] = "v";
  file.tensors["w"] = MakeTensor<float>({1}, {1.0F});
  const std::string header =
      R"({"__metadata__":{"k":"v"},"w":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})";
  const std::string bytes = SerializeTensors(file);
  ASSERT_GE(bytes.size(), 8 + header.size() + 4);
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(size % 8, 0U);
  EXPECT_EQ(bytes.substr(8, header.size()), header);
  EXPECT_EQ(bytes.substr(8 + header.size(), size - header.size()),
            std::string(size - header.size(), ' '));
  EXPECT_EQ(bytes.substr(8 + size), std::string("\0\0\x80\x3f", 4));
}

TEST(SafetensorsTest, EveryTensorIsAlignedToItsElements) {
  const std::string bytes = SerializeTensors(MakeFile());
  for (const auto& [name, tensor] : ParseTensors(bytes, "test").tensors) {
    if (tensor.bytes.empty()) continue;
    const std::size_t at = bytes.rfind(tensor.bytes);
    EXPECT_EQ(at % DTypeSize(tensor.dtype), 0U) << name;
  }
}

TEST(SafetensorsTest, FilesAreWrittenWholeOrNotAtAll) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "safetensors_test";
  std::filesystem::create_directories(folder);
  const auto path = folder / "weights.safetensors";
  WriteTensors(path, MakeFile());
  EXPECT_EQ(SerializeTensors(ReadTensors(path)), SerializeTensors(MakeFile()));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  EXPECT_THROW(WriteTensors(folder / "none" / "weights.safetensors", MakeFile()), InputError);
  EXPECT_THROW(ReadTensors(folder / "absent.safetensors"), InputError);
  EXPECT_THROW(ReadTensors(folder), InputError);
  std::filesystem::remove_all(folder);
}

TEST(SafetensorsTest, WrongRequestsNameTheTensor) {
  const TensorFile file = ParseTensors(SerializeTensors(MakeFile()), "weights.safetensors");
  try {
    file.Get<float>("b.weight", {3, 2});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()),
              "weights.safetensors: b.weight: expected shape [3, 2], got [2, 3]");
  }
  EXPECT_THROW(file.Get<double>("b.weight", {2, 3}), InputError);
  EXPECT_THROW(file.Get<float>("c.weight", {2, 3}), InputError);
  EXPECT_THROW(file.metadata_at("nothing"), InputError);
}

TEST(SafetensorsTest, ValuesThatAreNotFiniteAreRefused) {
  TensorFile file;
  file.tensors["w"] = MakeTensor<float>({2}, {0.0F, std::numeric_limits<float>::quiet_NaN()});
  EXPECT_THROW(ParseTensors(SerializeTensors(file), "test").Get<float>("w", {2}), InputError);
}

TEST(SafetensorsTest, DeparturesFromTheFormatAreInputErrors) {
  const std::string good = R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})";
  EXPECT_NO_THROW(ParseTensors(MakeBytes(good, 8), "test"));
  const std::vector<std::pair<std::string, std::size_t>> bad = {
      {"", 0},
      {"{", 0},
      {"[]", 0},
      {"3", 0},
      {"{\"w\":\xff}", 0},
      {good, 7},
      {good, 9},
      {R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[0,8],"more":1}})", 8},
      {R"({"w":{"dtype":"F32","shape":[2]}})", 8},
      {R"({"w":{"dtype":"F31","shape":[2],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":7,"shape":[2],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":2,"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[-2],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[2.0],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":["2"],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[3],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[4611686018427387904,4],"data_offsets":[0,0]}})", 0},
      {R"({"w":{"dtype":"F32","shape":[18446744073709551615],"data_offsets":[0,8]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[8,0]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[-8,0]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[0,8,16]}})", 8},
      {R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[4,12]}})", 12},
      {R"({"v":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},)"
       R"("w":{"dtype":"F32","shape":[2],"data_offsets":[4,12]}})",
       12},
      {R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},)"
       R"("w":{"dtype":"F32","shape":[2],"data_offsets":[0,8]}})",
       8},
      {R"({"__metadata__":{"k":1}})", 0},
      {R"({"__metadata__":[]})", 0},
      {R"({"__metadata__":{"k":{"k":{}}}})", 0},
  };
  for (const auto& [header, data] : bad) {
    EXPECT_THROW(ParseTensors(MakeBytes(header, data), "test"), InputError) << header;
  }
  EXPECT_THROW(ParseTensors(MakeBytes(std::string(100'000, '['), 0), "test"), InputError);
  for (const std::size_t size : {0, 7, 8, 9}) {
    EXPECT_THROW(ParseTensors(std::string(size, '\xff'), "test"), InputError) << size;
  }
}

TEST(SafetensorsTest, ACorruptFileIsReadOrRefusedNeverACrash) {
  const std::string good = SerializeTensors(MakeFile());
  std::uint64_t header_size = 0;
  std::memcpy(&header_size, good.data(), 8);
  int refused = 0, read = 0;
  for (std::uint32_t trial = 0; trial < 20'000; ++trial) {
    Rng rng(1, RngStream::kTest, trial);
    std::string bytes = good;
    const std::uint32_t changes = 1 + rng.UniformInt(3);
    for (std::uint32_t c = 0; c < changes; ++c) {
      const std::uint32_t at = rng.UniformInt(static_cast<std::uint32_t>(8 + header_size));
      switch (rng.UniformInt(4)) {
        case 0:
          bytes[at] = static_cast<char>(rng.UniformInt(256));
          break;
        case 1:
          bytes[at] = "0123456789[]{}:,\"-"[rng.UniformInt(18)];
          break;
        case 2:
          bytes.erase(at, 1);
          break;
        default:
          bytes.resize(rng.UniformInt(static_cast<std::uint32_t>(good.size())));
          bytes.resize(good.size(), '\0');
      }
    }
    try {
      const TensorFile file = ParseTensors(bytes, "test");
      for (const auto& [name, tensor] : file.tensors) {
        ASSERT_EQ(tensor.bytes.size(), tensor.size() * DTypeSize(tensor.dtype));
      }
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 10'000);
  EXPECT_GT(read, 100);  // names and metadata may change without the file being wrong
}

}  // namespace
}  // namespace pregrasp
