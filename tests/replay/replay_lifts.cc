// replay_lifts SEEDS PATHS SCENE.lua..: lifts that hold and lifts that fail, in MuJoCo. Plans for
// each scene with seeds 1 to SEEDS, PATHS paths each, lifts every feasible grasp of every certified
// plan, also one that gives way and is not simulated in a run, writes scene.json and lift.csv, and
// replays these. A line each with this project's verdict and MuJoCo's, then how many agree: of
// those that hold here, of those that fail; those within 20 % of a limit counted apart, as are
// those whose only fault is a fingertip in the surroundings, which MuJoCo is not asked about.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

#include "app/core/data_folder.h"
#include "app/job/run_policy.h"
#include "app/recording/rollout_table.h"
#include "app/recording/scene_file.h"
#include "bindings/scene_file.h"
#include "tests/replay/mujoco_replay.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

constexpr double kStep = 2.5e-4;  // of MuJoCo [s]

struct Tally {
  int agree = 0, differ = 0, close = 0;
};

// The lift that a grasp would be simulated with, whether it is stiff enough or not; nothing where
// no forces hold it.
std::optional<LiftOutcome> SimulateAnyLift(const Planner& planner, const WorldState& end,
                                           const GraspResult& grasp, const LiftWay& way) {
  const LiftConfig& config = planner.config().lift;
  const std::vector<GraspContact> contacts = MoveToPressing(end, grasp.contacts);
  const GraspWorld& world = planner.grasp_world();
  const double k = planner.scene().fingertips.grasp_stiffness;
  const auto forces = ChooseGraspForces(
      world.ToWrenchContacts(contacts),
      world.MakeWrenchConfig(0.5, end.bodies.front().X_WB().linear()), k, config.forces);
  if (!forces) return std::nullopt;
  return SimulateLift(planner.world(), planner.environment(), end, {contacts, forces->forces, k},
                      way, config, Stepper::kSimbody, true);
}

// Through files and back.
ReplayResult ReplayFiles(const World& world, const std::vector<TraceRow>& trace,
                         std::vector<ReplayRow>& rows) {
  const TestFolder folder;
  std::string table = LiftHeader(world.scene());
  for (const TraceRow& row : trace) table += LiftRow(world.scene(), row.state);
  std::ofstream(folder.path() / "lift.csv") << table;
  WriteScene(folder.path(), world.scene(), world.config().dt);
  const Scene scene = LoadScene(folder.path() / "scene.json");
  rows = ReadReplayTable(folder.path() / "lift.csv", scene);
  return ReplayInMujoco(scene, rows, kStep);
}

class Study {
 public:
  void Add(const std::filesystem::path& file, std::uint64_t seed, int paths) {
    JobSetup setup;
    std::vector<Setting> none;
    setup.scene = LoadSceneFile(file, none);
    setup.seed = seed;
    setup.weights = DataFolder() / "assets" / "weights";
    Job job(std::move(setup), 0);
    Timeline timeline(job);
    RunConfig run;
    run.paths = paths;
    run.all = true;
    run.motions = 1;
    RunPlanner(timeline, run, {});
    for (const auto& node : timeline.nodes()) {
      if (!std::holds_alternative<GraspFacts>(node->facts.details)) continue;
      const auto state = timeline.GetState(*node);
      if (state->num_grasps != std::ssize(state->grasps->grasps)) continue;
      AddGrasps(fmt::format("{} seed {} {}", file.stem().string(), seed, node->parent->id()),
                *state);
    }
  }

  int Report() const {
    const auto print = [](const char* name, const Tally& tally) {
      fmt::print("{}: {} agree, {} differ, {} are close to a limit\n", name, tally.agree,
                 tally.differ, tally.close);
    };
    print("held here", held_);
    print("failed here", failed_);
    fmt::print("only a fingertip in the surroundings: {}; no forces: {}\n", tips_, no_forces_);
    return held_.differ + failed_.differ == 0 ? 0 : 1;
  }

 private:
  void AddGrasps(const std::string& name, const JobState& state) {
    const Planner planner = state.planner->WithConfig(state.config);
    const WorldState& end = state.certificate->full.end;
    const LiftWay way =
        FindLiftWay(planner.world().GetPoses(end), planner.scorer().cloud(), planner.environment(),
                    -planner.scene().gravity.normalized(), state.config.lift.way);
    if (!way.is_free()) return;
    for (const int i : state.grasps->feasible) {
      AddLift(fmt::format("{} grasp {}", name, i + 1), planner,
              SimulateAnyLift(planner, end, state.grasps->grasps[i].result, way));
    }
  }

  void AddLift(const std::string& name, const Planner& planner,
               const std::optional<LiftOutcome>& lift) {
    if (!lift) {
      ++no_forces_;
      return;
    }
    const std::vector<LiftReason> reasons = JudgeLift(*lift);
    if (reasons == std::vector<LiftReason>{LiftReason::kTipOverlap}) {
      ++tips_;
      return;
    }
    std::vector<ReplayRow> rows;
    const ReplayResult result = ReplayFiles(planner.world(), lift->trace, rows);
    const ReplayVerdict here =
        JudgeReplay(rows, ObjectPoses(rows), lift->touching_body ? lift->touching_body->value : -1);
    const ReplayVerdict there = JudgeReplay(rows, result.X_WO, result.touching_body);
    const bool held = reasons.empty();
    const bool is_close = here.is_close || there.is_close;
    fmt::print("{}: here {} ({:.1f} mm, {:.1f} degrees), MuJoCo {} ({:.1f} mm, {:.1f} degrees){}\n",
               name, held ? "held" : LiftReasonName(reasons.front()), 1e3 * here.shift,
               here.turn_deg, there.held ? "held" : "lost", 1e3 * there.shift, there.turn_deg,
               is_close             ? ", close to a limit"
               : held == there.held ? ""
                                    : ", DIFFERS");
    std::fflush(stdout);
    Tally& tally = held ? held_ : failed_;
    ++(is_close ? tally.close : held == there.held ? tally.agree : tally.differ);
  }

  Tally held_, failed_;
  int tips_ = 0, no_forces_ = 0;
};

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  if (argc < 4) {
    fmt::print(stderr, "replay_lifts SEEDS PATHS SCENE.lua..\n");
    return 2;
  }
  pregrasp::Study study;
  try {
    for (int i = 3; i < argc; ++i) {
      for (int seed = 1; seed <= std::atoi(argv[1]); ++seed) {
        study.Add(argv[i], static_cast<std::uint64_t>(seed), std::atoi(argv[2]));
      }
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return study.Report();
}
