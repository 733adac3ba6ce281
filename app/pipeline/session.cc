#include "app/pipeline/session.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/geometry/overlap.h"
#include "app/pipeline/describe.h"
#include "app/recording/trace_table.h"

namespace pregrasp {
namespace {

nlohmann::json ToJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

std::shared_ptr<const World> BuildWorld(Scene scene) {
  const std::vector<Overlap> overlaps = FindOverlaps(scene);
  if (!overlaps.empty()) {
    const Overlap& deepest = overlaps.front();
    const Body& a = scene.bodies[deepest.body_a];
    const Body& b = scene.bodies[deepest.body_b];
    throw InputError(a.where, a.name, "bodies that do not overlap",
                     fmt::format("{:.3g} mm of overlap with \"{}\"", 1e3 * deepest.depth, b.name));
  }
  return std::make_shared<const World>(scene);
}

double PeakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace

Session::Session(Scene scene, const SessionConfig& config)
    : config_(config), world_(BuildWorld(std::move(scene))), start_(world_->InitialState()) {
  drawer_ = std::make_unique<PictureDrawer>(world_, config_.seed, config_.remake);
  JournalStep step = MakeStep(start_id_, "scene", start_, {});
  step.lines = DescribeScene(this->scene());
  journal_.push_back(std::move(step));
}

Session::~Session() = default;

ThreadPool& Session::pool() {
  if (!pool_) pool_ = std::make_unique<ThreadPool>(config_.threads);
  return *pool_;
}

const EnvironmentDistance& Session::environment() {
  if (!environment_) environment_ = std::make_unique<EnvironmentDistance>(scene());
  return *environment_;
}

JournalStep Session::MakeStep(const std::string& id, const std::string& stage,
                              const WorldState& state,
                              const std::vector<ContactPoint>& contacts) const {
  JournalStep step;
  step.record.id = id;
  step.record.stage = stage;
  step.record.t = state.t;
  for (int i = 0; i < world_->num_movables(); ++i) {
    step.record.bodies.push_back(
        {scene().bodies[world_->body_index(MovableIndex{i}).value].name, state.bodies[i].X_WB()});
  }
  for (int i = 0; i < kNumPlanningFingers; ++i) {
    const FingertipState& tip = state.fingers[i];
    step.record.fingers.push_back(
        {static_cast<Finger>(i), tip.on, tip.p_OC, tip.p_WTarget, tip.f_W});
  }
  step.state = state;
  step.contacts = contacts;
  return step;
}

void Session::AddStep(JournalStep step) {
  journal_.push_back(std::move(step));
  if (recorder_) recorder_->WriteUpToLast(journal_, start_, *drawer_);
}

SettleResult Session::Settle(double seconds) {
  if (num_actions_ > 0) {
    throw InputError("", "", "to settle before anything is simulated", "a simulation");
  }
  if (!(seconds > 0.0 && seconds <= Simulation::kMaxSeconds)) {
    throw InputError("", "seconds",
                     fmt::format("above 0 and at most {} s", Simulation::kMaxSeconds),
                     fmt::format("{}", seconds));
  }
  const WorldState before = start_;
  SettleResult result = pregrasp::Settle(*world_, start_, seconds);
  start_.t = 0.0;
  start_.step = 0;
  start_id_ = "scene.settle";
  JournalStep step = MakeStep(start_id_, "scene", start_, {});
  step.record.details = {{"action", "settle"},
                         {"seconds", seconds},
                         {"moved_mm", 1e3 * result.largest.moved},
                         {"rotated_deg", RadToDeg(result.largest.rotated)},
                         {"at_rest", result.at_rest}};
  step.lines = {fmt::format("Left alone for {:.3g} s, the {} {}.", seconds, scene().object().name,
                            result.at_rest ? "stays at rest" : "does not stay at rest"),
                fmt::format("moved\t{:.4f} mm", 1e3 * result.largest.moved),
                fmt::format("turned\t{:.4f} deg", RadToDeg(result.largest.rotated))};
  AddStep(std::move(step));
  return result;
}

std::shared_ptr<Simulation> Session::Simulate(bool traced) {
  return std::make_shared<Simulation>(world_, start_, start_id_, traced);
}

namespace {

// What the last physics step did, to the step's details and lines.
void AddTrace(const Simulation& simulation, JournalStep* step) {
  const int last = simulation.num_states() - 1;
  if (!simulation.traced() || last == 0) return;
  const StepTrace& trace = simulation.trace_at(last);
  step->traced = true;
  step->record.details["trace"] = TraceToJson(trace, simulation.world().scene());
  for (std::string& line : DescribeTrace(trace)) step->lines.push_back(std::move(line));
}

}  // namespace

JournalStep Session::StepOfAction() const {
  const WorldState& after = last_->state();
  JournalStep step = MakeStep(last_->step_id(), "sim", after, last_->contacts());
  const Motion motion = CalcObjectMotion(*world_, before_, after);
  step.record.details = details_;
  step.record.details["what"] = what_;
  step.record.details["moved_mm"] = 1e3 * motion.moved;
  step.record.details["rotated_deg"] = RadToDeg(motion.rotated);
  step.lines = DescribeStep(*world_, before_, after, last_->contacts());
  step.lines.insert(step.lines.begin(), what_);
  AddTrace(*last_, &step);
  return step;
}

void Session::Act(const std::shared_ptr<Simulation>& simulation, const std::string& what,
                  nlohmann::json details, const std::function<void()>& action) {
  WorldState before = simulation->state();
  simulation->BeginAction(fmt::format("sim.{}", num_actions_ + 1));
  const auto add_step = [&] {
    ++num_actions_;
    last_ = simulation;
    before_ = std::move(before);
    what_ = what;
    details_ = std::move(details);
    AddStep(StepOfAction());
  };
  try {
    action();
  } catch (const Interrupted&) {
    details["interrupted"] = true;
    add_step();
    throw;
  }
  add_step();
}

void Session::Shorten(const std::shared_ptr<Simulation>& simulation, int steps) {
  PREGRASP_CHECK(simulation == last_ && simulation->step_id() == journal_.back().record.id);
  simulation->Back(steps);
  details_["stopped"] = true;
  journal_.back() = StepOfAction();
}

void Session::Touch(const std::shared_ptr<Simulation>& simulation, Finger finger,
                    const Vector3& p_OC) {
  Simulation tried = *simulation;  // where the finger lands is known only when it has
  tried.Touch(finger, p_OC);
  const Vector3 landed = tried.state().fingers[static_cast<int>(finger)].p_OC;
  Act(simulation,
      fmt::format("The {} touches the {} at {}.", FingerName(finger), scene().object().name,
                  FormatMillimetres(landed)),
      {{"action", "touch"}, {"finger", FingerName(finger)}, {"p_OC", ToJson(landed)}},
      [&] { simulation->Touch(finger, p_OC); });
}

void Session::Lift(const std::shared_ptr<Simulation>& simulation, Finger finger) {
  Act(simulation, fmt::format("The {} lifts off.", FingerName(finger)),
      {{"action", "lift"}, {"finger", FingerName(finger)}}, [&] { simulation->Lift(finger); });
}

void Session::Move(const std::shared_ptr<Simulation>& simulation, Finger finger,
                   const Vector3& p_WTarget, double seconds) {
  const Vector3 by = p_WTarget - simulation->state().fingers[static_cast<int>(finger)].p_WTarget;
  Act(simulation,
      fmt::format("The {}'s target moves by {} in {:.3g} s.", FingerName(finger),
                  FormatMillimetres(by), seconds),
      {{"action", "move"},
       {"finger", FingerName(finger)},
       {"p_WTarget", ToJson(p_WTarget)},
       {"seconds", seconds}},
      [&] { simulation->Move(finger, p_WTarget, seconds); });
}

void Session::Wait(const std::shared_ptr<Simulation>& simulation, double seconds) {
  Act(simulation, fmt::format("Nothing is moved for {:.3g} s.", seconds),
      {{"action", "wait"}, {"seconds", seconds}},
      [&] { simulation->Step(simulation->StepsIn(seconds)); });
}

void Session::Step(const std::shared_ptr<Simulation>& simulation, int steps) {
  Act(simulation, fmt::format("{} physics steps.", steps), {{"action", "step"}, {"steps", steps}},
      [&] { simulation->Step(steps); });
}

JournalStep Session::StepOf(const Simulation& simulation) const {
  const JournalStep& last = journal_.back();
  if (last.record.id == simulation.step_id() && last.state.step == simulation.state().step) {
    return last;
  }
  JournalStep step =
      MakeStep(simulation.step_id(), "sim", simulation.state(), simulation.contacts());
  step.record.details = {{"action", "shot"}};
  step.lines = DescribeStep(*world_, start_, simulation.state(), simulation.contacts());
  AddTrace(simulation, &step);
  return step;
}

namespace {

// Whether two steps show the same moment of the same thing.
bool SameMoment(const JournalStep& a, const JournalStep& b) {
  return a.record.id == b.record.id && a.state.step == b.state.step && a.overlay == b.overlay;
}

}  // namespace

void Session::Shoot(const JournalStep& step, const JournalStep::Shot& shot) {
  shot.config.Validate();
  if (journal_.back().shot || !SameMoment(journal_.back(), step)) {
    JournalStep again = step;
    again.shot.reset();
    AddStep(std::move(again));
  }
  journal_.back().shot = shot;
}

void Session::ShootToFile(JournalStep step, const JournalStep::Shot& shot,
                          const std::filesystem::path& file) {
  shot.config.Validate();
  step.shot = shot;
  if (config_.pictures == PictureMode::kNone) return;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  drawer_->Draw(step, start_, file);
}

std::unique_ptr<JournalWriter> Session::OpenWriter(const std::filesystem::path& directory,
                                                   PictureMode pictures) {
  return std::make_unique<JournalWriter>(directory, *world_, config_.seed,
                                         config_.pictures.value_or(pictures));
}

void Session::Record(const std::filesystem::path& directory, PictureMode pictures) {
  if (recorder_) {
    throw InputError("", "dir", "one recording at a time",
                     "a second one, while " + recorder_->directory().string() + " is open");
  }
  recorder_ = OpenWriter(directory, pictures);
  recorder_->WriteUpToLast(journal_, start_, *drawer_);
}

RunOutcome Session::OutcomeOfSimulation() const {
  RunOutcome outcome;
  if (last_) {
    for (int i = 0; i < last_->num_states(); ++i) outcome.rollout.push_back(last_->state_at(i));
    for (int i = 1; last_->traced() && i < last_->num_states(); ++i) {
      outcome.trace_table += FormatTraceRow(last_->trace_at(i), last_->state_at(i).t, scene());
    }
  } else {
    outcome.rollout.push_back(start_);
  }
  const double max_penetration = last_ ? last_->CalcMaxPenetration() : 0.0;
  outcome.summary["physics"]["max_penetration_mm"] = 1e3 * max_penetration;
  return outcome;
}

void Session::Finish(JournalWriter& writer, const std::optional<std::string>& status) {
  RunOutcome outcome = OutcomeOfSimulation();
  if (outcome_) {
    const RunOutcome simulated = std::move(outcome);
    outcome = *outcome_;
    // Before a trajectory is certified, the simulation is still what rollout.csv shows.
    if (outcome.rollout.empty()) {
      outcome.rollout = simulated.rollout;
      outcome.trace_table = simulated.trace_table;
      outcome.summary["physics"] = simulated.summary["physics"];
    }
  }
  const Motion motion = CalcObjectMotion(*world_, outcome.rollout.front(), outcome.rollout.back());
  double max_speed = 0.0;
  for (const WorldState& state : outcome.rollout) {
    max_speed = std::max(max_speed, state.bodies[0].v_WB.norm());
  }
  outcome.summary["object_motion"] = {{"translation_m", motion.moved},
                                      {"rotation_deg", RadToDeg(motion.rotated)},
                                      {"max_speed", max_speed}};
  outcome.summary["seconds"]["total"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - opened_).count();
  outcome.summary["peak_rss_mb"] = PeakMegabytes();
  if (status) outcome.summary["status"] = *status;
  const StepConfig& step = world_->config();
  outcome.configuration["dynamics"] = {{"dt", step.dt},
                                       {"tolerance", step.tolerance},
                                       {"tolerance_many", step.tolerance_many},
                                       {"max_sweeps", step.max_sweeps},
                                       {"max_sweeps_many", step.max_sweeps_many},
                                       {"margin", step.margin},
                                       {"restitution", step.restitution}};
  writer.Finish(journal_, start_, *drawer_, outcome);
}

std::filesystem::path Session::Save(const std::optional<std::filesystem::path>& directory) {
  if (recorder_ && (!directory || *directory == recorder_->directory())) {
    std::filesystem::path where = recorder_->directory();
    FinishRecording();
    return where;
  }
  if (!directory) throw InputError("", "dir", "a folder, as nothing is recorded", "nothing");
  const std::unique_ptr<JournalWriter> writer = OpenWriter(*directory, PictureMode::kKey);
  Finish(*writer, std::nullopt);
  return *directory;
}

void Session::FinishRecording(const std::optional<std::string>& status) {
  if (!recorder_) return;
  const std::unique_ptr<JournalWriter> recorder = std::move(recorder_);
  Finish(*recorder, status);
}

}  // namespace pregrasp
