#include "app/networks/safetensors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <type_traits>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/file_kind.h"

namespace pregrasp {
namespace {

static_assert(std::endian::native == std::endian::little, "safetensors data is little-endian");

using Json = nlohmann::json;

constexpr std::size_t kLengthBytes = 8;
constexpr std::size_t kMaxHeaderBytes = 100'000'000;  // the format's own limit
constexpr int kMaxDepth = 3;                          // a number in a list in an entry
constexpr const char* kMetadata = "__metadata__";

struct DTypeInfo {
  DType dtype;
  const char* name;
  std::size_t size;
};
constexpr std::array<DTypeInfo, 10> kDTypes{{{DType::kF64, "F64", 8},
                                             {DType::kI64, "I64", 8},
                                             {DType::kF32, "F32", 4},
                                             {DType::kI32, "I32", 4},
                                             {DType::kF16, "F16", 2},
                                             {DType::kBF16, "BF16", 2},
                                             {DType::kI16, "I16", 2},
                                             {DType::kI8, "I8", 1},
                                             {DType::kU8, "U8", 1},
                                             {DType::kBool, "BOOL", 1}}};

const DTypeInfo& InfoOf(DType dtype) { return kDTypes[static_cast<std::size_t>(dtype)]; }

template <typename T>
constexpr DType DTypeOf() {
  if constexpr (std::is_same_v<T, double>) return DType::kF64;
  if constexpr (std::is_same_v<T, float>) return DType::kF32;
  if constexpr (std::is_same_v<T, std::int64_t>) return DType::kI64;
  if constexpr (std::is_same_v<T, std::int32_t>) return DType::kI32;
  if constexpr (std::is_same_v<T, std::uint8_t>) return DType::kU8;
}

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  std::string text = "[";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i ? ", " : "") + (shape[i] < 0 ? std::string("any") : std::to_string(shape[i]));
  }
  return text + "]";
}

// What the header says of one tensor, checked; its bytes are data[begin, end).
struct Entry {
  std::string name;
  DType dtype;
  std::vector<std::int64_t> shape;
  std::size_t begin, end;
};

// The header as JSON. A repeated name, which the library would silently let win, is refused, and so
// is any depth that the format does not have.
Json ParseHeader(std::string_view text, const std::string& where) {
  std::vector<std::set<std::string>> keys;
  const Json::parser_callback_t check = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > kMaxDepth) {
      throw InputError(where, "", "a safetensors header", "one that is nested deeper");
    }
    if (event == Json::parse_event_t::object_start) {
      keys.emplace_back();
    } else if (event == Json::parse_event_t::object_end) {
      keys.pop_back();
    } else if (event == Json::parse_event_t::key) {
      const auto& name = parsed.get_ref<const std::string&>();
      if (!keys.back().insert(name).second) {
        throw InputError(where, name, "each name once in a safetensors header", "it twice");
      }
    }
    return true;
  };
  Json header;
  try {
    header = Json::parse(text.begin(), text.end(), check);
  } catch (const Json::exception&) {
    throw InputError(where, "", "a safetensors file", "a header that is not JSON");
  }
  if (!header.is_object()) {
    throw InputError(where, "", "a safetensors file", "a header that is not an object");
  }
  return header;
}

Entry ParseEntry(const std::string& name, const Json& json, std::size_t data_size,
                 const std::string& where) {
  const auto fail = [&](const char* expected, const std::string& got) -> InputError {
    return {where, name, expected, got};
  };
  const auto is_index = [](const Json& value) {
    return value.is_number_integer() &&
           !(value.is_number_unsigned()
                 ? value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max()
                 : value.get<std::int64_t>() < 0);
  };
  if (!json.is_object() || json.size() != 3 || !json.contains("dtype") || !json.contains("shape") ||
      !json.contains("data_offsets")) {
    throw fail("an entry of dtype, shape and data_offsets", "something else");
  }
  Entry entry;
  entry.name = name;
  const Json& dtype = json["dtype"];
  const auto* info = std::find_if(kDTypes.begin(), kDTypes.end(), [&](const DTypeInfo& known) {
    return dtype.is_string() && dtype.get_ref<const std::string&>() == known.name;
  });
  if (info == kDTypes.end()) {
    throw fail("a dtype of F64, I64, F32, I32, F16, BF16, I16, I8, U8 or BOOL",
               dtype.is_string() ? dtype.get<std::string>() : "no text");
  }
  entry.dtype = info->dtype;
  if (!json["shape"].is_array()) throw fail("a shape", "no list");
  std::uint64_t count = 1;
  for (const Json& extent : json["shape"]) {
    if (!is_index(extent)) throw fail("a shape of counts", "another value");
    const auto n = extent.get<std::uint64_t>();
    if (n != 0 && count > std::numeric_limits<std::int64_t>::max() / 8 / n) {
      throw fail("a shape within the file", "one that overflows");
    }
    count *= n;
    entry.shape.push_back(static_cast<std::int64_t>(n));
  }
  const Json& offsets = json["data_offsets"];
  if (!offsets.is_array() || offsets.size() != 2 || !is_index(offsets[0]) ||
      !is_index(offsets[1])) {
    throw fail("data_offsets of two counts", "something else");
  }
  entry.begin = offsets[0].get<std::size_t>();
  entry.end = offsets[1].get<std::size_t>();
  if (entry.begin > entry.end || entry.end > data_size) {
    throw fail("data_offsets within the file", "[" + std::to_string(entry.begin) + ", " +
                                                   std::to_string(entry.end) + ") of " +
                                                   std::to_string(data_size) + " bytes");
  }
  if (entry.end - entry.begin != count * info->size) {
    throw fail("as many bytes as dtype and shape need", std::to_string(entry.end - entry.begin));
  }
  return entry;
}

}  // namespace

const char* DTypeName(DType dtype) { return InfoOf(dtype).name; }
std::size_t DTypeSize(DType dtype) { return InfoOf(dtype).size; }

std::int64_t StoredTensor::size() const {
  std::int64_t count = 1;
  for (const std::int64_t extent : shape) count *= extent;
  return count;
}

template <typename T>
StoredTensor MakeTensor(const std::vector<std::int64_t>& shape, const std::vector<T>& values) {
  StoredTensor tensor{DTypeOf<T>(), shape, std::string(values.size() * sizeof(T), '\0')};
  PREGRASP_CHECK(tensor.size() == static_cast<std::int64_t>(values.size()), ShapeText(shape),
                 values.size());
  if (!values.empty()) std::memcpy(tensor.bytes.data(), values.data(), tensor.bytes.size());
  return tensor;
}

const StoredTensor& TensorFile::at(const std::string& name) const {
  const auto found = tensors.find(name);
  if (found == tensors.end()) throw InputError(where, name, "a tensor of this name", "none");
  return found->second;
}

const std::string& TensorFile::metadata_at(const std::string& key) const {
  const auto found = metadata.find(key);
  if (found == metadata.end()) throw InputError(where, key, "an entry in the metadata", "none");
  return found->second;
}

template <typename T>
std::vector<T> TensorFile::Get(const std::string& name,
                               const std::vector<std::int64_t>& shape) const {
  const StoredTensor& tensor = at(name);
  if (tensor.dtype != DTypeOf<T>()) {
    throw InputError(where, name, std::string("dtype ") + DTypeName(DTypeOf<T>()),
                     DTypeName(tensor.dtype));
  }
  bool same = shape.size() == tensor.shape.size();
  for (std::size_t i = 0; same && i < shape.size(); ++i) {
    same = shape[i] < 0 || shape[i] == tensor.shape[i];
  }
  if (!same) throw InputError(where, name, "shape " + ShapeText(shape), ShapeText(tensor.shape));
  std::vector<T> values(static_cast<std::size_t>(tensor.size()));
  if (!values.empty()) std::memcpy(values.data(), tensor.bytes.data(), tensor.bytes.size());
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::all_of(values.begin(), values.end(), [](T v) { return std::isfinite(v); })) {
      throw InputError(where, name, "finite values", "others");
    }
  }
  return values;
}

TensorFile ParseTensors(std::string_view bytes, const std::string& where) {
  std::uint64_t header_size = 0;
  if (bytes.size() < kLengthBytes) {
    throw InputError(where, "", "a safetensors file", std::to_string(bytes.size()) + " bytes");
  }
  std::memcpy(&header_size, bytes.data(), kLengthBytes);
  if (header_size > std::min(kMaxHeaderBytes, bytes.size() - kLengthBytes)) {
    throw InputError(where, "", "a safetensors file",
                     "a header of " + std::to_string(header_size) + " bytes in a file of " +
                         std::to_string(bytes.size()));
  }
  const Json header = ParseHeader(bytes.substr(kLengthBytes, header_size), where);
  const std::string_view data = bytes.substr(kLengthBytes + header_size);

  TensorFile file;
  file.where = where;
  std::vector<Entry> entries;
  for (const auto& [name, json] : header.items()) {
    if (name != kMetadata) {
      entries.push_back(ParseEntry(name, json, data.size(), where));
      continue;
    }
    if (!json.is_object()) throw InputError(where, name, "a map of texts", "something else");
    for (const auto& [key, value] : json.items()) {
      if (!value.is_string()) throw InputError(where, key, "a text in the metadata", "no text");
      file.metadata[key] = value.get<std::string>();
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.end < b.end;
  });
  std::size_t covered = 0;
  for (const Entry& entry : entries) {
    if (entry.begin != covered) {
      throw InputError(where, entry.name, "data that starts at byte " + std::to_string(covered),
                       std::to_string(entry.begin));
    }
    covered = entry.end;
    file.tensors[entry.name] = {entry.dtype, entry.shape,
                                std::string(data.substr(entry.begin, entry.end - entry.begin))};
  }
  if (covered != data.size()) {
    throw InputError(where, "", std::to_string(covered) + " bytes of data",
                     std::to_string(data.size()));
  }
  return file;
}

std::string SerializeTensors(const TensorFile& file) {
  std::vector<std::string> names;
  for (const auto& [name, tensor] : file.tensors) names.push_back(name);
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return DTypeSize(file.tensors.at(a).dtype) > DTypeSize(file.tensors.at(b).dtype);
  });
  nlohmann::ordered_json header = nlohmann::ordered_json::object();
  if (!file.metadata.empty()) header[kMetadata] = file.metadata;
  std::size_t offset = 0;
  for (const std::string& name : names) {
    const StoredTensor& tensor = file.tensors.at(name);
    PREGRASP_CHECK(
        name != kMetadata && tensor.bytes.size() ==
                                 static_cast<std::size_t>(tensor.size()) * DTypeSize(tensor.dtype),
        name, ShapeText(tensor.shape), tensor.bytes.size());
    header[name] = {{"dtype", DTypeName(tensor.dtype)},
                    {"shape", tensor.shape},
                    {"data_offsets", {offset, offset + tensor.bytes.size()}}};
    offset += tensor.bytes.size();
  }
  std::string text = header.dump();
  text.resize((text.size() + 7) / 8 * 8, ' ');
  const std::uint64_t header_size = text.size();
  std::string bytes(kLengthBytes, '\0');
  std::memcpy(bytes.data(), &header_size, kLengthBytes);
  bytes.reserve(kLengthBytes + text.size() + offset);
  bytes += text;
  for (const std::string& name : names) bytes += file.tensors.at(name).bytes;
  return bytes;
}

TensorFile ReadTensors(const std::filesystem::path& path) {
  const std::string expected = "a readable safetensors file", other = DescribeNonFile(path);
  if (!other.empty()) throw InputError(path.string(), "", expected, other);
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw InputError(path.string(), "", expected, "one that cannot be read");
  const auto size = static_cast<std::streamoff>(in.tellg());
  std::string bytes(static_cast<std::size_t>(size), '\0');
  in.seekg(0);
  if (!in.read(bytes.data(), size)) {
    throw InputError(path.string(), "", "a readable safetensors file", "a read error");
  }
  return ParseTensors(bytes, path.string());
}

void WriteTensors(const std::filesystem::path& path, const TensorFile& file) {
  const std::string bytes = SerializeTensors(file);
  std::filesystem::path partial = path;
  partial += ".partial";
  {
    std::ofstream out(partial, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) throw InputError(path.string(), "", "a file that can be written", "a write error");
  }
  std::error_code error;
  std::filesystem::rename(partial, path, error);
  if (error) throw InputError(path.string(), "", "a file that can be written", error.message());
}

template StoredTensor MakeTensor(const std::vector<std::int64_t>&, const std::vector<float>&);
template StoredTensor MakeTensor(const std::vector<std::int64_t>&, const std::vector<double>&);
template StoredTensor MakeTensor(const std::vector<std::int64_t>&,
                                 const std::vector<std::int32_t>&);
template StoredTensor MakeTensor(const std::vector<std::int64_t>&,
                                 const std::vector<std::int64_t>&);
template StoredTensor MakeTensor(const std::vector<std::int64_t>&,
                                 const std::vector<std::uint8_t>&);
template std::vector<float> TensorFile::Get(const std::string&,
                                            const std::vector<std::int64_t>&) const;
template std::vector<double> TensorFile::Get(const std::string&,
                                             const std::vector<std::int64_t>&) const;
template std::vector<std::int32_t> TensorFile::Get(const std::string&,
                                                   const std::vector<std::int64_t>&) const;
template std::vector<std::int64_t> TensorFile::Get(const std::string&,
                                                   const std::vector<std::int64_t>&) const;
template std::vector<std::uint8_t> TensorFile::Get(const std::string&,
                                                   const std::vector<std::int64_t>&) const;

}  // namespace pregrasp
