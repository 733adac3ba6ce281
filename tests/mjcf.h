#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "app/scene/scene.h"

namespace pregrasp::testing {

/// Pieces of MuJoCo's XML, for the tests and benchmarks that hold our physics against it.
std::string MjcfText(const Vector3& v);
std::string MjcfText(const Quaternion& q);  ///< w first

/// The attributes of a geom that say its shape. A mesh is added to `meshes`, the assets, by `name`.
/// @param shape  convex, no union.
std::string MjcfShape(const Shape& shape, const std::string& name, std::string* meshes);

struct FreeMujoco {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// Fails as our own bug where MuJoCo refuses the model.
std::unique_ptr<mjModel, FreeMujoco> LoadMjcf(const std::string& xml);

}  // namespace pregrasp::testing
