#include "app/hand/obj_text.h"

#include <fmt/format.h>

#include <array>
#include <sstream>
#include <vector>

#include "app/core/error.h"

namespace pregrasp {

std::string WriteObj(const TriangleMesh& mesh) {
  std::string text;
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", mesh.V(i, 0), mesh.V(i, 1), mesh.V(i, 2));
  }
  for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
    text += fmt::format("f {} {} {}\n", mesh.F(i, 0) + 1, mesh.F(i, 1) + 1, mesh.F(i, 2) + 1);
  }
  return text;
}

TriangleMesh ReadObj(const std::string& text, const std::string& where) {
  std::vector<Vector3> vertices;
  std::vector<std::array<int, 3>> faces;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    const std::string at = fmt::format("{}:{}", where, number);
    if (kind == "v") {
      Vector3 v;
      if (!(words >> v.x() >> v.y() >> v.z())) throw InputError(at, "", "three numbers", line);
      vertices.push_back(v);
    } else if (kind == "f") {
      std::array<int, 3> f{};
      if (!(words >> f[0] >> f[1] >> f[2])) throw InputError(at, "", "three indices", line);
      faces.push_back(f);
    } else if (!kind.empty()) {
      throw InputError(at, "", "a v or f line", line);
    }
  }
  TriangleMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  mesh.F.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    mesh.V.row(static_cast<Eigen::Index>(i)) = vertices[i];
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int index = faces[i][k] - 1;
      if (index < 0 || index >= static_cast<int>(vertices.size())) {
        throw InputError(where, "f", "an index of a vertex", std::to_string(faces[i][k]));
      }
      mesh.F(static_cast<Eigen::Index>(i), k) = index;
    }
  }
  return mesh;
}

}  // namespace pregrasp
