#include "app/studies/free_object.h"

namespace pregrasp {
namespace {

constexpr std::uint64_t kUnseenSeed = 0x6c6561726e;

}  // namespace

ItemConfig MakeUnseenItems(const LearningObjects& objects, std::uint64_t seed) {
  ItemConfig config;
  config.seed = kUnseenSeed + seed;
  config.objects = objects;
  return config;
}

FreeObject::FreeObject(const ItemConfig& config, std::int64_t index) {
  const SceneObject object = MakeItemObject(config, index);
  name = object.object.name;
  family = object.object.family;
  cloud = MakeItemCloud(config, object, index);
  box = {Vector3(cloud.P.colwise().minCoeff()), Vector3(cloud.P.colwise().maxCoeff())};
  int tries = 0;
  do {
    scene = MakeItemScene(config, object, index, tries++).scene;
  } while (scene.bodies.size() > 1);
}

}  // namespace pregrasp
