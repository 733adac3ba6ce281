#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace pregrasp {

/// What can be done to a job: one entry a kind of step.
enum class Verb {
  kOpen,      ///< the scene at its start; the root of every timeline
  kSettle,    ///< let the start alone {seconds}; what follows begins where that ends
  kVerdict,   ///< can the object be grasped where it stands?
  kMesh,      ///< the contact mesh, as an unscored graph
  kScore,     ///< the nodes' scores
  kPrune,     ///< the next pruning step {nodes: at most so many}
  kPath,      ///< the path of {rank}
  kScreen,    ///< the next round of a few iterations that tell what a path is worth
  kIterate,   ///< one iteration of MPPI
  kCertify,   ///< the best plan, or {plan}, through Simbody, and the release
  kGrasp,     ///< the next generated grasp, tested
  kLift,      ///< the simulated lift of grasp {grasp}
  kKeyframe,  ///< the next keyframe of the motion that ends in grasp {grasp}
  kFill,      ///< the frames between the keyframes
  kSmooth,    ///< the smoothing, timing and checking of the motion
  kFrame,     ///< frame {frame} of the finished motion, as it is
  kTouch,     ///< put {finger} on the object at {p_OC}
  kLetGo,     ///< take {finger} off
  kMove,      ///< move {finger}'s target to {p_WTarget} in {seconds}
  kWait,      ///< physics for {seconds}, or {steps}
};
/// "open", "settle", ..: the word of journal.jsonl.
const char* VerbName(Verb verb);

/// One decision: a verb, its options and the step it acts on. What a job comes to is a function of
/// its setup and its commands alone.
struct Command {  // NOLINT(bugprone-exception-escape): moving JSON does not throw
  Verb verb = Verb::kOpen;
  std::string node;  ///< the id of the step that it acts on; empty for kOpen
  /// What the table in app/job/README.md lists for the verb, and `settings`: the fields of the
  /// planner's configuration that change here and for what follows, by full name.
  nlohmann::json options = nlohmann::json::object();

  bool operator==(const Command& other) const {
    return verb == other.verb && node == other.node && options == other.options;
  }
};

/// {"verb", "node", "options"}.
nlohmann::ordered_json CommandToJson(const Command& command);
/// @param where  for messages. @throws InputError for anything CommandToJson does not write.
Command CommandFromJson(const nlohmann::json& value, const std::string& where);

/// Reads options. Every function throws InputError naming the option.
class CommandOptions {
 public:
  explicit CommandOptions(const Command& command) : options_(command.options) {}

  bool Has(const char* name) const { return options_.contains(name); }
  int Int(const char* name) const;
  double Number(const char* name) const;
  std::string Text(const char* name) const;
  const nlohmann::json& Get(const char* name) const;

 private:
  const nlohmann::json& options_;
};

}  // namespace pregrasp
