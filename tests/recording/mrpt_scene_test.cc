// Scenes are read back through MRPT's own classes, as SceneViewer3D does.
#include "app/recording/mrpt_scene.h"

#include <gtest/gtest.h>
#include <mrpt/opengl/CArrow.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CSphere.h>
#include <mrpt/opengl/CText.h>

#include "app/core/error.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

TEST(MrptSceneTest, MrptFindsEveryMeshArrowBallLineAndText) {
  MrptScene scene;
  const auto box = std::make_shared<const TriangleMesh>(Tessellate(Box{{0.1, 0.2, 0.3}}));
  const RigidTransform X_WB = MakeTransform(Quaternion::Identity(), {1.0, 0.0, 0.5});
  scene.meshes.push_back({box, X_WB, {1.0F, 0.0F, 0.0F, 0.5F}, {}});
  scene.arrows.push_back({{0.0, 0.0, 0.0}, {0.0, 0.0, 0.1}, 0.002, {0.0F, 1.0F, 0.0F, 1.0F}});
  scene.balls.push_back({{0.0, 0.2, 0.0}, 0.01, {0.0F, 0.0F, 1.0F, 1.0F}});
  scene.lines.push_back({{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.1, 0.1, 0.0}}, {}});
  scene.labels.push_back({{0.0, 0.0, 0.1}, "0.50 N", {}});
  const fs::path file = fs::path(::testing::TempDir()) / "step.3Dscene";
  WriteMrptScene(file, scene);

  mrpt::opengl::COpenGLScene read;
  ASSERT_TRUE(read.loadFromFile(file.string()));
  const auto mesh = read.getByClass<mrpt::opengl::CSetOfTriangles>();
  ASSERT_TRUE(mesh);
  ASSERT_EQ(mesh->getTrianglesCount(), static_cast<std::size_t>(box->F.rows()));
  mrpt::opengl::TTriangle triangle;
  mesh->getTriangle(0, triangle);
  EXPECT_NEAR(triangle.x(0), 1.0, 0.0501);
  EXPECT_NEAR(std::abs(triangle.z(0) - 0.5F), 0.15, 1e-6);
  EXPECT_EQ(triangle.r(0), 255);
  EXPECT_EQ(triangle.a(0), 128);
  EXPECT_TRUE(read.getByClass<mrpt::opengl::CArrow>());
  EXPECT_TRUE(read.getByClass<mrpt::opengl::CSphere>());
  const auto lines = read.getByClass<mrpt::opengl::CSetOfLines>();
  ASSERT_TRUE(lines);
  EXPECT_EQ(lines->getLineCount(), 2U);
  const auto text = read.getByClass<mrpt::opengl::CText>();
  ASSERT_TRUE(text);
  EXPECT_EQ(text->getString(), "0.50 N");
}

TEST(MrptSceneTest, AFileThatCannotBeWrittenIsNamed) {
  try {
    WriteMrptScene("/nowhere/step.3Dscene", {});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "/nowhere/step.3Dscene");
  }
}

}  // namespace
}  // namespace pregrasp
