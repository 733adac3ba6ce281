#pragma once

#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/job/apply.h"
#include "app/job/state_store.h"

namespace pregrasp {

/// Thrown by a timeline that was told to do no more (Timeline::SetGate).
struct Paused : std::exception {
  const char* what() const noexcept override { return "paused"; }
};

/// Everything that was done in a job, as a tree: a node is a step, its parent the step it acted on.
/// Going back is to act on an earlier node, a fork is a second child. Nodes never change and never
/// go away.
///
/// Ids are unique and do not depend on what else is in the tree's other branches but for the order
/// in which branches began: the same command from the same node is the same node, any other whose
/// id is taken gets the next free ~n, which what follows it carries on.
class Timeline : public FactsSource {
 public:
  struct Node {
    int number = 0;  ///< from 1, in the order of doing
    const Node* parent = nullptr;
    Command command;  ///< its node is the parent's id
    StepFacts facts;
    Progress progress;
    /// Taken from a record and not done yet: when its state is first asked for, what that gives
    /// may differ from the facts by so much and no more. None: it was done here.
    std::optional<double> recorded_tolerance = std::nullopt;

    const std::string& id() const { return facts.id; }
  };

  /// Opens the job's scene: the root is scene.start. @param job  outlives this.
  explicit Timeline(Job& job);

  Job& job() const { return job_; }
  const Node& root() const { return *nodes_.front(); }
  const Node& last() const { return *nodes_.back(); }
  /// In the order of doing.
  const std::vector<std::unique_ptr<Node>>& nodes() const { return nodes_; }

  /// Does `verb` to `from`, or finds the node where that was done. Settings that change nothing are
  /// left out.
  /// @throws as Apply. Interrupted physics of a simulation by hand is a node first.
  const Node& Do(const Node& from, Verb verb, nlohmann::json options = nlohmann::json::object());

  /// Adds the next step of a job that was recorded, as its record has it, without doing it:
  /// GetState does, and holds the record against what comes of it.
  /// @param facts  the steps in the order of doing, the root's first, which is compared at once.
  /// @param tolerance  the distance (CalcDistance) up to which numbers count as the same.
  /// @throws InputError for a step that does not fit the timeline.
  const Node& Restore(StepFacts facts, double tolerance);

  /// From now on `more` is called with each node that Do did or found; after its first no, Do
  /// throws Paused before it does anything. An empty function takes that back.
  void SetGate(std::function<bool(const Node&)> more);

  /// What Do would come to, without doing it; Commit then does it.
  Applied Try(const Node& from, Verb verb, const nlohmann::json& options) const;
  const Node& Commit(const Node& from, Applied applied);

  /// The node with this id. @throws InputError if there is none, with the nearest one.
  const Node& Find(const std::string& id) const;
  const StepFacts& Get(const std::string& id) const override { return Find(id).facts; }

  /// The job's state after a node: kept for those used last, else computed again from the nearest
  /// one before it that is.
  std::shared_ptr<const JobState> GetState(const Node& node) const;

  /// What the nodes and the states that are kept hold, about [bytes].
  std::size_t held_bytes() const { return facts_bytes_ + states_.bytes(); }

  /// Called with each new node.
  void SetListener(std::function<void(const Node&)> listener) { listener_ = std::move(listener); }

  /// Wall time spent in each of TimedStage's stages [s].
  const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  const Node* FindChild(const Node& from, const Command& command) const;
  const Node& Add(const Node* parent, Applied applied);
  std::string FreeId(const std::string& id, const Node* parent) const;
  Applied TimedApply(const std::shared_ptr<const JobState>& state, const Command& command) const;
  // Does the command of node `number` to `from`: of an action that was stopped, by what was done
  // of the whole of it before.
  Applied ApplyAfter(const Node& from, const std::shared_ptr<const JobState>& state,
                     const Command& command, int number) const;
  const Node& Insert(std::unique_ptr<Node> node);
  const Node& Pass(const Node& node);

  Job& job_;
  std::vector<std::unique_ptr<Node>> nodes_;
  std::map<std::string, const Node*> by_id_;
  std::map<const Node*, std::vector<const Node*>> children_;
  std::size_t facts_bytes_ = 0;
  mutable StateStore states_;  // by number
  mutable std::map<std::string, double> seconds_;
  std::function<void(const Node&)> listener_;
  std::function<bool(const Node&)> gate_;
  bool gate_open_ = true;
};

/// The nodes from the root to `node`, both included.
std::vector<const Timeline::Node*> PathTo(const Timeline::Node& node);

}  // namespace pregrasp
