// replay_runs DIR..: the lifts of run directories (scene.json, lift.csv) in MuJoCo: a line each
// with this project's verdict and MuJoCo's, and how many of them agree, those within 20 % of a
// limit counted apart.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>

#include "app/recording/scene_file.h"
#include "tests/replay/mujoco_replay.h"

namespace pregrasp {
namespace {

struct Tally {
  int agree = 0, differ = 0, close = 0;

  void Add(const std::filesystem::path& directory) {
    const Scene scene = LoadScene(directory / "scene.json");
    const std::vector<ReplayRow> rows = ReadReplayTable(directory / "lift.csv", scene);
    const ReplayResult result = ReplayInMujoco(scene, rows, 2.5e-4);
    const ReplayVerdict here = JudgeReplay(rows, ObjectPoses(rows), -1);
    const ReplayVerdict there = JudgeReplay(rows, result.X_WO, result.touching_body);
    fmt::print("{}: here {} ({:.1f} mm, {:.1f} degrees), MuJoCo {} ({:.1f} mm, {:.1f} degrees)\n",
               directory.string(), here.held ? "held" : "lost", 1e3 * here.shift, here.turn_deg,
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
  fmt::print("{} agree, {} differ, {} are close to a limit\n", tally.agree, tally.differ,
             tally.close);
  return tally.differ == 0 ? 0 : 1;
}
