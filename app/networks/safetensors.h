#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pregrasp {

/// Element types of the safetensors format that pregrasp keeps; half precision is carried as bytes
/// only.
enum class DType { kF64, kI64, kF32, kI32, kF16, kBF16, kI16, kI8, kU8, kBool };

const char* DTypeName(DType dtype);  ///< "F32", ..
std::size_t DTypeSize(DType dtype);  ///< bytes of one element

/// A dense array, row-major, little-endian, as raw bytes.
struct StoredTensor {
  DType dtype = DType::kF32;
  std::vector<std::int64_t> shape;  ///< empty for a scalar
  std::string bytes;

  std::int64_t size() const;  ///< number of elements
};

/// Makes a StoredTensor of float, double, std::int32_t, std::int64_t or std::uint8_t.
/// `values.size()` must be the product of `shape`.
template <typename T>
StoredTensor MakeTensor(const std::vector<std::int64_t>& shape, const std::vector<T>& values);

/// What a safetensors file holds: named tensors and a text-to-text map of metadata. The format is
/// that of https://github.com/huggingface/safetensors: the header's length as 8 bytes, the header
/// in JSON, the data.
struct TensorFile {
  std::string where;  ///< the file's name, for messages
  std::map<std::string, std::string> metadata;
  std::map<std::string, StoredTensor> tensors;

  /// The values of tensor `name`. A negative entry of `shape` leaves that extent open.
  /// @throws InputError if it is absent, of another type, of another shape, or (for float and
  /// double) not finite.
  template <typename T>
  std::vector<T> Get(const std::string& name, const std::vector<std::int64_t>& shape) const;

  /// @throws InputError if there is none.
  const StoredTensor& at(const std::string& name) const;
  const std::string& metadata_at(const std::string& key) const;
};

/// Parses a whole file given as bytes.
/// @throws InputError naming `where` and the tensor, for anything that departs from the format: a
/// short file, a header that is not the expected JSON, repeated names, unknown types, shapes that
/// overflow, offsets that overlap, leave holes or leave the file.
TensorFile ParseTensors(std::string_view bytes, const std::string& where);

/// The same content always gives the same bytes: tensors in order of falling element size, then
/// name, so that every tensor is aligned to its elements; the data starts at a multiple of 8 bytes.
std::string SerializeTensors(const TensorFile& file);

/// @throws InputError if the file cannot be read or is corrupt.
TensorFile ReadTensors(const std::filesystem::path& path);

/// Writes beside `path` and renames, so that a reader sees the old file or the whole new one.
/// @throws InputError if it cannot be written.
void WriteTensors(const std::filesystem::path& path, const TensorFile& file);

}  // namespace pregrasp
