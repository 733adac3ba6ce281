#include "app/job/timeline.h"

#include <algorithm>
#include <chrono>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/job/planner_settings.h"

namespace pregrasp {
namespace {

// States kept: those of about ten paths. Older ones are computed again when they are needed.
constexpr std::size_t kKeptStates = 1500;

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

}  // namespace

Timeline::Timeline(Job& job) : job_(job) {
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
  states_[node->number] = std::move(applied.state);
  if (states_.size() > kKeptStates) states_.erase(std::next(states_.begin()));
  by_id_[node->facts.id] = node.get();
  if (parent != nullptr) children_[parent].push_back(node.get());
  nodes_.push_back(std::move(node));
  if (listener_) listener_(*nodes_.back());
  return *nodes_.back();
}

const Timeline::Node& Timeline::Do(const Node& from, Verb verb, nlohmann::json options) {
  const std::shared_ptr<const JobState> state = GetState(from);
  if (options.is_null()) options = nlohmann::json::object();
  DropIdleSettings(options, state->config);
  const Command command{verb, from.id(), std::move(options)};
  if (const Node* known = FindChild(from, command)) return *known;
  return Commit(from, TimedApply(state, command));
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
  const auto kept = states_.find(node.number);
  if (kept != states_.end()) return kept->second;
  PREGRASP_CHECK(node.parent != nullptr);
  std::shared_ptr<const JobState> state = TimedApply(GetState(*node.parent), node.command).state;
  states_[node.number] = state;
  return state;
}

std::vector<const Timeline::Node*> PathTo(const Timeline::Node& node) {
  std::vector<const Timeline::Node*> path;
  for (const Timeline::Node* at = &node; at != nullptr; at = at->parent) path.push_back(at);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace pregrasp
