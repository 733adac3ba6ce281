#pragma once

#include <string>
#include <variant>
#include <vector>

#include "app/job/command.h"
#include "app/job/graph_facts.h"
#include "app/job/grasp_facts.h"
#include "app/job/motion_facts.h"
#include "app/job/scene_facts.h"
#include "app/job/trajectory_facts.h"

namespace pregrasp {

// Everything that a picture, a log record, a table, a sentence or a Lua value of a step shows, as
// plain data. Each struct names its fields once, in VisitFields(self, visit), which calls
// visit(name, member) for each: the JSON of steps.jsonl, its reader and the comparison of two runs
// follow from that (facts_json.h). SI units and radians, but where a name says otherwise. Frames as
// everywhere: W world, O object, B body, H palm, C contact.

/// One alternative for each kind of step; which one follows from the command's verb.
using StepDetails = std::variant<OpenFacts, SettleFacts, VerdictFacts, MeshFacts, ScoreFacts,
                                 PruneFacts, PathFacts, ScreenFacts, IterationFacts, CertifyFacts,
                                 GraspFacts, LiftFacts, FrameFacts, MotionFacts, SimulationFacts>;

/// One step: the unit of steps.jsonl, of run.rawlog and of the pictures, all under one id.
struct StepFacts {                // NOLINT(bugprone-exception-escape): moving JSON does not throw
  std::string id;                 ///< unique in a job
  Command command;                ///< what made it, and from which step
  double t = 0.0;                 ///< simulated time [s]
  std::vector<BodyFacts> bodies;  ///< the movable ones, the object first
  std::vector<FingerFacts> fingers;  ///< all of the hand
  std::vector<ContactFacts> contacts;
  StepDetails details;

  /// "scene", "graph", "paths", "path", "motion" or "sim": the first word of the id.
  std::string stage() const { return id.substr(0, id.find('.')); }
  const BodyFacts& object() const { return bodies.front(); }
};

/// The details that a step of `verb` has, empty.
StepDetails MakeDetails(Verb verb);

/// Finds the facts of an earlier step by its id. @throws InputError if there is none.
class FactsSource {
 public:
  virtual ~FactsSource() = default;
  virtual const StepFacts& Get(const std::string& id) const = 0;

  /// The nearest step with details of type T among `step` and the steps that led to it; null if
  /// none.
  template <typename T>
  const T* FindBefore(const StepFacts& step) const {
    const StepFacts* at = &step;
    while (true) {
      if (const T* found = std::get_if<T>(&at->details)) return found;
      if (at->command.node.empty()) return nullptr;
      at = &Get(at->command.node);
    }
  }
};

}  // namespace pregrasp
