#include "app/job/timeline.h"

#include <algorithm>
#include <chrono>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/job/apply_stages.h"
#include "app/job/facts_bytes.h"
#include "app/job/facts_json.h"
#include "app/job/planner_settings.h"

namespace pregrasp {
namespace {

// States kept: those of about ten paths, in half of what a script may use. Others are computed
// again when they are needed.
constexpr std::size_t kKeptStates = 1500;
constexpr std::size_t kKeptBytes = 256'000'000;

// "~2" of "path.1.mppi.7~2".
std::string BranchOf(const std::string& id) {
  const std::size_t mark = id.find('~');
  return mark == std::string::npos ? "" : id.substr(mark);
}

// Leaves settings out that are as they were.
void DropIdleSettings(nlohmann::json& options, const PlannerConfig& config) {
  const auto settings = options.find("settings");
  if (settings == options.end()) return;
  const nlohmann::json now = PlannerConfigJson(config);
  nlohmann::json changed = nlohmann::json::object();
  for (const auto& [name, value] : settings->items()) {
    const std::size_t dot = name.find('.');
    const std::string root = name.substr(0, dot);
    const bool known =
        dot != std::string::npos && now.contains(root) && now[root].contains(name.substr(dot + 1));
    if (!known || now[root][name.substr(dot + 1)] != value) changed[name] = value;
  }
  if (changed.empty()) {
    options.erase("settings");
  } else {
    options["settings"] = std::move(changed);
  }
}

// Of the steps that follow one, done before that of `number`, that whose action begins as the one
// asked for and goes on for as many physics steps or more; null where nothing says how many it is
// to have.
const Timeline::Node* FindWhole(const std::vector<const Timeline::Node*>& children,
                                const Command& command, int number) {
  const char* const kStopped = "stopped_after";
  const auto stopped = command.options.find(kStopped);
  if (stopped == command.options.end() || !stopped->is_number_integer()) return nullptr;
  const auto without = [&](nlohmann::json options) {
    options.erase(kStopped);
    return options;
  };
  const nlohmann::json asked = without(command.options);
  for (const Timeline::Node* child : children) {
    const auto* facts = std::get_if<SimulationFacts>(&child->facts.details);
    if (child->number < number && facts != nullptr && child->command.verb == command.verb &&
        facts->physics_steps >= stopped->get<int>() && without(child->command.options) == asked) {
      return child;
    }
  }
  return nullptr;
}

// Holds the record of a step against what doing it again gives.
void RequireSame(const StepFacts& here, const StepFacts& recorded, double tolerance) {
  if (const auto difference = CompareFacts(here, recorded, tolerance)) {
    throw InputError(recorded.id, difference->field, difference->left + ", as this program has it",
                     difference->right + " on record");
  }
}

// The progress of a step that was not done here, from what is recorded: as CalcProgress.
Progress ProgressAfter(const Timeline::Node& node) {
  using Reached = Progress::Reached;
  const Progress& before = node.parent->progress;
  Progress progress;
  if (const auto* certified = std::get_if<CertifyFacts>(&node.facts.details)) {
    progress.reached = certified->certified ? Reached::kCertified : Reached::kTrajectory;
    return progress;
  }
  const bool follows = std::holds_alternative<GraspFacts>(node.facts.details) ||
                       std::holds_alternative<LiftFacts>(node.facts.details) ||
                       std::holds_alternative<FrameFacts>(node.facts.details) ||
                       std::holds_alternative<MotionFacts>(node.facts.details);
  if (!follows) return progress;
  if (node.command.verb == Verb::kFrame) return before;
  progress.feasible = before.feasible;
  progress.lifted = before.lifted;
  if (const auto* grasp = std::get_if<GraspFacts>(&node.facts.details)) {
    progress.feasible += grasp->feasible ? 1 : 0;
  }
  if (const auto* lift = std::get_if<LiftFacts>(&node.facts.details)) {
    progress.lifted += lift->held ? 1 : 0;
  }
  progress.reached = progress.lifted > 0     ? Reached::kLifted
                     : progress.feasible > 0 ? Reached::kFeasible
                                             : Reached::kCertified;
  const auto* motion = std::get_if<MotionFacts>(&node.facts.details);
  if (node.command.verb != Verb::kSmooth || motion->failed > 0) return progress;
  bool held = false, disturbed = false;
  for (const Timeline::Node* at = node.parent; at != nullptr; at = at->parent) {
    const auto* lift = std::get_if<LiftFacts>(&at->facts.details);
    if (lift != nullptr && lift->grasp == motion->grasp) {
      held = lift->held;
      disturbed = disturbed || lift->neighbours.disturbed;
    }
    if (const auto* certified = std::get_if<CertifyFacts>(&at->facts.details)) {
      disturbed = disturbed || certified->neighbours.disturbed;
      break;
    }
  }
  if (held) progress.reached = disturbed ? Reached::kMoved : Reached::kOk;
  return progress;
}

}  // namespace

Timeline::Timeline(Job& job) : job_(job), states_(kKeptStates, kKeptBytes) {
  Add(nullptr, TimedApply(nullptr, {Verb::kOpen, "", nlohmann::json::object()}));
}

Applied Timeline::TimedApply(const std::shared_ptr<const JobState>& state,
                             const Command& command) const {
  const auto begin = std::chrono::steady_clock::now();
  Applied applied = Apply(job_, state, command);
  if (const std::string stage = TimedStage(command.verb); !stage.empty()) {
    seconds_[stage] +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  return applied;
}

Applied Timeline::ApplyAfter(const Node& from, const std::shared_ptr<const JobState>& state,
                             const Command& command, int number) const {
  const auto children = children_.find(&from);
  const Node* whole =
      children == children_.end() ? nullptr : FindWhole(children->second, command, number);
  if (whole == nullptr) return TimedApply(state, command);
  return internal::ApplyPart(job_, state, command, *GetState(*whole)->simulation);
}

const Timeline::Node* Timeline::FindChild(const Node& from, const Command& command) const {
  const auto children = children_.find(&from);
  if (children == children_.end()) return nullptr;
  for (const Node* child : children->second) {
    if (child->command == command) return child;
  }
  return nullptr;
}

std::string Timeline::FreeId(const std::string& id, const Node* parent) const {
  std::string candidate = parent == nullptr ? id : id + BranchOf(parent->id());
  for (int n = 2; by_id_.count(candidate) > 0; ++n) candidate = id + '~' + std::to_string(n);
  return candidate;
}

const Timeline::Node& Timeline::Add(const Node* parent, Applied applied) {
  auto node = std::make_unique<Node>();
  node->number = static_cast<int>(nodes_.size()) + 1;
  node->parent = parent;
  node->facts = std::move(applied.facts);
  node->facts.id = FreeId(node->facts.id, parent);
  node->command = node->facts.command;
  node->progress = CalcProgress(*applied.state);
  states_.Keep(node->number, std::move(applied.state));
  return Insert(std::move(node));
}

const Timeline::Node& Timeline::Insert(std::unique_ptr<Node> node) {
  facts_bytes_ += CalcBytes(node->facts);
  if (node->parent != nullptr) {
    std::vector<const Node*>& siblings = children_[node->parent];
    // Part of another action has its past in common with that.
    if (FindWhole(siblings, node->command, node->number) == nullptr) {
      facts_bytes_ += CalcPastBytes(node->facts);
    }
    siblings.push_back(node.get());
  }
  by_id_[node->facts.id] = node.get();
  nodes_.push_back(std::move(node));
  if (listener_) listener_(*nodes_.back());
  return *nodes_.back();
}

const Timeline::Node& Timeline::Restore(StepFacts facts, double tolerance) {
  if (facts.command.verb == Verb::kOpen) {
    RequireSame(root().facts, facts, tolerance);
    return root();
  }
  const Node& parent = Find(facts.command.node);
  if (by_id_.count(facts.id) > 0) {
    throw InputError("", "id", "an id of its own", "a second \"" + facts.id + '"');
  }
  auto node = std::make_unique<Node>();
  node->number = static_cast<int>(nodes_.size()) + 1;
  node->parent = &parent;
  node->command = facts.command;
  node->facts = std::move(facts);
  node->progress = ProgressAfter(*node);
  node->recorded_tolerance = tolerance;
  return Insert(std::move(node));
}

void Timeline::SetGate(std::function<bool(const Node&)> more) {
  gate_ = std::move(more);
  gate_open_ = true;
}

const Timeline::Node& Timeline::Pass(const Node& node) {
  if (gate_) gate_open_ = gate_(node);
  return node;
}

const Timeline::Node& Timeline::Do(const Node& from, Verb verb, nlohmann::json options) {
  if (gate_ && !gate_open_) throw Paused();
  if (options.is_null()) options = nlohmann::json::object();
  // What has no settings is known or not without the state, which a recorded step may not have.
  if (!options.contains("settings")) {
    if (const Node* known = FindChild(from, {verb, from.id(), options})) return Pass(*known);
  }
  const std::shared_ptr<const JobState> state = GetState(from);
  DropIdleSettings(options, state->config);
  const Command command{verb, from.id(), std::move(options)};
  if (const Node* known = FindChild(from, command)) return Pass(*known);
  const int number = static_cast<int>(nodes_.size()) + 1;
  return Pass(Commit(from, ApplyAfter(from, state, command, number)));
}

Applied Timeline::Try(const Node& from, Verb verb, const nlohmann::json& options) const {
  return Apply(job_, GetState(from), {verb, from.id(), options});
}

const Timeline::Node& Timeline::Commit(const Node& from, Applied applied) {
  if (const Node* known = FindChild(from, applied.facts.command)) return *known;
  const bool interrupted = applied.interrupted;
  const Node& node = Add(&from, std::move(applied));
  if (interrupted) throw Interrupted();
  return node;
}

const Timeline::Node& Timeline::Find(const std::string& id) const {
  const auto found = by_id_.find(id);
  if (found != by_id_.end()) return *found->second;
  std::vector<std::string> ids;
  for (const auto& node : nodes_) ids.push_back(node->id());
  const std::string nearest = FindNearest(id, ids);
  throw InputError("", "id", nearest.empty() ? "the id of a step" : '"' + nearest + '"',
                   '"' + id + '"');
}

std::shared_ptr<const JobState> Timeline::GetState(const Node& node) const {
  if (auto kept = states_.Find(node.number)) return kept;
  PREGRASP_CHECK(node.parent != nullptr);
  Applied applied = ApplyAfter(*node.parent, GetState(*node.parent), node.command, node.number);
  if (node.recorded_tolerance) {
    applied.facts.id = node.id();  // which branch it is on is the record's to say
    RequireSame(applied.facts, node.facts, *node.recorded_tolerance);
  }
  states_.Keep(node.number, applied.state);
  return std::move(applied.state);
}

std::vector<const Timeline::Node*> PathTo(const Timeline::Node& node) {
  std::vector<const Timeline::Node*> path;
  for (const Timeline::Node* at = &node; at != nullptr; at = at->parent) path.push_back(at);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace pregrasp
