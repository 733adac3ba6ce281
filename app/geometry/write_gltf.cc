#include "app/geometry/write_gltf.h"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Exporter.hpp>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

aiVector3D ToAssimp(const Vector3& v) {
  return {static_cast<ai_real>(v.x()), static_cast<ai_real>(v.y()), static_cast<ai_real>(v.z())};
}

aiQuaternion ToAssimp(const Quaternion& q) {
  return {static_cast<ai_real>(q.w()), static_cast<ai_real>(q.x()), static_cast<ai_real>(q.y()),
          static_cast<ai_real>(q.z())};
}

aiMatrix4x4 ToAssimp(const RigidTransform& X) {
  return {aiVector3D(1.0F, 1.0F, 1.0F), ToAssimp(Quaternion(X.linear())),
          ToAssimp(Vector3(X.translation()))};
}

// Every triangle with corners and a normal of its own: edges stay sharp. What stands is in W as it
// is: assimp 5.2 leaves out a node's transform that is within 0.01 of none.
aiMesh* MakeMesh(const AnimatedMesh& animated, unsigned material) {
  const TriangleMesh& mesh = *animated.mesh;
  const RigidTransform X_NM =
      animated.X_WB.size() == 1 ? animated.X_WB.front() : RigidTransform::Identity();
  auto* result = new aiMesh;
  const auto count = static_cast<unsigned>(mesh.F.rows());
  result->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  result->mMaterialIndex = material;
  const std::size_t corners = std::size_t{3} * count;
  result->mNumVertices = 3 * count;
  result->mVertices = new aiVector3D[corners];
  result->mNormals = new aiVector3D[corners];
  result->mNumFaces = count;
  result->mFaces = new aiFace[count];
  for (unsigned f = 0; f < count; ++f) {
    Vector3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = X_NM * Vector3(mesh.V.row(mesh.F(f, k)).transpose());
    const Vector3 nhat = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
    result->mFaces[f].mNumIndices = 3;
    result->mFaces[f].mIndices = new unsigned[3];
    for (unsigned k = 0; k < 3; ++k) {
      result->mVertices[3 * f + k] = ToAssimp(p[k]);
      result->mNormals[3 * f + k] = ToAssimp(nhat);
      result->mFaces[f].mIndices[k] = 3 * f + k;
    }
  }
  return result;
}

aiMaterial* MakeMaterial(const AnimatedMesh& mesh) {
  auto* material = new aiMaterial;
  const aiString name(mesh.name);
  const aiColor4D color(mesh.rgba[0], mesh.rgba[1], mesh.rgba[2], mesh.rgba[3]);
  material->AddProperty(&name, AI_MATKEY_NAME);
  material->AddProperty(&color, 1, AI_MATKEY_COLOR_DIFFUSE);
  material->AddProperty(&color, 1, AI_MATKEY_BASE_COLOR);
  return material;
}

aiNodeAnim* MakeChannel(const AnimatedMesh& mesh, const std::vector<double>& times) {
  PREGRASP_CHECK(mesh.X_WB.size() == times.size(), mesh.name, mesh.X_WB.size(), times.size());
  const auto count = static_cast<unsigned>(times.size());
  auto* channel = new aiNodeAnim;
  channel->mNodeName = aiString(mesh.name);
  channel->mNumPositionKeys = channel->mNumRotationKeys = count;
  channel->mPositionKeys = new aiVectorKey[count];
  channel->mRotationKeys = new aiQuatKey[count];
  Quaternion before = Quaternion::Identity();
  for (unsigned i = 0; i < count; ++i) {
    Quaternion q(mesh.X_WB[i].linear());
    if (q.dot(before) < 0.0) q.coeffs() = -q.coeffs();  // the short way round
    before = q;
    channel->mPositionKeys[i] = {times[i], ToAssimp(Vector3(mesh.X_WB[i].translation()))};
    channel->mRotationKeys[i] = {times[i], ToAssimp(q)};
  }
  return channel;
}

// The scene owns all that it points to.
void Fill(aiScene& scene, const std::vector<AnimatedMesh>& meshes,
          const std::vector<double>& times) {
  const auto count = static_cast<unsigned>(meshes.size());
  scene.mNumMeshes = scene.mNumMaterials = count;
  scene.mMeshes = new aiMesh*[count];
  scene.mMaterials = new aiMaterial*[count];
  aiNode* root = scene.mRootNode = new aiNode("z up");  // a name that no body has
  root->mTransformation =
      ToAssimp(MakeTransform(RotationFromRpy({-0.5 * kPi, 0.0, 0.0}), Vector3::Zero()));
  root->mNumChildren = count;
  root->mChildren = new aiNode*[count];
  std::vector<aiNodeAnim*> channels;
  for (unsigned i = 0; i < count; ++i) {
    const AnimatedMesh& mesh = meshes[i];
    scene.mMeshes[i] = MakeMesh(mesh, i);
    scene.mMeshes[i]->mName = aiString(mesh.name);
    scene.mMaterials[i] = MakeMaterial(mesh);
    auto* node = root->mChildren[i] = new aiNode(mesh.name);
    node->mParent = root;
    if (mesh.X_WB.size() > 1) node->mTransformation = ToAssimp(mesh.X_WB.front());
    node->mNumMeshes = 1;
    node->mMeshes = new unsigned[1]{i};
    if (mesh.X_WB.size() > 1) channels.push_back(MakeChannel(mesh, times));
  }
  if (channels.empty()) return;
  scene.mNumAnimations = 1;
  scene.mAnimations = new aiAnimation*[1];
  scene.mAnimations[0] = new aiAnimation;
  aiAnimation& animation = *scene.mAnimations[0];
  animation.mName = aiString("motion");
  animation.mTicksPerSecond = 1.0;
  animation.mDuration = times.back();
  animation.mNumChannels = static_cast<unsigned>(channels.size());
  animation.mChannels = new aiNodeAnim*[channels.size()];
  std::copy(channels.begin(), channels.end(), animation.mChannels);
}

}  // namespace

void WriteGltf(const std::filesystem::path& file, const std::vector<AnimatedMesh>& meshes,
               const std::vector<double>& times) {
  aiScene scene;
  Fill(scene, meshes, times);
  Assimp::Exporter exporter;
  if (exporter.Export(&scene, "glb2", file.string()) != aiReturn_SUCCESS) {
    throw InputError(file.string(), "", "a file that can be written", exporter.GetErrorString());
  }
}

}  // namespace pregrasp
