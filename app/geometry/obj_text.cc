#include "app/geometry/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

// Reads three blank-separated numbers that fill `text`.
template <typename Number>
bool ParseThree(std::string_view text, Number* numbers) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < 3; ++i) {
    while (at != end && *at == ' ') ++at;
    const auto result = std::from_chars(at, end, numbers[i]);
    if (result.ec != std::errc()) return false;
    at = result.ptr;
  }
  return at == end;
}

template <typename Matrix, typename Number>
Matrix ToRows(const std::vector<Number>& numbers) {
  return Eigen::Map<const Matrix>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

}  // namespace

std::string FormatObj(const TriangleMesh& mesh, std::optional<int> decimals) {
  std::string text;
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    text += 'v';
    for (int k = 0; k < 3; ++k) {
      text += ' ' + (decimals ? fmt::format("{:.{}f}", mesh.V(i, k), *decimals)
                              : FormatDouble(mesh.V(i, k)));
    }
    text += '\n';
  }
  for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
    text += fmt::format("f {} {} {}\n", mesh.F(i, 0) + 1, mesh.F(i, 1) + 1, mesh.F(i, 2) + 1);
  }
  return text;
}

TriangleMesh ParseObj(const std::string& text, const std::string& where) {
  std::vector<double> vertices;
  std::vector<int> faces;
  int line_number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    ++line_number;
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (line.empty() || line[0] == '#') continue;
    const std::string_view kind = line.substr(0, 2);
    double vertex[3];
    int face[3];
    const auto finite = [&] {
      return std::all_of(vertex, vertex + 3, [](double x) { return std::isfinite(x); });
    };
    if (kind == "v " && ParseThree(line.substr(2), vertex) && finite()) {
      vertices.insert(vertices.end(), vertex, vertex + 3);
    } else if (kind == "f " && ParseThree(line.substr(2), face)) {
      for (const int index : face) faces.push_back(index - 1);
    } else {
      throw InputError(fmt::format("{}:{}", where, line_number), "", "\"v x y z\" or \"f i j k\"",
                       '"' + std::string(line.substr(0, 40)) + '"');
    }
  }
  TriangleMesh mesh{ToRows<MatrixX3>(vertices), ToRows<MatrixX3i>(faces)};
  if (mesh.F.size() > 0 && (mesh.F.minCoeff() < 0 || mesh.F.maxCoeff() >= mesh.V.rows())) {
    throw InputError(where, "f", "vertices that exist", "one that does not");
  }
  return mesh;
}

}  // namespace pregrasp
