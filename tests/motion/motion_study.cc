// motion_study audit DIR..    the motions of finished runs, as motion.csv has them
// motion_study remake DIR..   the same trajectories, lifts and grasps, their motions made anew
// motion_study problems N [FIRST]   motions of N generated problems
//
// A line each, and totals: overlaps at the frames and at ten times their rate by an independent
// check, speeds against the limits, how long it took.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "app/core/error.h"
#include "app/motion/hand_motion.h"
#include "app/motion/motion_problem.h"
#include "app/recording/motion_table.h"
#include "app/recording/scene_file.h"
#include "tests/motion/motion_audit.h"

namespace pregrasp {
namespace {

// rollout.csv or lift.csv: the bodies and contacts of every row.
std::vector<TraceRow> ReadTrace(const std::filesystem::path& file, const World& world) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) throw InputError(file.string(), "", "a table", "nothing");
  std::map<std::string, int> column;
  std::istringstream names(line);
  for (std::string name; std::getline(names, name, ',');) {
    column.emplace(name, static_cast<int>(column.size()));
  }
  std::vector<TraceRow> rows;
  while (std::getline(in, line)) {
    std::vector<double> values;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
    const auto get = [&](const std::string& name) { return values.at(column.at(name)); };
    const auto vector = [&](const std::string& name) {
      return Vector3(get(name + "_x"), get(name + "_y"), get(name + "_z"));
    };
    TraceRow row{world.InitialState(), {}};
    row.state.t = get("t");
    for (int i = 0; i < world.num_movables(); ++i) {
      const Body& body = world.scene().bodies[world.body_index(MovableIndex{i}).value];
      const std::string prefix = i == 0 ? "" : body.name + "_";
      row.state.bodies[i].p_WB = vector(prefix + "p_WO");
      const std::string q = prefix + "q_WO";
      row.state.bodies[i].q_WB =
          Quaternion(get(q + "_w"), get(q + "_x"), get(q + "_y"), get(q + "_z"));
    }
    for (int f = 0; f < kNumFingers; ++f) {
      const std::string finger = kFingerNames[f];
      if (!column.contains(finger + "_on")) continue;
      row.state.fingers[f].on = get(finger + "_on") > 0.5;
      row.state.fingers[f].touching = !vector(finger + "_f_W").isZero();
      row.state.fingers[f].p_OC = vector(finger + "_p_OC");
      row.state.fingers[f].nhat_O = vector(finger + "_n_OC");
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

// When the fingers that close are put on: after the last row whose fingers are not all that lift.
double FindClosing(const std::vector<TraceRow>& lift) {
  const auto on = [](const TraceRow& row) {
    int bits = 0;
    for (int f = 0; f < kNumFingers; ++f) bits |= row.state.fingers[f].on ? 1 << f : 0;
    return bits;
  };
  for (std::size_t i = lift.size() - 1; i > 0; --i) {
    if (on(lift[i - 1]) != on(lift.back())) return lift[i - 1].state.t;
  }
  return lift.front().state.t + 0.1;
}

// As recorded. Bodies other than the object are where the row has them that has the object there.
std::vector<AuditFrame> ReadFrames(const std::filesystem::path& directory, const World& world,
                                   const std::vector<TraceRow>& rows) {
  std::vector<AuditFrame> frames;
  std::size_t at = 0;
  for (const MotionRecord& record :
       ReadMotionTable(directory / "motion.csv", HandOf(world.scene()))) {
    std::size_t nearest = at;
    double least = 1e9;
    for (std::size_t i = at; i < rows.size(); ++i) {
      const double away =
          (rows[i].state.bodies[0].p_WB - record.X_WO.translation()).norm() +
          0.1 * RotationAngle(rows[i].state.bodies[0].X_WB().linear(), record.X_WO.linear());
      if (away < least) {
        least = away;
        nearest = i;
      }
      if (least < 1e-12) break;
    }
    at = nearest;
    AuditFrame frame{record.t, record.phase, world.GetPoses(rows[at].state), record.hand,
                     record.on};
    frame.X_WB.front() = record.X_WO;
    frames.push_back(std::move(frame));
  }
  return frames;
}

struct Tally {
  int motions = 0, free = 0, within = 0, claimed = 0, claimed_free = 0;
  double seconds = 0.0, worst = 0.0, per_120 = 0.0;

  void Add(const MotionAudit& audit) {
    ++motions;
    free += audit.IsFree();
    int over = 0;
    for (const AuditRates& rates : audit.rates) over += rates.over;
    within += over == 0;
    worst = std::max({worst, audit.worst_frame, audit.worst_way});
  }
};

void Print(const std::string& name, const MotionAudit& audit, const std::string& more) {
  fmt::print(
      "{}: {} frames, {} bad frames ({:.2f} mm), {} bad ways ({:.2f} mm){}{}, jump {:.1f} deg,"
      " still {:.2f} s{}\n",
      name, audit.frames, audit.bad_frames, 1e3 * audit.worst_frame, audit.bad_ways,
      1e3 * audit.worst_way, audit.worst_pair.empty() ? "" : ", " + audit.worst_pair,
      audit.out_of_range > 0 ? ", OUT OF RANGE" : "", RadToDeg(audit.worst_jump),
      audit.longest_still, more);
  for (int phase = 0; phase < kNumMotionPhases; ++phase) {
    const AuditRates& r = audit.rates[phase];
    if (r.frames == 0) continue;
    fmt::print(
        "  {:8} {:3} frames, wrist {:.2f} m/s {:.2f} rad/s {:5.2f} m/s2 {:5.1f} rad/s2, "
        "joints {:.2f} rad/s {:5.1f} rad/s2, {} over, {:.2f} of {}\n",
        MotionPhaseName(static_cast<MotionPhase>(phase)), r.frames, r.wrist, r.turn,
        r.wrist_acceleration, r.turn_acceleration, r.joint, r.joint_acceleration, r.over, r.share,
        r.limiting);
  }
}

void Make(const IkSolver& solver, const HandMotion& motion, const Scene& scene,
          const std::string& name, Tally* tally) {
  // Time of this thread on a processor: others work on this machine too.
  const auto seconds = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  auto timer = [&seconds, from = seconds()]() mutable {
    const double lap = seconds() - from;
    from += lap;
    return lap;
  };
  MotionState state = motion.Start();
  std::string key_rungs;
  while (motion.SolveKeyframe(state)) {
    key_rungs +=
        static_cast<char>('0' + static_cast<int>(state.keys[state.solved_keys.back()].rung));
  }
  const double keys = timer();
  motion.FillInBetweens(state);
  const double fill = timer();
  std::string filled;
  for (const MotionFrame& frame : state.frames) {
    filled += static_cast<char>('0' + static_cast<int>(frame.rung));
  }
  if (filled.find_first_not_of('0') != std::string::npos) {
    fmt::print("  keys {} filled {}\n", key_rungs, filled);
  }
  motion.Smooth(state);
  const double smooth = timer();
  const MotionSummary summary = motion.Summarize(state);
  const MotionAudit audit = AuditMotion(HandOf(scene), scene, FramesOf(state));
  std::string rungs;  // of the frames: the number of the rung, x where the way to it is blocked
  for (const MotionFrame& frame : state.frames) {
    rungs += frame.way_clear ? static_cast<char>('0' + static_cast<int>(frame.rung)) : 'x';
  }
  const std::size_t first = rungs.find_first_not_of('0');
  if (first != std::string::npos) {
    fmt::print("  {}\n", rungs);
    // What is amiss at the middle one of the first that give something up.
    const std::size_t at =
        first + (rungs.find_first_not_of(rungs[first], first + 1) == std::string::npos
                     ? rungs.size() - first
                     : rungs.find_first_not_of(rungs[first], first + 1) - first) /
                    2;
    IkConfig ik;
    const IkResult amiss =
        solver.Evaluate(ik, MakeIkProblem(state.task->frames[at]), state.frames[at].configuration);
    fmt::print("  frame {}: {}", at, IkStatusName(amiss.status));
    for (int f = 0; f < kNumFingers; ++f) {
      if (!state.task->frames[at].contacts[f].on) continue;
      fmt::print(", {} {:.2f} mm {:.0f} deg", kFingerNames[f], 1e3 * amiss.tip_errors[f],
                 RadToDeg(amiss.cone_angles[f]));
    }
    fmt::print(", overlap {:.2f} mm", 1e3 * amiss.contact_overlap);
    if (amiss.closest) {
      fmt::print(", {:.2f} mm between {} and {} {}", 1e3 * amiss.closest->distance,
                 ShadowHand().capsules[amiss.closest->capsule].name,
                 static_cast<int>(amiss.closest->pair), amiss.closest->other);
    }
    fmt::print(", joints");
    for (int j = 0; j < kMaxHandJoints; ++j) {
      const double q = state.frames[at].configuration.q[j];
      if (q <= ShadowHand().q_lower[j] || q >= ShadowHand().q_upper[j]) {
        fmt::print(" {}", ShadowHand().joints[j].name);
      }
    }
    fmt::print(" at a limit\n");
  }
  std::string ways;
  for (const DetourKind kind : state.detours) ways += fmt::format(" {}", DetourKindName(kind));
  Print(name, audit,
        fmt::format(
            "\n  {} failed ({} ways), {} loosened, {} over limits, tip {:.2f} mm, clearance {:.2f} "
            "mm, ways{}, {} iterations; {:.2f} + {:.2f} + {:.2f} s",
            summary.failed, summary.blocked_ways, summary.loosened, summary.over_limits,
            1e3 * summary.max_tip_error, 1e3 * summary.min_clearance, ways, state.iterations, keys,
            fill, smooth));
  tally->Add(audit);
  tally->claimed += summary.failed == 0;
  tally->claimed_free += summary.failed == 0 && audit.IsFree();
  tally->seconds += keys + fill + smooth;
  tally->per_120 = std::max(tally->per_120, 120.0 * (keys + fill + smooth) / audit.frames);
}

void Run(bool remake, const std::filesystem::path& directory, Tally* tally) {
  const Scene scene = LoadScene(directory / "scene.json");
  const World world(scene);
  std::vector<TraceRow> trace = ReadTrace(directory / "rollout.csv", world);
  const std::vector<TraceRow> lift = ReadTrace(directory / "lift.csv", world);
  if (remake) {
    const double closing_t = FindClosing(lift);
    const std::vector<MotionRecord> recorded =
        ReadMotionTable(directory / "motion.csv", HandOf(scene));
    // The recorded motion's grasp: the hand when the lift begins.
    HandConfiguration grasp;
    RigidTransform X_WO;
    for (const MotionRecord& record : recorded) {
      if (record.phase != MotionPhase::kClosing) continue;
      grasp = record.hand;
    }
    const IkSolver solver(HandOf(scene), scene);
    const HandMotion motion(solver,
                            BuildMotionTask(world, trace, {lift, closing_t, closing_t + 0.6}, {}),
                            grasp, {}, 1);
    Make(solver, motion, scene, directory.string(), tally);
    return;
  }
  trace.insert(trace.end(), lift.begin(), lift.end());
  const MotionAudit audit = AuditMotion(HandOf(scene), scene, ReadFrames(directory, world, trace));
  Print(directory.string(), audit, "");
  tally->Add(audit);
}

void RunProblem(int number, Tally* tally) {
  const MotionProblem problem = MakeMotionProblem(static_cast<std::uint64_t>(number));
  const IkSolver solver(HandOf(problem.scene), problem.scene);
  const HandMotion motion(solver, problem.task, problem.grasp, {}, 1);
  Make(solver, motion, problem.scene, fmt::format("problem {}", number), tally);
}

int Main(int argc, char** argv) {
  const std::string verb = argc > 1 ? argv[1] : "";
  Tally tally;
  if (verb == "problems" && argc > 2) {
    const int first = argc > 3 ? std::atoi(argv[3]) : 1;
    for (int i = 0; i < std::atoi(argv[2]); ++i) RunProblem(first + i, &tally);
  } else if ((verb == "audit" || verb == "remake") && argc > 2) {
    for (int i = 2; i < argc; ++i) Run(verb == "remake", argv[i], &tally);
  } else {
    throw InputError("motion_study: expected audit DIR.., remake DIR.. or problems N [FIRST]");
  }
  fmt::print("{} motions: {} free in and between frames (worst {:.2f} mm), {} within limits",
             tally.motions, tally.free, 1e3 * tally.worst, tally.within);
  if (verb != "audit") {
    fmt::print(
        ", {} said to be clean, of these {} are; {:.2f} s each, {:.2f} s a 120 frames at worst",
        tally.claimed, tally.claimed_free, tally.seconds / tally.motions, tally.per_120);
  }
  fmt::print("\n");
  return tally.free == tally.motions ? 0 : 1;
}

}  // namespace
}  // namespace pregrasp

int main(int argc, char** argv) {
  try {
    return pregrasp::Main(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
