#pragma once

#include <string>

#include "app/geometry/load_shape.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// The 30 cm ruler of scenes/ruler.lua, as plain values: its end 1 cm inboard of the edge x = 0.
inline Scene MakeRulerScene() {
  Scene scene;
  scene.name = "ruler";
  scene.where = "ruler.lua:1";
  Body ruler;
  ruler.name = "ruler";
  ruler.where = "ruler.lua:2";
  ruler.shape = Box{{0.300, 0.030, 0.003}};
  ruler.friction = 0.3;
  ruler.X_WB.translation() = Vector3(-0.160, 0, 0.0015);
  ruler.mass_properties = MassProperties{0.025, Vector3::Zero(), Matrix3::Zero()};
  Body table;
  table.name = "table";
  table.where = "ruler.lua:3";
  table.shape = Box{{0.8, 0.6, 0.04}};
  table.friction = 0.3;
  table.X_WB.translation() = Vector3(-0.4, 0, -0.02);
  scene.bodies = {ruler, table};
  LoadShapes(scene, ".");
  return scene;
}

}  // namespace pregrasp
