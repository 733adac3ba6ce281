#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session/session.h"
#include "bindings/machine.h"
#include "bindings/schema.h"

namespace pregrasp {

/// What the command line gives to a script.
struct ScriptConfig {
  MachineConfig machine;
  int threads = 0;
  std::optional<PictureMode> pictures;
  std::filesystem::path output = "out";
  std::filesystem::path weights;  ///< of the networks; empty for the program's own
  std::string remake;             ///< the command line itself, for the footer of pictures
};

/// Of the networks' weights.
std::filesystem::path WeightsFolder(const ScriptConfig& config);

/// Runs a Lua script. Recordings that are open at its end are finished; when it was interrupted,
/// they are finished with status "interrupted"; when it failed, with status "failed" and its error.
/// @throws InputError with one line; Interrupted; InternalError.
void RunScript(const std::filesystem::path& file, const std::vector<std::string>& arguments,
               const ScriptConfig& config);

/// What our calls need to know of the script that they are made from.
struct ScriptContext {
  ScriptConfig config;
  /// Held until the end of the script, so that a recording is finished even if the script lets go
  /// of its session.
  std::vector<std::shared_ptr<Session>> recording;
  /// What break_when set, by session.
  struct BreakPoint {
    std::weak_ptr<Session> session;
    int reference = LUA_NOREF;  ///< of the function, in the registry
    std::vector<std::string> conditions;
  };
  /// Where break_when last said yes.
  struct Stop {
    std::weak_ptr<Session> session;
    std::string by;  ///< a condition, or "function"
    std::string step_id, text;
    double t = 0.0;
    int num_steps = 0;  ///< physics steps, of a simulation or a certificate
  };
  std::map<const Session*, Stop> stops;
  std::map<const Session*, BreakPoint> predicates;
  /// Whose functions are being asked now, innermost last.
  std::vector<const Session*> asking;

  static ScriptContext& Of(lua_State* L);
};

/// A machine in which `require "pregrasp"` works, allowed the files that a script may touch.
class ScriptMachine {
 public:
  explicit ScriptMachine(const ScriptConfig& config);

  Machine& machine() { return machine_; }

  /// Ends the recordings that are open. @param status, error  as Session::FinishRecording.
  void FinishRecordings(const std::optional<std::string>& status, const std::string& error = "");
  /// The same with status "failed" after an error, as far as it can be done.
  void FinishFailedRecordings(const std::string& error);

 private:
  ScriptContext context_;  // outlives the machine
  Machine machine_;
};

/// Runs `body`, which writes below config.output: when it throws and nothing was written, the
/// folder is gone again too.
void LeaveNothingOnFailure(const ScriptConfig& config, const std::function<void()>& body);

/// All that is registered, by the names that scripts see; lua/meta is held against it.
struct Api {
  const Schema* module = nullptr;  ///< the fields of `require "pregrasp"`
  std::vector<const FunctionInfo*> functions;
  std::vector<const ClassInfo*> classes;
  std::vector<const Schema*> schemas;
};
const Api& GetApi();

}  // namespace pregrasp
