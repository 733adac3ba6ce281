#include "app/session/recorder.h"

#include <chrono>
#include <utility>
#include <vector>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/job/planner_settings.h"
#include "app/job/run_policy.h"
#include "app/pictures/overlay.h"
#include "app/recording/checked_file.h"
#include "app/recording/motion_table.h"
#include "app/recording/rollout_table.h"
#include "app/recording/trace_table.h"

namespace pregrasp {
namespace {

// What the manifest says of the settings at a node.
nlohmann::json ConfigurationAt(const Timeline& timeline, const Timeline::Node& node) {
  nlohmann::json all = PlannerConfigJson(timeline.GetState(node)->config);
  const StepConfig& step = timeline.job().world().config();
  all["dynamics"] = {{"dt", step.dt},
                     {"tolerance", step.tolerance},
                     {"tolerance_many", step.tolerance_many},
                     {"max_sweeps", step.max_sweeps},
                     {"max_sweeps_many", step.max_sweeps_many},
                     {"margin", step.margin},
                     {"restitution", step.restitution}};
  return all;
}

// The simulated lift of the chosen grasp, or of the most promising one; null for none.
const LiftResult* FindLift(const JobState& state) {
  int number = state.chosen_grasp;
  if (number == 0 && !state.lifts.empty()) number = OrderGrasps(state).front();
  const auto found = state.lifts.find(number);
  return found == state.lifts.end() || !found->second->simulated ? nullptr : found->second.get();
}

}  // namespace

Recorder::Recorder(const std::filesystem::path& directory, const Timeline& timeline,
                   PictureMode pictures, PictureDrawer& drawer, RunInfo info)
    : run_(directory, timeline.job().scene(), std::move(info)),
      timeline_(timeline),
      pictures_(pictures),
      drawer_(drawer) {}

void Recorder::Draw(const Timeline::Node& node, const Shot& shot) {
  const auto begin = std::chrono::steady_clock::now();
  drawer_.Draw(node.facts, timeline_, shot, run_.PictureFile(node.number, node.id()));
  drawn_[node.number] = ShotToJson(shot);
  picture_seconds_ +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void Recorder::DrawPending() {
  std::vector<std::pair<const Timeline::Node*, Shot>> wanted;
  std::vector<StepPicture> pictures;
  for (const auto& [number, waiting] : pending_) {
    const Timeline::Node& node = *timeline_.nodes()[static_cast<std::size_t>(number) - 1];
    if (!waiting.asked && pictures_ != PictureMode::kAll && !IsKeyStep(node.facts, timeline_)) {
      continue;
    }
    wanted.emplace_back(&node, waiting.shot);
    pictures.push_back({&node.facts, waiting.shot.config});
  }
  if (!wanted.empty()) drawer_.ShareCamera(pictures, timeline_);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ThrowIfInterrupted();
    auto& [node, shot] = wanted[i];
    shot.shares_camera = pictures[i].config.camera.has_value();
    shot.config = pictures[i].config;
    Draw(*node, shot);
  }
  pending_.clear();
}

void Recorder::Add(const Timeline::Node& node) {
  const int number = run_.AddStep(node.facts);
  PREGRASP_CHECK(number == node.number, number, node.number);
  if (pictures_ != PictureMode::kNone) pending_[number] = {};
}

void Recorder::Shoot(const Timeline::Node& node, const Shot& shot) {
  if (pictures_ == PictureMode::kNone) return;
  Draw(node, shot);
  if (shot.config.camera) {
    pending_.erase(node.number);
  } else {
    pending_[node.number] = {shot, true};
  }
}

void Recorder::WriteTables(const Timeline::Node& node) {
  const auto state = timeline_.GetState(node);
  for (const WorldState& row : GetRollout(*state)) run_.AddRolloutRow(row);
  const Simulation* simulation = state->simulation.get();
  if (!state->certificate && simulation != nullptr && simulation->traced()) {
    std::string table;
    for (int i = 1; i < simulation->num_states(); ++i) {
      table += FormatTraceRow(simulation->trace_at(i), simulation->state_at(i).t,
                              timeline_.job().scene());
    }
    if (!table.empty()) WriteFile(run_.partial() / "trace.jsonl", table);
  }
  if (const LiftResult* lift = FindLift(*state)) {
    std::string table = LiftHeader(timeline_.job().scene());
    for (const TraceRow& row : lift->trace) table += LiftRow(timeline_.job().scene(), row.state);
    WriteFile(run_.partial() / "lift.csv", table);
  }
  if (state->motion && state->motion_state->filled) {
    std::string table = MotionHeader(timeline_.job().hand());
    for (std::size_t i = 0; i < state->motion_state->frames.size(); ++i) {
      table += MotionRow(timeline_.job().hand(), state->motion_state->task->frames[i],
                         state->motion_state->frames[i]);
    }
    WriteFile(run_.partial() / "motion.csv", table);
  }
}

void Recorder::Finish(const Timeline::Node& node, RunSummary summary) {
  PREGRASP_CHECK(pending_.empty());
  WriteTables(node);
  for (const auto& [number, shot] : drawn_) {
    run_.AddPicture(timeline_.nodes()[static_cast<std::size_t>(number) - 1]->facts, number, shot);
  }
  summary.seconds.pictures = picture_seconds_;
  run_.Finish(std::move(summary), node.id(), ConfigurationAt(timeline_, node));
}

}  // namespace pregrasp
