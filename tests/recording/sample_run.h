#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "app/core/math.h"
#include "app/core/rng.h"
#include "app/recording/checked_file.h"
#include "app/recording/run_directory.h"
#include "tests/test_folder.h"

namespace pregrasp {

/// Where temporary folders are made: in memory if the system allows it, for a run waits for the
/// disk.
inline std::filesystem::path FastTemporaryPlace() {
  return access("/dev/shm", W_OK) == 0 ? "/dev/shm" : std::filesystem::temp_directory_path();
}

/// A folder for one test's files, removed with it.
class TemporaryFolder : public TestFolder {
 public:
  explicit TemporaryFolder(const std::filesystem::path& place = FastTemporaryPlace())
      : TestFolder(place) {}
};

inline Vector3 RandomVector(Rng& rng) { return {rng.Normal(), rng.Normal(), rng.Normal()}; }

inline RigidTransform RandomPose(Rng& rng) {
  const Quaternion q(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal());
  return MakeTransform(q.normalized(), RandomVector(rng));
}

/// A tetrahedron with vertices that no short decimal holds.
inline TriangleMesh RandomTetrahedron(Rng& rng) {
  TriangleMesh mesh;
  mesh.V.resize(4, 3);
  for (int i = 0; i < 4; ++i) mesh.V.row(i) = RandomVector(rng);
  mesh.F.resize(4, 3);
  mesh.F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  return mesh;
}

inline MassProperties RandomMass(Rng& rng) {
  return {
      rng.Uniform(0.01, 1.0), 0.01 * RandomVector(rng),
      Vector3(rng.Uniform(2.0, 3.0), rng.Uniform(2.0, 3.0), rng.Uniform(2.0, 3.0)).asDiagonal()};
}

/// A valid scene with every kind of shape, the object's included in `seed`, in random places.
inline Scene SampleScene(std::uint64_t seed = 1) {
  Rng rng(seed);
  Scene scene;
  scene.name = "sample";
  scene.gravity = {0.1, -0.0, -9.81};
  scene.fingertips = {0.7, 11.5, 52.5, 1.0 / 3.0, 310.5};
  scene.camera = CameraConfig{RandomVector(rng), RandomVector(rng), 31.7};
  const auto add = [&](const std::string& name, Shape shape, bool movable) {
    Body body;
    body.name = name;
    body.shape = std::move(shape);
    body.X_WB = RandomPose(rng);
    body.friction = rng.Uniform(0.2, 0.6);
    if (movable) body.mass_properties = RandomMass(rng);
    scene.bodies.push_back(std::move(body));
  };
  const Mesh mesh{"a file.obj", 0.001, RandomTetrahedron(rng), true, "1 face given twice left out"};
  add("object", mesh, true);
  add("table", Box{{0.8, 0.6, 1.0 / 7.0}}, false);
  Union inner{{{Sphere{0.013}, RandomPose(rng)}, {mesh, RandomPose(rng)}}};
  add("tool", Union{{{Cylinder{0.02, 0.1}, RandomPose(rng)}, {inner, RandomPose(rng)}}}, true);
  add("tool_2", Capsule{0.011, 0.23}, true);
  add("scan", Cloud{"scan.ply", 2.0, RandomTetrahedron(rng).V, RandomTetrahedron(rng)}, false);
  return scene;
}

/// Step `i` of a run of SampleScene.
inline StepFacts SampleStep(int i, std::uint64_t seed = 1) {
  Rng rng(seed, RngStream::kTest, static_cast<std::uint32_t>(i));
  StepFacts step;
  step.id = "sim." + std::to_string(i);
  step.command = {
      Verb::kWait, "scene.start", {{"steps", i}, {"note", "\"quoted\", line\nbreak, \xc3\xa9"}}};
  step.t = i / 240.0;
  for (const char* name : {"object", "tool", "tool_2"}) {
    const RigidTransform X_WB = RandomPose(rng);
    step.bodies.push_back({name, X_WB.translation(), Quaternion(X_WB.linear()), RandomVector(rng),
                           RandomVector(rng)});
  }
  for (const Finger finger : {Finger::kThumb, Finger::kIndex}) {
    FingerFacts facts;
    facts.finger = finger;
    facts.on = i % 2 == 0;
    facts.p_OC = RandomVector(rng);
    facts.p_WTarget = RandomVector(rng);
    facts.f_W = RandomVector(rng);
    step.fingers.push_back(facts);
  }
  SimulationFacts details;
  details.physics_steps = i;
  details.moved_mm = rng.Normal();
  step.details = details;
  return step;
}

/// A state of the world of SampleScene.
inline WorldState SampleState(int i, std::uint64_t seed = 1) {
  Rng rng(seed, RngStream::kTest, static_cast<std::uint32_t>(i), 1);
  WorldState state;
  state.t = i / 240.0;
  state.bodies.resize(3);
  for (BodyState& body : state.bodies) {
    const RigidTransform X_WB = RandomPose(rng);
    body = {Quaternion(X_WB.linear()), X_WB.translation(), RandomVector(rng), RandomVector(rng)};
  }
  for (FingertipState& finger : state.fingers) {
    finger.on = i % 2 == 1;
    finger.p_OC = RandomVector(rng);
    finger.nhat_O = RandomVector(rng).normalized();
    finger.p_WTarget = RandomVector(rng);
    finger.stiffness = 50.0 + i;
    finger.damping = 1.0 / (3.0 + i);
    finger.f_W = RandomVector(rng);
  }
  return state;
}

/// The smallest PNG: one white pixel.
inline const std::string kOnePixelPng(
    "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\0\0\0\0:~\x9bU"
    "\0\0\0\nIDATx\x9c\x63\xf8\x0f\0\1\1\1\0\xb1\x38\xf6\x14\0\0\0\0IEND\xae\x42\x60\x82",
    67);

/// Writes a whole run of SampleScene with `steps` steps and the pictures of the first `pictures`.
inline void WriteSampleRun(const std::filesystem::path& directory, int steps = 5, int pictures = 0,
                           std::uint64_t seed = 1) {
  RunInfo info;
  info.seed = seed;
  info.libraries = {{"simbody", "3.7"}};
  info.inputs = {{"score.safetensors", std::string(64, 'a')}};
  RunDirectory run(directory, SampleScene(seed), info);
  for (int i = 0; i < steps; ++i) {
    const StepFacts step = SampleStep(i, seed);
    const int number = run.AddStep(step);
    if (i < pictures) {
      WriteFile(run.PictureFile(number, step.id), kOnePixelPng);
      run.AddPicture(step, number, {{"title", ""}});
    }
    run.AddRolloutRow(SampleState(i, seed));
  }
  RunSummary summary;
  summary.scene = "sample";
  summary.seed = seed;
  summary.status = "interrupted";
  run.Finish(summary, "sim.0", {{"mppi", {{"samples", 128}}}});
}

}  // namespace pregrasp
