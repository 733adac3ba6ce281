#include "tests/mjcf.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <variant>

#include "app/core/check.h"

namespace pregrasp::testing {

std::string MjcfText(const Vector3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string MjcfText(const Quaternion& q) {
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

std::string MjcfShape(const Shape& shape, const std::string& name, std::string* meshes) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return fmt::format("type=\"box\" size=\"{}\"", MjcfText(Vector3(0.5 * box->size)));
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return fmt::format("type=\"cylinder\" size=\"{} {}\"", cylinder->radius,
                       0.5 * cylinder->height);
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return fmt::format("type=\"capsule\" size=\"{} {}\"", capsule->radius, 0.5 * capsule->height);
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return fmt::format("type=\"sphere\" size=\"{}\"", sphere->radius);
  }
  // MuJoCo moves a mesh to its centre of mass and turns it, and its geoms back.
  const TriangleMesh& mesh = std::get<Mesh>(shape).mesh;
  std::string vertices;
  for (int i = 0; i < mesh.V.rows(); ++i) vertices += fmt::format(" {}", MjcfText(mesh.V.row(i)));
  *meshes += fmt::format("<mesh name=\"{}\" vertex=\"{}\"/>", name, vertices);
  return fmt::format("type=\"mesh\" mesh=\"{}\"", name);
}

std::unique_ptr<mjModel, FreeMujoco> LoadMjcf(const std::string& xml) {
  // Without a handler MuJoCo leaves a log file in the working directory.
  mju_user_warning = [](const char* text) { fmt::print(stderr, "MuJoCo: {}\n", text); };
  auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  mj_makeEmptyFileVFS(vfs.get(), "scene.xml", static_cast<int>(xml.size()));
  const int file = mj_findFileVFS(vfs.get(), "scene.xml");
  std::memcpy(vfs->filedata[file], xml.data(), xml.size());
  char error[1000] = "";
  std::unique_ptr<mjModel, FreeMujoco> model(
      mj_loadXML("scene.xml", vfs.get(), error, sizeof(error)));
  mj_deleteVFS(vfs.get());
  PREGRASP_CHECK(model != nullptr, error);
  return model;
}

}  // namespace pregrasp::testing
