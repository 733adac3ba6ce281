#include "app/hand/hand_shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "app/core/error.h"
#include "app/core/sha256.h"
#include "app/geometry/obj_text.h"
#include "app/hand/hand_meshes.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

const fs::path kAssets = fs::path(PREGRASP_SOURCE_DIR) / "assets";

std::string ReadFile(const fs::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

double CalcVolume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
    const Vector3 a = mesh.V.row(mesh.F(i, 0));
    const Vector3 b = mesh.V.row(mesh.F(i, 1));
    const Vector3 c = mesh.V.row(mesh.F(i, 2));
    sum += a.dot(b.cross(c)) / 6.0;
  }
  return sum;
}

using Meshes = std::vector<std::pair<std::string, TriangleMesh>>;
const std::map<std::string, Meshes> kMeshes = {{"shadow_right", BuildShadowMeshes()},
                                               {"four_finger", BuildFourFingerMeshes()}};

TEST(HandMeshesTest, TheCommittedFilesAreWhatTheGeneratorMakes) {
  for (const auto& [hand, meshes] : kMeshes) {
    for (const auto& [name, mesh] : meshes) {
      EXPECT_EQ(ReadFile(kAssets / "hands" / hand / "meshes" / (name + ".obj")), FormatObj(mesh, 6))
          << name << ": run pregrasp-hand-meshes assets/hands, then mend assets/MANIFEST";
    }
  }
}

TEST(HandMeshesTest, EveryMeshIsClosedAndOutward) {
  for (const auto& [hand, meshes] : kMeshes) {
    for (const auto& [name, mesh] : meshes) {
      std::map<std::pair<int, int>, int> edges;
      for (Eigen::Index i = 0; i < mesh.F.rows(); ++i) {
        for (int k = 0; k < 3; ++k) ++edges[{mesh.F(i, k), mesh.F(i, (k + 1) % 3)}];
      }
      for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1) << name;
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << name;
      }
      EXPECT_GT(CalcVolume(mesh), 1e-7) << name;
      EXPECT_LT(CalcVolume(mesh), 4e-4) << name;
    }
  }
}

// What a picture shows is what the collision checks see: the drawn hand lies within 2.5 mm of the
// capsules, and reaches every fingertip.
class HandShapesTest : public ::testing::TestWithParam<const char*> {};

TEST_P(HandShapesTest, TheDrawnHandIsTheCollisionHand) {
  const HandModel& hand = FindHand(GetParam());
  HandConfiguration relaxed;
  relaxed.q = hand.posture;
  HandPose pose;
  CalcHandPose(hand, relaxed.X_WH, relaxed.q, &pose);
  const auto X_WL = CalcLinkPoses(hand, relaxed);
  const auto outside = [&](const Vector3& p_W) {
    double least = 1.0;
    for (const HandCapsule& capsule : hand.capsules) {
      const Vector3 a = pose.CalcPoint(capsule.link, capsule.p_LA);
      const Vector3 b = pose.CalcPoint(capsule.link, capsule.p_LB);
      const double t =
          std::clamp((p_W - a).dot(b - a) / std::max(1e-12, (b - a).squaredNorm()), 0.0, 1.0);
      least = std::min(least, (p_W - a - t * (b - a)).norm() - capsule.radius);
    }
    return least;
  };
  std::array<double, kNumFingers> to_tip;
  to_tip.fill(1.0);
  double worst = 0.0;
  for (const HandShape& shape : ShapesOf(hand)) {
    for (Eigen::Index i = 0; i < shape.mesh->V.rows(); ++i) {
      const Vector3 p_W = X_WL[shape.link] * Vector3(shape.mesh->V.row(i).transpose());
      worst = std::max(worst, outside(p_W));
      EXPECT_LT(outside(p_W), 2.5e-3)
          << hand.links[shape.link].name << " at " << shape.mesh->V.row(i);
      for (int f = 0; f < hand.num_fingers; ++f) {
        const Fingertip& tip = hand.tips[f];
        const Vector3 top = pose.CalcPoint(tip.link, tip.p_LT + Vector3(0.0, 0.0, tip.radius));
        to_tip[f] = std::min(to_tip[f], (p_W - top).norm());
      }
    }
  }
  RecordProperty("worst_mm", std::to_string(1e3 * worst));
  for (int f = 0; f < hand.num_fingers; ++f) EXPECT_LT(to_tip[f], 5e-4) << kFingerNames[f];
}

INSTANTIATE_TEST_SUITE_P(Hands, HandShapesTest,
                         ::testing::Values("shadow_right", "shadow_left", "four_finger"));

TEST(HandVisualsTest, FingersShareTheirMeshes) {
  std::map<const TriangleMesh*, int> uses;
  for (const HandShape& shape : ShapesOf(ShadowHand())) ++uses[shape.mesh.get()];
  EXPECT_EQ(uses.size(), BuildShadowMeshes().size());
  EXPECT_GT(ShapesOf(ShadowHand()).size(), uses.size());
}

TEST(AssetsTest, TheManifestHoldsEveryAssetWithItsHashLicenceAndOrigin) {
  std::map<std::string, std::string> hashes;
  std::istringstream lines(ReadFile(kAssets / "MANIFEST"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string hash;
    std::string file;
    std::string licence;
    std::string origin;
    ASSERT_TRUE(words >> hash >> file >> licence >> origin) << line;
    hashes[file] = hash;
  }
  for (const auto& entry : fs::recursive_directory_iterator(kAssets)) {
    if (!entry.is_regular_file()) continue;
    const std::string file = fs::relative(entry.path(), kAssets).string();
    if (file == "MANIFEST" || file == "README.md") continue;
    EXPECT_EQ(hashes[file], Sha256OfFile(entry.path())) << file;
    hashes.erase(file);
  }
  EXPECT_EQ(hashes.size(), 0U) << hashes.begin()->first << " is listed but not there";
}

}  // namespace
}  // namespace pregrasp
