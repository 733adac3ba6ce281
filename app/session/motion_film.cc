#include "app/session/motion_film.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/core/error.h"
#include "app/geometry/tessellate.h"
#include "app/geometry/write_gltf.h"
#include "app/hand/hand_shapes.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

std::array<float, 4> ToArray(const Rgba& color) { return {color.r, color.g, color.b, color.a}; }

}  // namespace

std::vector<FilmFrame> ReadFilm(const LoadedRun& run) {
  const std::filesystem::path table = run.directory / "motion.csv";
  if (!std::filesystem::exists(table)) return {};
  std::vector<BodyRow> rows = ReadBodyRows(run.directory / "rollout.csv", run.scene);
  const std::filesystem::path lift = run.directory / "lift.csv";
  if (std::filesystem::exists(lift)) {
    for (BodyRow& row : ReadBodyRows(lift, run.scene)) rows.push_back(std::move(row));
  }
  std::vector<FilmFrame> frames;
  for (const MotionRecord& motion : ReadMotionTable(table, HandOf(run.scene))) {
    const auto row =
        std::lower_bound(rows.begin(), rows.end(), motion.simulated_t - 1e-9,
                         [](const BodyRow& at, double simulated_t) { return at.t < simulated_t; });
    const BodyRow& shown = row == rows.end() ? rows.back() : *row;
    frames.push_back({motion, shown.X_WB, {}});
    for (const BodyRow::Contact& contact : shown.contacts) {
      if (motion.on[static_cast<int>(contact.finger)]) frames.back().contacts.push_back(contact);
    }
  }
  return frames;
}

std::vector<FilmFrame> RequireFilm(const LoadedRun& run) {
  std::vector<FilmFrame> frames = ReadFilm(run);
  if (frames.empty()) {
    throw InputError(run.directory.string(), "", "a run that ends in a hand motion",
                     run.summary.status.value_or("one without"));
  }
  return frames;
}

StepFacts FrameStep(const LoadedRun& run, const std::vector<FilmFrame>& film, int index) {
  const FilmFrame& frame = film.at(static_cast<std::size_t>(index));
  const MotionRecord& motion = frame.motion;
  StepFacts step = run.Get(run.manifest.value("step", ""));
  step.id = fmt::format("motion.frame.{}", index + 1);
  step.command = {Verb::kFrame, run.manifest.value("step", ""), {{"frame", index + 1}}};
  step.t = motion.t;
  for (std::size_t i = 0; i < step.bodies.size(); ++i) {
    step.bodies[i].p_WB = frame.X_WB.at(i).translation();
    step.bodies[i].q_WB = Quaternion(frame.X_WB.at(i).linear());
  }
  for (FingerFacts& finger : step.fingers) finger.on = false;
  step.contacts.clear();
  FrameFacts facts;
  facts.frame = index + 1;
  facts.phase = MotionPhaseName(motion.phase);
  facts.loosened = LooseningRungName(motion.rung);
  facts.failed = motion.rung == LooseningRung::kFailed;
  facts.tip_error_mm = motion.tip_error_mm;
  facts.clearance_mm = motion.clearance_mm;
  facts.simulated_t = motion.simulated_t;
  facts.hand = MakeHandFacts(HandOf(run.scene), motion.hand);
  for (int f = 0; f < kNumFingers; ++f) {
    if (motion.on[f]) facts.touching.emplace_back().finger = static_cast<Finger>(f);
  }
  step.details = std::move(facts);
  return step;
}

void WriteMotionFilm(const LoadedRun& run, const std::filesystem::path& file) {
  const std::vector<FilmFrame> frames = RequireFilm(run);
  std::vector<double> times;
  times.reserve(frames.size());
  for (const FilmFrame& frame : frames) times.push_back(frame.motion.t);
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
      for (const FilmFrame& frame : frames) mesh.X_WB.push_back(frame.X_WB.at(movable));
      ++movable;
    }
    meshes.push_back(std::move(mesh));
  }
  const std::vector<HandShape>& shapes = ShapesOf(HandOf(run.scene));
  const std::size_t first = meshes.size();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    meshes.push_back({fmt::format("hand.{}", i + 1), shapes[i].mesh, shapes[i].rgba, {}});
  }
  for (const FilmFrame& frame : frames) {
    const auto X_WL = CalcLinkPoses(HandOf(run.scene), frame.motion.hand);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      meshes[first + i].X_WB.push_back(X_WL[shapes[i].link]);
    }
  }
  WriteGltf(file, meshes, times);
}

}  // namespace pregrasp
