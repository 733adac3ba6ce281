#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/core/rng.h"
#include "app/hand/hand_file.h"
#include "app/hand/hand_measures.h"
#include "app/hand/hand_shapes.h"
#include "app/hand/ik.h"
#include "app/recording/partial_directory.h"
#include "render/hand_bodies.h"
#include "render/renderer.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kPoses = 10;

struct HandOptions {
  std::string hand;
  fs::path out;
};

struct HandPicture {
  std::string name;
  HandJoints q;
  Vector3 view_H;  // towards the camera
};

// The nearest posture in which the hand is free of itself.
HandJoints FreePosture(const HandModel& hand, const HandJoints& wanted) {
  HandConfiguration near;
  near.q = wanted;
  IkProblem problem;
  problem.reference = problem.warm_start = near;
  const Rng rng(0, RngStream::kHandPoseIk);
  return IkSolver(hand).Solve({}, problem, rng).q;
}

// At ease from both sides, stretched, closed, the thumb with each finger, then at random.
std::vector<HandPicture> ChoosePoses(const HandModel& hand, const HandMeasures& measures) {
  const Vector3 palmar(0.35, -1.0, 0.15), dorsal(0.5, 1.0, 0.25), side(1.0, -0.45, 0.1);
  HandJoints stretched = HandJoints::Zero(), closed = hand.posture;
  for (int j = 0; j < hand.num_joints; ++j) {
    stretched[j] = std::clamp(0.0, hand.q_lower[j], hand.q_upper[j]);
    const bool sideways = hand.q_lower[j] < -0.3 && hand.q_upper[j] < 0.6;
    if (!sideways) closed[j] += 0.7 * (hand.q_upper[j] - closed[j]);
  }
  std::vector<HandPicture> poses = {{"ease", hand.posture, palmar},
                                    {"back", hand.posture, dorsal},
                                    {"stretched", FreePosture(hand, stretched), palmar},
                                    {"closed", FreePosture(hand, closed), side}};
  for (int f = 1; f < hand.num_fingers; ++f) {
    poses.push_back({fmt::format("thumb_{}", kFingerNames[f]), measures.meeting[f], side});
  }
  Rng rng(0, RngStream::kHandPoses);
  for (int number = 1; std::ssize(poses) < kPoses; ++number) {
    HandJoints q = HandJoints::Zero();
    for (int j = 0; j < hand.num_joints; ++j) {
      q[j] = rng.Uniform(hand.q_lower[j], hand.q_upper[j]);
    }
    poses.push_back({fmt::format("random_{}", number), FreePosture(hand, q), palmar});
  }
  return poses;
}

RenderScene ComposePose(const HandModel& hand, const HandPicture& pose) {
  RenderScene scene;
  const RigidTransform X_WH = MakeTransform(Matrix3::Identity(), Vector3(0.0, 0.0, 0.08));
  std::array<bool, kNumFingers> colored{};
  for (int f = 0; f < hand.num_fingers; ++f) colored[f] = true;
  AddHand(scene, hand, {X_WH, pose.q}, colored);
  MatrixX3 corners(0, 3);
  for (const RenderBody& body : scene.bodies) {
    const Eigen::Index at = corners.rows();
    corners.conservativeResize(at + body.mesh->V.rows(), 3);
    for (Eigen::Index i = 0; i < body.mesh->V.rows(); ++i) {
      corners.row(at + i) = body.X_WB * Vector3(body.mesh->V.row(i).transpose());
    }
  }
  if (corners.rows() == 0) return scene;
  scene.camera = FrameCamera(corners, pose.view_H.normalized(), 4.0 / 3.0);
  scene.axes = false;
  return scene;
}

void DrawPoses(const HandModel& hand, const HandMeasures& measures, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "", "a folder that can be written", error.message());
  Renderer renderer;
  RenderConfig config;
  config.width = 800;
  config.height = 600;
  config.quality = RenderQuality::kStill;
  int number = 0;
  for (const HandPicture& pose : ChoosePoses(hand, measures)) {
    const std::string name = fmt::format("{:02}_{}.png", ++number, pose.name);
    WritePng(renderer.Render(ComposePose(hand, pose), config), folder / name);
  }
  fmt::print("{} poses: {}\n", number, folder.string());
}

void PrintFinger(const HandModel& hand, const HandMeasures& measures, int f) {
  std::string joints;
  const auto [first, count] = hand.fingers[f];
  for (int j = first; j < first + count; ++j) {
    joints += (joints.empty() ? "" : " ") + hand.joints[j].name;
  }
  std::string to_thumb;
  if (f > 0) {
    to_thumb = fmt::format(", to the thumb {:.0f} to {:.0f} mm",
                           1e3 * std::max(0.0, measures.nearest[f]), 1e3 * measures.farthest[f]);
  }
  fmt::print("  {}: {}; tip of {:.1f} mm, reach {:.0f} mm{}\n", kFingerNames[f], joints,
             1e3 * hand.tips[f].radius, 1e3 * measures.reach[f], to_thumb);
}

int CheckHand(const HandOptions& options) {
  const fs::path file = FileOfHand(options.hand);
  HandReading reading = ReadHand(file);
  if (reading.faults.empty()) {
    try {
      LoadHandShapes(reading.hand);
    } catch (const InputError& error) {
      reading.faults.push_back(error);
    }
  }
  const HandModel& hand = reading.hand;
  HandMeasures measures;
  if (reading.faults.empty()) {
    measures = MeasureHand(hand);
    for (int f = 1; f < hand.num_fingers; ++f) {
      if (measures.nearest[f] <= kMeeting) continue;
      reading.faults.emplace_back(
          file.string(), fmt::format("fingers[{}]", f + 1), "a finger that the thumb can meet",
          fmt::format("tips that stay {:.0f} mm apart", 1e3 * measures.nearest[f]));
    }
  }
  const fs::path out = options.out.empty() ? fs::path("out") / ("hand_" + hand.name) : options.out;
  if (reading.faults.empty()) RequireOutsideRuns(out / "pictures");
  for (const InputError& fault : reading.faults) fmt::print(stderr, "{}\n", fault.what());
  if (!reading.faults.empty()) return 2;
  fmt::print("{}: {} fingers, {} joints, {:.2f} kg\n", hand.name, hand.num_fingers, hand.num_joints,
             measures.mass);
  for (int f = 0; f < hand.num_fingers; ++f) PrintFinger(hand, measures, f);
  fmt::print("  free of itself in {:.0f} % of random postures\n", 100.0 * measures.free_share);
  for (const std::string& note : reading.notes) fmt::print("  note: {}\n", note);
  DrawPoses(hand, measures, out);
  return 0;
}

}  // namespace

void AddHandCommand(const Subcommand& app, Action& action) {
  const Subcommand hand = app.AddCommand("hand", "Hands other than the Shadow Hand");
  hand.RequireCommand();
  auto options = std::make_shared<HandOptions>();
  const Subcommand check = hand.AddCommand(
      "check", "Say what a hand's description and URDF lack; measure the hand and draw ten poses");
  check.Add("FILE", options->hand, "A hand.lua, or the name of a shipped hand").Required();
  check.Add("--out", options->out, "The folder of the pictures; out/hand_NAME if not given");
  check.OnChosen([options, &action] { action = [options] { return CheckHand(*options); }; });
}

}  // namespace pregrasp
