#include "render/upright.h"

namespace pregrasp {

Matrix3 UprightRotation(const Vector3& up_W) {
  return Quaternion::FromTwoVectors(up_W, Vector3::UnitZ()).toRotationMatrix();
}

RenderCamera Rotated(RenderCamera camera, const Matrix3& R) {
  camera.p_WCam = R * camera.p_WCam;
  camera.p_WTarget = R * camera.p_WTarget;
  return camera;
}

RenderScene Rotated(RenderScene scene, const Matrix3& R) {
  const auto turn = [&R](Vector3& v) { v = R * v; };
  for (RenderBody& body : scene.bodies) body.X_WB = Eigen::Isometry3d(R) * body.X_WB;
  for (RenderArrow& arrow : scene.arrows) {
    turn(arrow.p_W);
    turn(arrow.v_W);
  }
  for (RenderCone& cone : scene.cones) {
    turn(cone.p_W);
    turn(cone.axis_W);
  }
  for (RenderPoint& point : scene.points) turn(point.p_W);
  for (RenderLine& line : scene.lines) {
    for (Vector3& p_W : line.p_W) turn(p_W);
  }
  for (RenderLabel& label : scene.labels) turn(label.p_W);
  scene.camera = Rotated(scene.camera, R);
  if (scene.to_light_W) turn(*scene.to_light_W);
  turn(scene.up_W);
  scene.R_WAxes = R * scene.R_WAxes;
  return scene;
}

}  // namespace pregrasp
