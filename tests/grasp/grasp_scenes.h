#pragma once

#include <cmath>
#include <string>

#include "app/geometry/mass_properties.h"
#include "app/grasp/grasp_world.h"
#include "app/scene/scene.h"

namespace pregrasp {

// Worlds of the test of a grasp, in numbers: x points toward the user, z up, tables have their top
// at z = 0.

inline Body FixedBox(const std::string& name, const Vector3& size, const Vector3& p) {
  Body body;
  body.name = name;
  body.shape = Box{size};
  body.X_WB = MakeTransform(Matrix3(Matrix3::Identity()), p);
  return body;
}

inline Scene MakeScene(const std::string& name, const Shape& shape, double mass,
                       const RigidTransform& X_WO) {
  Scene scene;
  scene.name = name;
  Body object;
  object.name = "object";
  object.shape = shape;
  object.X_WB = X_WO;
  object.mass_properties = CalcMassProperties(shape, mass);
  scene.bodies.push_back(object);
  return scene;
}

inline RigidTransform Shift(double x, double y, double z) {
  return MakeTransform(Matrix3(Matrix3::Identity()), Vector3(x, y, z));
}

/// A ruler or a sheet of card flat on a table; the table ends `overhang` short of the object's end
/// toward the user (negative: it goes on beyond).
inline Scene FlatScene(const Vector3& size, double mass, double overhang) {
  Scene scene = MakeScene("flat", Box{size}, mass, Shift(0, 0, 0.5 * size.z()));
  const double edge = 0.5 * size.x() - overhang;
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {edge - 0.4, 0, -0.01}));
  return scene;
}

inline Scene RulerScene(double overhang) {
  return FlatScene({0.300, 0.030, 0.003}, 0.025, overhang);
}

/// A book upright between two books, 1 mm from each, a wall 5 mm behind, a board 6 cm above.
inline Scene BookScene() {
  const Vector3 size(0.155, 0.030, 0.230);
  Scene scene = MakeScene("book", Box{size}, 0.6, Shift(0, 0, 0.115));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {-0.2, 0, -0.01}));
  scene.bodies.push_back(FixedBox("left", size, {0, 0.031, 0.115}));
  scene.bodies.push_back(FixedBox("right", size, {0, -0.031, 0.115}));
  scene.bodies.push_back(FixedBox("wall", {0.02, 0.8, 0.4}, {-0.0775 - 0.005 - 0.01, 0, 0.2}));
  scene.bodies.push_back(FixedBox("above", {0.155, 0.8, 0.02}, {0, 0, 0.230 + 0.06 + 0.01}));
  return scene;
}

/// A keyboard flat on a shelf, its front long side 1 cm from the edge, `back` from a wall behind.
inline Scene KeyboardScene(double back) {
  const Vector3 size(0.130, 0.440, 0.020);
  Scene scene = MakeScene("keyboard", Box{size}, 0.7, Shift(0, 0, 0.010));
  scene.bodies.push_back(FixedBox("shelf", {0.8, 1.2, 0.02}, {0.065 + 0.01 - 0.4, 0, -0.01}));
  scene.bodies.push_back(FixedBox("wall", {0.02, 1.2, 0.4}, {-0.065 - back - 0.01, 0, 0.2}));
  return scene;
}

/// A marker lying in a groove: rails 1.5 mm beside it, a stop at one end, 6 cm free at the other.
inline Scene MarkerScene() {
  Scene scene = MakeScene("marker", Cylinder{0.009, 0.14}, 0.02,
                          MakeTransform(RotationFromRpy({0, 0.5 * kPi, 0}), Vector3(0, 0, 0.009)));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {0, 0, -0.01}));
  const double side = 0.009 + 0.0015 + 0.005;
  scene.bodies.push_back(FixedBox("left", {0.27, 0.01, 0.02}, {0.0, side, 0.01}));
  scene.bodies.push_back(FixedBox("right", {0.27, 0.01, 0.02}, {0.0, -side, 0.01}));
  scene.bodies.push_back(
      FixedBox("stop", {0.01, 0.021, 0.025}, {-0.07 - 0.001 - 0.005, 0, 0.0125}));
  return scene;
}

/// A square carton between two others and before a wall, all 2 mm off, in a row on a shelf.
inline Scene CartonScene() {
  const Vector3 size(0.07, 0.07, 0.20);
  Scene scene = MakeScene("carton", Box{size}, 0.53, Shift(0, 0, 0.1));
  scene.bodies.push_back(FixedBox("table", {0.8, 0.8, 0.02}, {-0.2, 0, -0.01}));
  scene.bodies.push_back(FixedBox("left", size, {0, 0.072, 0.1}));
  scene.bodies.push_back(FixedBox("right", size, {0, -0.072, 0.1}));
  scene.bodies.push_back(FixedBox("wall", {0.02, 0.8, 0.4}, {-0.035 - 0.002 - 0.01, 0, 0.2}));
  return scene;
}

/// The same carton alone on a table.
inline Scene FreeCartonScene() {
  Scene scene = CartonScene();
  scene.bodies.resize(2);
  return scene;
}

/// A ruler of 300 x 30 x 3 mm in free air, flat: its faces are z = +-1.5 mm in O.
inline Scene FreeRulerScene() {
  Scene scene = RulerScene(0.0);
  scene.object().X_WB.translation().z() = 0.5;
  return scene;
}
/// On its upper (`side` 1) or lower (-1) face.
inline GraspContact OnRulerFace(Finger finger, double side, double x, double y) {
  return {finger, {x, y, 0.0015 * side}, {0, 0, side}};
}

}  // namespace pregrasp
