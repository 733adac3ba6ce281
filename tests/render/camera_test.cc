#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/core/rng.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

MatrixX3 RandomBox(Rng& rng) {
  const Vector3 center = rng.Uniform(0.0, 2.0) * rng.Direction();
  // From a bead to a large box.
  const double size = std::pow(10.0, rng.Uniform(-2.5, 0.0));
  const Vector3 half =
      size * Vector3(rng.Uniform(0.005, 0.5), rng.Uniform(0.005, 0.5), rng.Uniform(0.001, 0.3));
  MatrixX3 points(8, 3);
  for (int i = 0; i < 8; ++i) {
    const Vector3 sign((i & 1) * 2 - 1, ((i >> 1) & 1) * 2 - 1, (i >> 2) * 2 - 1);
    points.row(i) = center + half.cwiseProduct(sign);
  }
  return points;
}

TEST(FrameCameraTest, ShowsEveryPointWithABorderAndIsAsNearAsThatAllows) {
  Rng rng(5);
  for (int seed = 0; seed < 300; ++seed) {
    const MatrixX3 focus = RandomBox(rng);
    const double aspect = rng.Uniform(0.5, 2.5), fov = rng.Uniform(15.0, 70.0);
    const Vector3 dir = seed % 10 == 0 ? Vector3(Vector3::UnitZ()) : rng.Direction();
    const RenderCamera camera = FrameCamera(focus, dir, aspect, fov);
    const int height = 1000, width = static_cast<int>(std::lround(aspect * height));
    const CameraView view = MakeCameraView(camera, width, height);
    EXPECT_LT((view.R_WCam.col(2) - dir.normalized()).norm(), 1e-6) << seed;
    Vector2 low(width, height), high(0, 0);
    for (Eigen::Index i = 0; i < focus.rows(); ++i) {
      const auto at = view.Project(focus.row(i).transpose());
      ASSERT_TRUE(at.has_value()) << seed;
      low = low.cwiseMin(*at);
      high = high.cwiseMax(*at);
    }
    EXPECT_GE(low.x(), 0.099 * width) << seed;
    EXPECT_LE(high.x(), 0.901 * width) << seed;
    EXPECT_GE(low.y(), 0.149 * height) << seed;
    EXPECT_LE(high.y(), 0.891 * height) << seed;
    // Tight along one axis, unless the smallest distance keeps the camera off.
    const bool tight = high.x() - low.x() > 0.79 * width || high.y() - low.y() > 0.73 * height;
    const double nearest = (focus * view.R_WCam.col(2)).maxCoeff() + 2e-3;
    EXPECT_TRUE(tight || view.p_WCam.dot(view.R_WCam.col(2)) < nearest + 1e-9) << seed;
  }
}

TEST(FrameCameraTest, OnePointAndOneLineAreShownToo) {
  const MatrixX3 point = Vector3(0.1, 0.2, 0.3).transpose();
  const RenderCamera camera = FrameCamera(point, Vector3(1, 1, 1), 1.5);
  const auto at = MakeCameraView(camera, 300, 200).Project(point.row(0).transpose());
  ASSERT_TRUE(at.has_value());
  EXPECT_NEAR(at->x(), 150.0, 1e-6);
  MatrixX3 line(2, 3);
  line << 0, 0, 0, 0, 0, 1;
  EXPECT_NO_THROW(MakeCameraView(FrameCamera(line, Vector3::UnitZ(), 1.5), 300, 200));
}

TEST(CameraViewTest, ProjectsTheTargetToTheMiddleAndUpToTheTop) {
  Rng rng(8);
  for (int seed = 0; seed < 50; ++seed) {
    RenderCamera camera;
    camera.p_WTarget = rng.Direction();
    camera.p_WCam = camera.p_WTarget + rng.Uniform(0.1, 3.0) * rng.Direction();
    const CameraView view = MakeCameraView(camera, 640, 360);
    EXPECT_NEAR((*view.Project(camera.p_WTarget) - Vector2(320, 180)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((view.R_WCam.transpose() * view.R_WCam - Matrix3::Identity()).norm(), 0.0, 1e-12);
    // At the target's distance the picture is view_height high.
    const Vector3 top = camera.p_WTarget + 0.5 * view.view_height() * view.R_WCam.col(1);
    EXPECT_NEAR((*view.Project(top) - Vector2(320, 0)).norm(), 0.0, 1e-6);
    EXPECT_FALSE(view.Project(view.p_WCam - 0.1 * view.forward()).has_value());
  }
}

TEST(CameraViewTest, LooksStraightDownWithYUpwards) {
  RenderCamera camera;
  camera.p_WCam = {0, 0, 1};
  const CameraView view = MakeCameraView(camera, 640, 360);
  const Vector2 y = *view.Project({0, 0.1, 0}), x = *view.Project({0.1, 0, 0});
  EXPECT_LT(y.y(), 170.0);
  EXPECT_GT(x.x(), 330.0);
}

}  // namespace
}  // namespace pregrasp
