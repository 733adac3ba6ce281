#include "app/hand/hand_shapes.h"

#include <fstream>
#include <map>
#include <sstream>

#include "app/core/error.h"
#include "app/geometry/obj_text.h"

namespace pregrasp {

std::vector<HandShape> LoadHandShapes(const HandModel& hand) {
  std::map<std::filesystem::path, std::shared_ptr<const TriangleMesh>> meshes;
  std::vector<HandShape> shapes;
  for (const HandVisual& visual : hand.visuals) {
    std::shared_ptr<const TriangleMesh>& mesh = meshes[visual.file];
    if (!mesh) {
      std::ifstream in(visual.file);
      if (!in) throw InputError(visual.file.string(), "", "a readable OBJ file", "");
      std::stringstream text;
      text << in.rdbuf();
      mesh = std::make_shared<const TriangleMesh>(ParseObj(text.str(), visual.file.string()));
    }
    shapes.push_back({visual.link, mesh, visual.rgba});
  }
  return shapes;
}

const std::vector<HandShape>& ShadowHandShapes() {
  static const std::vector<HandShape> shapes = LoadHandShapes(ShadowHand());
  return shapes;
}

std::array<RigidTransform, kNumHandLinks> CalcLinkPoses(const HandModel& hand,
                                                        const HandConfiguration& configuration) {
  HandPose pose;
  CalcHandPose(hand, configuration.X_WH, configuration.q, &pose);
  std::array<RigidTransform, kNumHandLinks> X_WL;
  for (int link = 0; link < kNumHandLinks; ++link) X_WL[link] = pose.X_WL(link);
  return X_WL;
}

}  // namespace pregrasp
