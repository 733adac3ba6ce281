#include "app/session/motion_film.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/geometry/tessellate.h"
#include "app/geometry/write_gltf.h"
#include "app/hand/hand_shapes.h"
#include "app/recording/motion_table.h"
#include "app/recording/rollout_table.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

std::array<float, 4> ToArray(const Rgba& color) { return {color.r, color.g, color.b, color.a}; }

// Where the movable bodies are at each frame.
std::vector<std::vector<RigidTransform>> FindBodies(const LoadedRun& run,
                                                    const std::vector<MotionRecord>& frames) {
  std::vector<BodyRow> rows = ReadBodyRows(run.directory / "rollout.csv", run.scene);
  for (BodyRow& row : ReadBodyRows(run.directory / "lift.csv", run.scene)) {
    rows.push_back(std::move(row));
  }
  std::vector<std::vector<RigidTransform>> X_WB;
  for (const MotionRecord& frame : frames) {
    const auto row =
        std::lower_bound(rows.begin(), rows.end(), frame.simulated_t - 1e-9,
                         [](const BodyRow& at, double simulated_t) { return at.t < simulated_t; });
    X_WB.push_back(row == rows.end() ? rows.back().X_WB : row->X_WB);
  }
  return X_WB;
}

}  // namespace

void WriteMotionFilm(const LoadedRun& run, const std::filesystem::path& file) {
  const std::filesystem::path table = run.directory / "motion.csv";
  const std::vector<MotionRecord> frames =
      std::filesystem::exists(table) ? ReadMotionTable(table) : std::vector<MotionRecord>{};
  if (frames.empty()) {
    throw InputError(run.directory.string(), "", "a run that ends in a hand motion",
                     run.summary.status.value_or("one without"));
  }
  std::vector<double> times;
  times.reserve(frames.size());
  for (const MotionRecord& frame : frames) times.push_back(frame.t);
  const auto X_WB = FindBodies(run, frames);
  std::vector<AnimatedMesh> meshes;
  std::size_t movable = 0;
  for (const Body& body : run.scene.bodies) {
    AnimatedMesh mesh;
    mesh.name = body.name;
    mesh.mesh = std::make_shared<const TriangleMesh>(Tessellate(body.shape));
    mesh.rgba = ToArray(meshes.empty()   ? ObjectColor()
                        : body.movable() ? NeighbourColor()
                                         : TableColor());
    if (!body.movable()) {
      mesh.X_WB = {body.X_WB};
    } else {
      for (const auto& poses : X_WB) mesh.X_WB.push_back(poses.at(movable));
      ++movable;
    }
    meshes.push_back(std::move(mesh));
  }
  const std::vector<HandShape>& shapes = ShadowHandShapes();
  const std::size_t first = meshes.size();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    meshes.push_back({fmt::format("hand.{}", i + 1), shapes[i].mesh, shapes[i].rgba, {}});
  }
  for (const MotionRecord& frame : frames) {
    const auto X_WL = CalcLinkPoses(ShadowHand(), frame.hand);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      meshes[first + i].X_WB.push_back(X_WL[shapes[i].link]);
    }
  }
  WriteGltf(file, meshes, times);
}

}  // namespace pregrasp
