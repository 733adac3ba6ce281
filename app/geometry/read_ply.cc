#include "app/geometry/read_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "app/geometry/mesh_text.h"
#include "app/geometry/polygon.h"

namespace pregrasp {
namespace {

using internal::Fail;
using internal::NextWord;

enum class Encoding { kAscii, kLittle, kBig };
enum class Number { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct Property {
  std::string name;
  Number value = Number::kFloat;
  std::optional<Number> list_count;  // a list, whose length has this type
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
};

std::string_view NextHeaderLine(std::string_view& rest) {
  if (rest.find('\n') == std::string_view::npos) Fail("ends within its header");
  return internal::NextLine(rest);
}

Number ParseType(std::string_view word) {
  static const std::map<std::string_view, Number> kTypes = {
      {"char", Number::kInt8},     {"int8", Number::kInt8},     {"uchar", Number::kUint8},
      {"uint8", Number::kUint8},   {"short", Number::kInt16},   {"int16", Number::kInt16},
      {"ushort", Number::kUint16}, {"uint16", Number::kUint16}, {"int", Number::kInt32},
      {"int32", Number::kInt32},   {"uint", Number::kUint32},   {"uint32", Number::kUint32},
      {"float", Number::kFloat},   {"float32", Number::kFloat}, {"double", Number::kDouble},
      {"float64", Number::kDouble}};
  const auto it = kTypes.find(word);
  if (it == kTypes.end()) Fail(fmt::format("has a property of unknown type \"{}\"", word));
  return it->second;
}

Property ParseProperty(std::string_view line) {
  Property property;
  std::string_view type = NextWord(line);
  if (type == "list") {
    property.list_count = ParseType(NextWord(line));
    type = NextWord(line);
  }
  property.value = ParseType(type);
  property.name = NextWord(line);
  return property;
}

Element ParseElement(std::string_view line) {
  Element element;
  element.name = NextWord(line);
  const std::string_view count = NextWord(line);
  const auto [end, error] =
      std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || end != count.data() + count.size()) {
    Fail(fmt::format("has \"{}\" elements of \"{}\"", count, element.name));
  }
  return element;
}

// Leaves `rest` at the first byte after the header.
PlyHeader ParseHeader(std::string_view& rest) {
  if (rest.substr(0, 3) != "ply") Fail("does not begin with \"ply\"");
  NextHeaderLine(rest);
  PlyHeader header;
  bool has_format = false;
  for (;;) {
    std::string_view line = NextHeaderLine(rest);
    const std::string_view key = NextWord(line);
    if (key == "end_header") break;
    if (key == "format") {
      const std::string_view format = NextWord(line);
      static const std::map<std::string_view, Encoding> kEncodings = {
          {"ascii", Encoding::kAscii},
          {"binary_little_endian", Encoding::kLittle},
          {"binary_big_endian", Encoding::kBig}};
      const auto it = kEncodings.find(format);
      if (it == kEncodings.end()) Fail(fmt::format("has the unknown format \"{}\"", format));
      header.encoding = it->second;
      has_format = true;
    } else if (key == "element") {
      header.elements.push_back(ParseElement(line));
    } else if (key == "property") {
      if (header.elements.empty()) Fail("has a property before any element");
      header.elements.back().properties.push_back(ParseProperty(line));
    } else if (key != "comment" && key != "obj_info" && !key.empty()) {
      Fail(fmt::format("has the unknown header line \"{}\"", key));
    }
  }
  if (!has_format) Fail("has no format in its header");
  return header;
}

// Takes numbers off the front of the body.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, Encoding encoding) : rest_(bytes), encoding_(encoding) {}

  double Next(Number type, const Element& element) {
    if (encoding_ == Encoding::kAscii) return NextText(element);
    switch (type) {
      case Number::kInt8:
        return NextBinary<std::int8_t>(element);
      case Number::kUint8:
        return NextBinary<std::uint8_t>(element);
      case Number::kInt16:
        return NextBinary<std::int16_t>(element);
      case Number::kUint16:
        return NextBinary<std::uint16_t>(element);
      case Number::kInt32:
        return NextBinary<std::int32_t>(element);
      case Number::kUint32:
        return NextBinary<std::uint32_t>(element);
      case Number::kFloat:
        return NextBinary<float>(element);
      case Number::kDouble:
        break;
    }
    return NextBinary<double>(element);
  }

  std::size_t size() const { return rest_.size(); }

 private:
  double NextText(const Element& element) {
    std::string_view word = NextWord(rest_);
    if (word.empty()) Fail(fmt::format("ends within element \"{}\"", element.name));
    if (word.front() == '+') word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      Fail(fmt::format("has \"{}\" for a number in element \"{}\"", word, element.name));
    }
    return value;
  }

  template <typename T>
  double NextBinary(const Element& element) {
    if (rest_.size() < sizeof(T)) Fail(fmt::format("ends within element \"{}\"", element.name));
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    static_assert(std::endian::native == std::endian::little);
    if (encoding_ == Encoding::kBig) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
  }

  std::string_view rest_;
  Encoding encoding_;
};

// One element's numbers; lists are read whole.
std::vector<double> ReadProperty(PlyBody& body, const Property& property, const Element& element) {
  std::size_t count = 1;
  if (property.list_count) {
    const double length = body.Next(*property.list_count, element);
    constexpr double kLongestList = 1e6;  // a face has three corners, or a few more
    const double most = std::min(kLongestList, static_cast<double>(body.size()));
    if (!(length >= 0.0 && length <= most)) {
      Fail(fmt::format("has a list of {} in element \"{}\"", length, element.name));
    }
    count = static_cast<std::size_t>(length);
  }
  std::vector<double> values(count);
  for (double& value : values) value = body.Next(property.value, element);
  return values;
}

void ReadVertices(PlyBody& body, const Element& element, PlyContent& content) {
  std::array<int, 6> slots{-1, -1, -1, -1, -1, -1};
  static constexpr std::array<const char*, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      if (element.properties[p].name == kNames[k]) slots[k] = static_cast<int>(p);
    }
  }
  if (*std::min_element(slots.begin(), slots.begin() + 3) < 0) {
    Fail("has vertices without x, y and z");
  }
  const bool has_normals = *std::min_element(slots.begin() + 3, slots.end()) >= 0;
  content.V.resize(static_cast<int>(element.count), 3);
  content.N.resize(has_normals ? static_cast<int>(element.count) : 0, 3);
  std::vector<double> values(element.properties.size());
  for (int v = 0; v < content.V.rows(); ++v) {
    for (std::size_t p = 0; p < values.size(); ++p) {
      const Property& property = element.properties[p];
      const std::vector<double> read = ReadProperty(body, property, element);
      values[p] = read.empty() ? 0.0 : read.front();
    }
    for (int k = 0; k < 3; ++k) content.V(v, k) = values[slots[k]];
    for (int k = 0; has_normals && k < 3; ++k) content.N(v, k) = values[slots[3 + k]];
  }
}

// Faces as they are in the file: the corners of all, and where each one's begin.
struct Polygons {
  std::vector<int> corners;
  std::vector<std::size_t> begins;
};

Polygons ReadFaces(PlyBody& body, const Element& element) {
  Polygons polygons;
  constexpr double kMostVertices = std::numeric_limits<int>::max();
  for (std::size_t f = 0; f < element.count; ++f) {
    for (const Property& property : element.properties) {
      const std::vector<double> corners = ReadProperty(body, property, element);
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      constexpr std::size_t kMostCorners = 4096;
      if (corners.size() > kMostCorners) {
        Fail(fmt::format("has a face of {} corners", corners.size()));
      }
      polygons.begins.push_back(polygons.corners.size());
      for (const double corner : corners) {
        if (!(corner >= 0.0 && corner < kMostVertices)) {
          Fail(fmt::format("has a face with vertex {}", corner));
        }
        polygons.corners.push_back(static_cast<int>(corner));
      }
    }
  }
  polygons.begins.push_back(polygons.corners.size());
  return polygons;
}

// The triangles of all faces, once the vertices are known: in a file either may come first.
void Triangulate(const Polygons& polygons, PlyContent& content) {
  std::vector<std::array<int, 3>> triangles;
  std::vector<Vector3> points;
  for (std::size_t f = 0; f + 1 < polygons.begins.size(); ++f) {
    const std::span<const int> corners(polygons.corners.data() + polygons.begins[f],
                                       polygons.begins[f + 1] - polygons.begins[f]);
    points.clear();
    for (const int corner : corners) {
      if (corner >= content.V.rows()) {
        Fail(fmt::format("has a face with vertex {} of {}", corner, content.V.rows()));
      }
      points.emplace_back(content.V.row(corner));
    }
    for (const std::array<int, 3>& triangle : TriangulatePolygon(points)) {
      triangles.push_back({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]});
    }
  }
  content.F.resize(static_cast<int>(triangles.size()), 3);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (int i = 0; i < 3; ++i) content.F(static_cast<int>(f), i) = triangles[f][i];
  }
}

}  // namespace

PlyContent ParsePly(std::string_view bytes) {
  const PlyHeader header = ParseHeader(bytes);
  for (const char* name : {"vertex", "face"}) {
    const auto count = std::count_if(header.elements.begin(), header.elements.end(),
                                     [&](const Element& element) { return element.name == name; });
    if (count > 1) Fail(fmt::format("has {} elements \"{}\"", count, name));
  }
  const auto strips = std::any_of(header.elements.begin(), header.elements.end(),
                                  [](const Element& e) { return e.name == "tristrips"; });
  if (strips) Fail("has triangle strips, which are not read");
  PlyBody body(bytes, header.encoding);
  PlyContent content;
  Polygons polygons;
  for (const Element& element : header.elements) {
    // Each number takes a byte at least: no file can promise more elements than it has bytes.
    if (element.count > body.size()) Fail(fmt::format("ends within element \"{}\"", element.name));
    if (element.name == "vertex") {
      ReadVertices(body, element, content);
    } else if (element.name == "face") {
      polygons = ReadFaces(body, element);
    } else {
      for (std::size_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) ReadProperty(body, property, element);
      }
    }
  }
  Triangulate(polygons, content);
  return content;
}

}  // namespace pregrasp
