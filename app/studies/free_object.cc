#include "app/studies/free_object.h"

namespace pregrasp {

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
