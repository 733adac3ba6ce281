// replay_runs DIR..: run directories in MuJoCo: how far from its end here the push ends there
// (scene.json, rollout.csv), and this project's verdict on the lift and MuJoCo's (lift.csv); then
// how many pushes end within 2 cm and 10 degrees, and how many verdicts agree, those within 20 % of
// a limit counted apart. A run that came to neither is said to have none.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "app/recording/scene_file.h"
#include "tests/replay/mujoco_replay.h"

namespace pregrasp {
namespace {

constexpr double kTimeStep = 2.5e-4;  // [s]
constexpr double kNear = 0.02;        // [m]
constexpr double kNearTurn = 10.0;    // [degrees]

struct Tally {
  int near = 0, far = 0;
  int agree = 0, differ = 0, close = 0;

  void Add(const std::filesystem::path& directory) {
    const Scene scene = LoadScene(directory / "scene.json");
    fmt::print("{}: ", directory.string());
    if (std::filesystem::exists(directory / "rollout.csv")) {
      AddPush(scene, ReadReplayTable(directory / "rollout.csv", scene));
    } else {
      fmt::print("no push; ");
    }
    if (std::filesystem::exists(directory / "lift.csv")) {
      AddLift(scene, ReadReplayTable(directory / "lift.csv", scene));
    } else {
      fmt::print("no lift\n");
    }
  }

 private:
  void AddPush(const Scene& scene, const std::vector<ReplayRow>& rows) {
    const RigidTransform here = rows.back().X_WB.front();
    const RigidTransform there = ReplayInMujoco(scene, rows, kTimeStep).X_WO.back();
    const double shift = (there.translation() - here.translation()).norm();
    const double turn_deg = RadToDeg(RotationAngle(here.linear(), there.linear()));
    ++(shift <= kNear && turn_deg <= kNearTurn ? near : far);
    fmt::print("push {:.1f} mm, {:.1f} degrees apart; ", 1e3 * shift, turn_deg);
  }

  void AddLift(const Scene& scene, const std::vector<ReplayRow>& rows) {
    const ReplayResult result = ReplayInMujoco(scene, rows, kTimeStep);
    const ReplayVerdict here = JudgeReplay(rows, ObjectPoses(rows), -1);
    const ReplayVerdict there = JudgeReplay(rows, result.X_WO, result.touching_body);
    fmt::print("lift here {} ({:.1f} mm, {:.1f} degrees), MuJoCo {} ({:.1f} mm, {:.1f} degrees)\n",
               here.held ? "held" : "lost", 1e3 * here.shift, here.turn_deg,
               there.held ? "held" : "lost", 1e3 * there.shift, there.turn_deg);
    if (here.is_close || there.is_close) {
      ++close;
    } else {
      ++(here.held == there.held ? agree : differ);
    }
  }
};

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  pregrasp::Tally tally;
  try {
    for (int i = 1; i < argc; ++i) tally.Add(argv[i]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  fmt::print(
      "pushes: {} end within {:.0f} cm and {:.0f} degrees, {} do not; lifts: {} agree, {} differ, "
      "{} "
      "are close to a limit\n",
      tally.near, 1e2 * pregrasp::kNear, pregrasp::kNearTurn, tally.far, tally.agree, tally.differ,
      tally.close);
  return tally.differ == 0 ? 0 : 1;
}
