#include "app/recording/scene_file.h"

#include <gtest/gtest.h>

#include <functional>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

// Equal to the last bit: -0.0 is not 0.0.
template <typename A, typename B>
void ExpectSameBits(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  ASSERT_EQ(a.rows(), b.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      EXPECT_EQ(a(i, k), b(i, k));
      EXPECT_EQ(std::signbit(a(i, k)), std::signbit(b(i, k)));
    }
  }
}

void ExpectSame(const TriangleMesh& a, const TriangleMesh& b) {
  ExpectSameBits(a.V, b.V);
  ASSERT_EQ(a.F.rows(), b.F.rows());
  EXPECT_TRUE((a.F.array() == b.F.array()).all());
}

struct ShapeComparison {
  const Shape& other;

  void operator()(const Box& box) const { ExpectSameBits(box.size, std::get<Box>(other).size); }
  void operator()(const Cylinder& cylinder) const {
    EXPECT_EQ(cylinder.radius, std::get<Cylinder>(other).radius);
    EXPECT_EQ(cylinder.height, std::get<Cylinder>(other).height);
  }
  void operator()(const Capsule& capsule) const {
    EXPECT_EQ(capsule.radius, std::get<Capsule>(other).radius);
    EXPECT_EQ(capsule.height, std::get<Capsule>(other).height);
  }
  void operator()(const Sphere& sphere) const {
    EXPECT_EQ(sphere.radius, std::get<Sphere>(other).radius);
  }
  void operator()(const Mesh& mesh) const {
    const Mesh& m = std::get<Mesh>(other);
    EXPECT_EQ(mesh.file, m.file);
    EXPECT_EQ(mesh.scale, m.scale);
    ExpectSame(mesh.mesh, m.mesh);
  }
  void operator()(const Cloud& cloud) const {
    const Cloud& c = std::get<Cloud>(other);
    EXPECT_EQ(cloud.file, c.file);
    EXPECT_EQ(cloud.scale, c.scale);
    ExpectSameBits(cloud.points, c.points);
    ExpectSame(cloud.mesh, c.mesh);
  }
  void operator()(const Union& whole) const {
    const auto& parts = std::get<Union>(other).parts;
    ASSERT_EQ(whole.parts.size(), parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      ExpectSameBits(whole.parts[i].X_BP.matrix(), parts[i].X_BP.matrix());
      std::visit(ShapeComparison{parts[i].shape}, whole.parts[i].shape);
    }
  }
};

void ExpectSame(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.name, b.name);
  ExpectSameBits(a.gravity, b.gravity);
  EXPECT_EQ(a.fingertips.friction, b.fingertips.friction);
  EXPECT_EQ(a.fingertips.max_force, b.fingertips.max_force);
  EXPECT_EQ(a.fingertips.stiffness, b.fingertips.stiffness);
  EXPECT_EQ(a.fingertips.damping, b.fingertips.damping);
  EXPECT_EQ(a.fingertips.grasp_stiffness, b.fingertips.grasp_stiffness);
  ASSERT_EQ(a.camera.has_value(), b.camera.has_value());
  if (a.camera) {
    ExpectSameBits(a.camera->p_WCam, b.camera->p_WCam);
    ExpectSameBits(a.camera->p_WTarget, b.camera->p_WTarget);
    EXPECT_EQ(a.camera->fov_deg, b.camera->fov_deg);
  }
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    const Body& p = a.bodies[i];
    const Body& q = b.bodies[i];
    EXPECT_EQ(p.name, q.name);
    EXPECT_EQ(p.friction, q.friction);
    ExpectSameBits(p.X_WB.matrix(), q.X_WB.matrix());
    ASSERT_EQ(p.shape.index(), q.shape.index());
    std::visit(ShapeComparison{q.shape}, p.shape);
    ASSERT_EQ(p.movable(), q.movable());
    if (p.movable()) {
      EXPECT_EQ(p.mass_properties->mass, q.mass_properties->mass);
      ExpectSameBits(p.mass_properties->p_BoBcm, q.mass_properties->p_BoBcm);
      ExpectSameBits(p.mass_properties->I_BBcm, q.mass_properties->I_BBcm);
    }
  }
}

TEST(SceneFileTest, ASceneReadsBackToTheLastBit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TemporaryFolder folder;
    Scene scene = SampleScene(seed);
    if (seed % 2 == 0) scene.camera.reset();
    WriteScene(folder.path(), scene, 1.0 / 240.0);
    ExpectSame(LoadScene(folder.path() / "scene.json"), scene);
  }
}

TEST(SceneFileTest, ASceneReadBackIsWrittenWithTheSameBytes) {
  const TemporaryFolder first, second;
  WriteScene(first.path(), SampleScene(), 0.002);
  WriteScene(second.path(), LoadScene(first.path() / "scene.json"), 0.002);
  for (const char* file : {"scene.json", "meshes/object.obj", "meshes/tool.2.2.obj",
                           "meshes/scan.obj", "meshes/scan.points.obj"}) {
    EXPECT_EQ(ReadFile(first.path() / file), ReadFile(second.path() / file)) << file;
  }
}

TEST(SceneFileTest, QuaternionsAndMassesAreWhatAnotherSimulatorNeeds) {
  const TemporaryFolder folder;
  const Scene scene = SampleScene(2);
  WriteScene(folder.path(), scene, 0.002);
  const nlohmann::json json = ParseJson(ReadFile(folder.path() / "scene.json"), "scene.json");
  EXPECT_EQ(json["dt"], 0.002);
  EXPECT_EQ(json["fingertips"]["damping_N_s_per_m"],
            scene.fingertips.damping *
                std::sqrt(scene.fingertips.stiffness * scene.object().mass_properties->mass));
  ASSERT_EQ(json["bodies"].size(), scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const nlohmann::json& body = json["bodies"][i];
    const auto q = body["X_WB"]["q"].get<std::vector<double>>();
    EXPECT_GE(q[0], 0.0);
    const Matrix3 R_WB = Quaternion(q[0], q[1], q[2], q[3]).toRotationMatrix();
    EXPECT_LT((R_WB - scene.bodies[i].X_WB.linear()).cwiseAbs().maxCoeff(), 1e-15);
    const char* com = i == 0 ? "p_O_com" : "p_B_com";
    ASSERT_TRUE(body.contains(com));
    EXPECT_EQ(body["movable"], scene.bodies[i].movable());
    EXPECT_EQ(body[com].is_null(), !scene.bodies[i].movable());
    EXPECT_EQ(body["mass"].is_null(), !scene.bodies[i].movable());
    EXPECT_EQ(body["inertia"].is_null(), !scene.bodies[i].movable());
  }
}

// Writes the sample scene with one change to scene.json and returns what LoadScene says to it, with
// the path of the folder cut off.
std::string ErrorAfter(const std::function<void(nlohmann::json&)>& change) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "scene.json";
  WriteScene(folder.path(), SampleScene(), 0.002);
  nlohmann::json json = ParseJson(ReadFile(file), "");
  change(json);
  WriteFile(file, FormatJson(json));
  try {
    LoadScene(file);
  } catch (const InputError& error) {
    const std::string prefix = folder.path().string() + '/';
    const std::string message = error.what();
    EXPECT_EQ(message.find(prefix), 0U) << message;
    return message.substr(prefix.size());
  }
  return "none";
}

TEST(SceneFileTest, WhatIsWrongIsNamed) {
  using Json = nlohmann::json;
  EXPECT_EQ(ErrorAfter([](Json&) {}), "none");
  EXPECT_EQ(ErrorAfter([](Json& json) { json["schema"] = "other/1"; }),
            "scene.json: schema: expected pregrasp.scene/1, got \"other/1\"");
  EXPECT_EQ(ErrorAfter([](Json& json) { json["bodies"][1].erase("friction"); }),
            "scene.json: bodies[1].friction: expected a value, got none");
  EXPECT_EQ(
      ErrorAfter([](Json& json) { json["bodies"][1]["shape"]["kind"] = "cone"; }),
      "scene.json: bodies[1].shape.kind: expected box, cylinder, capsule, sphere, mesh, cloud "
      "or union, got \"cone\"");
  // What ValidateScene finds has its place too.
  EXPECT_EQ(ErrorAfter([](Json& json) {
              json["bodies"][0]["mass"] = -1.0;
            }).find("scene.json: bodies[0]: object.mass: expected "),
            0U);
  EXPECT_EQ(ErrorAfter([](Json& json) { json["bodies"][0]["shape"]["file"] = "../secret.obj"; }),
            "scene.json: bodies[0].shape.file: expected a path inside the run directory, got "
            "\"../secret.obj\"");
  EXPECT_EQ(ErrorAfter([](Json& json) { json["bodies"][0]["shape"]["file"] = "meshes/no.obj"; }),
            "meshes/no.obj: expected a file that can be read, got No such file or directory");
  // One half of a pose changed without the other would silently be two worlds.
  EXPECT_NE(ErrorAfter([](Json& json) {
              json["bodies"][1]["X_WB"]["q"] = {1, 0, 0, 0};
            }).find("bodies[1].X_WB.R: expected the rotation that q gives"),
            std::string::npos);
}

}  // namespace
}  // namespace pregrasp
