#include "app/hand/hand_shapes.h"

#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <tuple>

#include "app/core/error.h"
#include "app/geometry/obj_text.h"
#include "app/geometry/read_mesh.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

constexpr int kSegments = 40;  // of a primitive's circles

// Plain OBJ files by our own reader, all others by those of bodies.
TriangleMesh ReadFile(const std::filesystem::path& file) {
  try {
    if (file.extension() == ".obj") {
      std::ifstream in(file);
      std::stringstream text;
      text << in.rdbuf();
      return ParseObj(text.str(), file.string());
    }
  } catch (const InputError& /*of another form*/) {
  }
  try {
    return ReadTriangles(file);
  } catch (const UnreadableFile& error) {
    throw InputError(file.string(), "", error.expected, error.got);
  }
}

TriangleMesh ReadVisual(const HandVisual& visual) {
  const auto* file = std::get_if<Mesh>(&visual.shape);
  TriangleMesh mesh = file != nullptr ? ReadFile(file->file) : Tessellate(visual.shape, kSegments);
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    const Vector3 scaled = mesh.V.row(i).transpose().cwiseProduct(visual.scale);
    mesh.V.row(i) = visual.X_LV * scaled;
  }
  if (visual.scale.prod() < 0.0) mesh.F.col(1).swap(mesh.F.col(2));  // still outward
  return mesh;
}

}  // namespace

std::vector<HandShape> LoadHandShapes(const HandModel& hand) {
  // Of visuals that are alike but for the link, which share a mesh.
  using Key = std::tuple<std::string, std::vector<double>>;
  std::map<Key, std::shared_ptr<const TriangleMesh>> meshes;
  std::vector<HandShape> shapes;
  for (const HandVisual& visual : hand.visuals) {
    const auto* file = std::get_if<Mesh>(&visual.shape);
    const auto* numbers = visual.X_LV.matrix().data();
    std::vector<double> place(numbers, numbers + 16);
    place.insert(place.end(), visual.scale.data(), visual.scale.data() + 3);
    std::shared_ptr<const TriangleMesh> own;
    std::shared_ptr<const TriangleMesh>& mesh =
        file != nullptr ? meshes[{file->file, std::move(place)}] : own;
    if (!mesh) mesh = std::make_shared<const TriangleMesh>(ReadVisual(visual));
    shapes.push_back({visual.link, mesh, visual.rgba});
  }
  return shapes;
}

const std::vector<HandShape>& ShapesOf(const HandModel& hand) {
  static std::mutex mutex;
  static std::map<const HandModel*, std::vector<HandShape>> known;
  const std::lock_guard lock(mutex);
  const auto found = known.find(&hand);
  if (found != known.end()) return found->second;
  return known.emplace(&hand, LoadHandShapes(hand)).first->second;
}

std::vector<RigidTransform> CalcLinkPoses(const HandModel& hand,
                                          const HandConfiguration& configuration) {
  HandPose pose;
  CalcHandPose(hand, configuration.X_WH, configuration.q, &pose);
  std::vector<RigidTransform> X_WL;
  X_WL.reserve(hand.num_links());
  for (int link = 0; link < hand.num_links(); ++link) X_WL.push_back(pose.X_WL(link));
  return X_WL;
}

}  // namespace pregrasp
