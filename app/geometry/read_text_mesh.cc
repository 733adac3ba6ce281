#include "app/geometry/read_text_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "app/geometry/mesh_text.h"
#include "app/geometry/polygon.h"

namespace pregrasp {
namespace {

using internal::Fail;
using internal::kBlank;
using internal::NextLine;
using internal::NextWord;

template <typename T>
T ToNumber(std::string_view word, const char* of) {
  std::string_view digits = word;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    Fail(fmt::format("has \"{}\" for a number of {}", word, of));
  }
  return value;
}

TriangleMesh MakeMesh(const std::vector<Vector3>& vertices,
                      const std::vector<std::array<int, 3>>& faces) {
  TriangleMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    mesh.V.row(static_cast<Eigen::Index>(v)) = vertices[v];
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    mesh.F.row(static_cast<Eigen::Index>(f)) << faces[f][0], faces[f][1], faces[f][2];
  }
  return mesh;
}

// The lines of an OFF file that say something.
class OffLines {
 public:
  explicit OffLines(std::string_view bytes) : rest_(bytes) {}

  // Empty at the end of the file.
  std::string_view Next() {
    while (!rest_.empty()) {
      const std::string_view line = NextLine(rest_);
      const std::string_view content = line.substr(0, line.find('#'));
      if (content.find_first_not_of(kBlank) != std::string_view::npos) return content;
    }
    return {};
  }

 private:
  std::string_view rest_;
};

Vector3 ReadPoint(std::string_view line, const char* of) {
  Vector3 point;
  for (int k = 0; k < 3; ++k) point[k] = ToNumber<double>(NextWord(line), of);
  return point;
}

// One face's corners, as numbers of vertices.
std::vector<int> ReadFace(std::string_view line, std::size_t vertices) {
  constexpr int kMostCorners = 4096;
  const int count = ToNumber<int>(NextWord(line), "a face");
  if (count < 0 || count > kMostCorners) Fail(fmt::format("has a face of {} corners", count));
  std::vector<int> corners(static_cast<std::size_t>(count));
  for (int& corner : corners) {
    corner = ToNumber<int>(NextWord(line), "a face");
    if (corner < 0 || corner >= static_cast<std::int64_t>(vertices)) {
      Fail(fmt::format("has a face with vertex {} of {}", corner, vertices));
    }
  }
  return corners;
}

}  // namespace

TriangleMesh ParseOff(std::string_view bytes) {
  OffLines lines(bytes);
  std::string_view line = lines.Next();
  std::string_view after = line;
  const std::string_view keyword = NextWord(after);
  if (keyword.size() >= 3 && keyword.substr(keyword.size() - 3) == "OFF") {
    if (after.find("BINARY") != std::string_view::npos) Fail("is binary, which is not read");
    const bool counts_follow = after.find_first_not_of(kBlank) != std::string_view::npos;
    line = counts_follow ? after : lines.Next();
    if (keyword.find('4') != std::string_view::npos ||
        keyword.find('n') != std::string_view::npos) {
      Fail("has vertices of more than three dimensions");
    }
  }
  const auto num_vertices = ToNumber<std::uint32_t>(NextWord(line), "vertices");
  const auto num_faces = ToNumber<std::uint32_t>(NextWord(line), "faces");
  std::vector<Vector3> vertices;
  while (vertices.size() < num_vertices) {
    line = lines.Next();
    if (line.empty()) Fail(fmt::format("has {} of {} vertices", vertices.size(), num_vertices));
    vertices.push_back(ReadPoint(line, "a vertex"));
  }
  std::vector<std::array<int, 3>> faces;
  for (std::uint32_t f = 0; f < num_faces; ++f) {
    line = lines.Next();
    if (line.empty()) Fail(fmt::format("has {} of {} faces", f, num_faces));
    const std::vector<int> corners = ReadFace(line, vertices.size());
    std::vector<Vector3> points;
    points.reserve(corners.size());
    for (const int corner : corners) points.push_back(vertices[static_cast<std::size_t>(corner)]);
    for (const std::array<int, 3>& triangle : TriangulatePolygon(points)) {
      faces.push_back({corners[static_cast<std::size_t>(triangle[0])],
                       corners[static_cast<std::size_t>(triangle[1])],
                       corners[static_cast<std::size_t>(triangle[2])]});
    }
  }
  return MakeMesh(vertices, faces);
}

bool IsTextStl(std::string_view bytes) {
  constexpr std::size_t kHeader = 84, kFacet = 50;  // [bytes]
  if (bytes.substr(0, 5) != "solid") return false;
  if (bytes.size() < kHeader) return true;
  std::uint32_t facets = 0;
  std::memcpy(&facets, bytes.data() + kHeader - sizeof facets, sizeof facets);
  return bytes.size() != kHeader + kFacet * facets;
}

TriangleMesh ParseTextStl(std::string_view bytes) {
  std::vector<Vector3> vertices;
  std::vector<std::array<int, 3>> faces;
  int in_facet = 0;
  while (!bytes.empty()) {
    std::string_view line = NextLine(bytes);
    const std::string_view key = NextWord(line);
    if (key == "vertex") {
      vertices.push_back(ReadPoint(line, "a vertex"));
      ++in_facet;
    } else if (key == "endfacet") {
      if (in_facet != 3) Fail(fmt::format("has a facet of {} vertices", in_facet));
      const int last = static_cast<int>(vertices.size()) - 1;
      faces.push_back({last - 2, last - 1, last});
      in_facet = 0;
    }
  }
  if (in_facet != 0) Fail("ends within a facet");
  return MakeMesh(vertices, faces);
}

}  // namespace pregrasp
