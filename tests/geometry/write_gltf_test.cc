// Files are read back by assimp, as another program would.
#include "app/geometry/write_gltf.h"

#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <fstream>
#include <map>
#include <sstream>

#include "app/core/error.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A box that turns and climbs, over a slab that stands.
std::vector<AnimatedMesh> MakeMeshes() {
  const auto mesh = [](const Shape& shape) {
    return std::make_shared<const TriangleMesh>(Tessellate(shape));
  };
  AnimatedMesh box{"box", mesh(Box{{0.1, 0.2, 0.3}}), {1.0F, 0.5F, 0.0F, 1.0F}, {}};
  for (int i = 0; i < 4; ++i) {
    box.X_WB.push_back(
        MakeTransform(RotationFromRpy({0.2 * i, 0.0, 1.5 * i}), {0.0, 0.1, 0.1 * i}));
  }
  AnimatedMesh slab{"slab", mesh(Box{{1.0, 1.0, 0.02}}), {0.2F, 0.3F, 0.4F, 1.0F}, {}};
  slab.X_WB = {MakeTransform(Quaternion::Identity(), {0.0, 0.0, -0.01})};
  return {box, slab};
}

const std::vector<double> kTimes = {0.0, 0.1, 0.25, 0.5};

std::string Bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

TEST(WriteGltfTest, AnotherReaderFindsMeshesColoursAndPosesAtTheirTimes) {
  const fs::path file = fs::path(::testing::TempDir()) / "film.glb";
  const std::vector<AnimatedMesh> meshes = MakeMeshes();
  WriteGltf(file, meshes, kTimes);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  ASSERT_EQ(scene->mNumMeshes, 2U);
  EXPECT_EQ(scene->mMeshes[0]->mNumFaces, static_cast<unsigned>(meshes[0].mesh->F.rows()));
  aiColor4D color;
  ASSERT_EQ(scene->mMaterials[0]->Get(AI_MATKEY_BASE_COLOR, color), aiReturn_SUCCESS);
  EXPECT_FLOAT_EQ(color.g, 0.5F);

  // y up there: our z.
  const aiNode* slab = scene->mRootNode->FindNode("slab");
  ASSERT_NE(slab, nullptr);
  aiMatrix4x4 X;
  for (const aiNode* node = slab; node != nullptr; node = node->mParent) {
    X = node->mTransformation * X;
  }
  float low = 1.0F, high = -1.0F;
  for (unsigned i = 0; i < scene->mMeshes[1]->mNumVertices; ++i) {
    const float y = (X * scene->mMeshes[1]->mVertices[i]).y;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  EXPECT_NEAR(low, -0.02, 1e-6);
  EXPECT_NEAR(high, 0.0, 1e-6);

  ASSERT_EQ(scene->mNumAnimations, 1U);
  ASSERT_EQ(scene->mAnimations[0]->mNumChannels, 1U);
  const double tick = 1.0 / scene->mAnimations[0]->mTicksPerSecond;
  const aiNodeAnim* channel = scene->mAnimations[0]->mChannels[0];
  EXPECT_STREQ(channel->mNodeName.C_Str(), "box");
  ASSERT_EQ(channel->mNumPositionKeys, kTimes.size());
  ASSERT_EQ(channel->mNumRotationKeys, kTimes.size());
  for (unsigned i = 0; i < kTimes.size(); ++i) {
    EXPECT_NEAR(channel->mPositionKeys[i].mTime * tick, kTimes[i], 1e-6);
    EXPECT_NEAR(channel->mRotationKeys[i].mTime * tick, kTimes[i], 1e-6);
    const aiVector3D& p = channel->mPositionKeys[i].mValue;
    const aiQuaternion& q = channel->mRotationKeys[i].mValue;
    const RigidTransform read = MakeTransform(Quaternion(q.w, q.x, q.y, q.z), {p.x, p.y, p.z});
    EXPECT_LT((read.matrix() - meshes[0].X_WB[i].matrix()).norm(), 1e-6) << i;
  }
}

TEST(WriteGltfTest, TheSameInputGivesTheSameBytes) {
  const fs::path a = fs::path(::testing::TempDir()) / "a.glb",
                 b = fs::path(::testing::TempDir()) / "b.glb";
  WriteGltf(a, MakeMeshes(), kTimes);
  WriteGltf(b, MakeMeshes(), kTimes);
  EXPECT_EQ(Bytes(a), Bytes(b));
}

TEST(WriteGltfTest, AFileThatCannotBeWrittenIsNamed) {
  try {
    WriteGltf("/nowhere/film.glb", MakeMeshes(), kTimes);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "/nowhere/film.glb");
  }
}

}  // namespace
}  // namespace pregrasp
