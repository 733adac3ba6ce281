#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/core/lua_api.h"
#include "app/core/memory_claim.h"
#include "bindings/file_access.h"

namespace pregrasp {

struct MachineConfig {
  double seconds = 20.0;              ///< Lua time of this thread's CPU, our own calls not counted
  std::size_t bytes = 512ULL << 20U;  ///< cap on what Lua allocates and the script's objects hold
  std::uint64_t seed = 1;             ///< of math.random
  /// What raises the time limit, for the message; empty when nothing does.
  std::string time_flag = "--time";

  void Validate() const;
};

/// One Lua world: a state with the sandboxed libraries, a memory cap, a time cap that no pcall and
/// no coroutine can swallow, and a fresh environment for each chunk. What the sandbox closes is
/// listed in bindings/README.md, each with its test.
class Machine {
 public:
  static constexpr std::size_t kMaxString = 16U << 20U;  ///< [bytes], of one string
  static constexpr std::size_t kMaxSource = 16U << 20U;  ///< [bytes], of one Lua file

  explicit Machine(const MachineConfig& config);
  ~Machine();
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  lua_State* state() const { return L_; }
  const MachineConfig& config() const { return config_; }
  FileAccess& files() { return files_; }
  static Machine& Of(lua_State* L);

  /// Loads a text chunk in a fresh environment and leaves it as a function on the stack of L. The
  /// first file's folder becomes readable, and modules are looked for there.
  /// @throws InputError naming `file`: unreadable, not text, a syntax error.
  void LoadFile(lua_State* L, const std::filesystem::path& file);
  const std::filesystem::path& script_folder() const { return script_folder_; }

  /// Loads text from a prompt as a chunk named "stdin" and leaves it on the stack of state(). All
  /// such text shares one environment. @param line  that its first line is, from 1.
  /// @throws InputError for a syntax error; its text ends with "<eof>" when more lines may mend it.
  void LoadTyped(const std::string& text, int line);
  /// Pushes the environment that typed text shares.
  void PushTypedEnvironment(lua_State* L);

  /// Calls the function that lies below its `arguments` on the stack of state(). A call that failed
  /// or was interrupted leaves the machine fit for the next one, with its whole time.
  /// @throws InputError with one line that has file:line where there is one; Interrupted;
  /// InternalError.
  void Call(int arguments, int results);

  /// Where the last failure of Call was, innermost first: "file:line, in NAME".
  const std::vector<std::string>& traceback() const { return traceback_; }

  /// Raises the Lua error that ends the script if it is out of time or was interrupted.
  void CheckTime(lua_State* L);

  /// Ends the script: the error is raised again at every further instruction, whatever catches it.
  enum class StopReason { kNone, kTime, kInterrupt, kInternal };
  void Stop(lua_State* L, StopReason reason, const std::string& message);
  void RaiseIfStopped(lua_State* L);
  bool stopped() const { return stop_reason_ != StopReason::kNone; }

  /// The words for a script that ran into the memory cap.
  std::string MemoryMessage() const;

  /// Where memory of ours that the script's objects hold is counted (MemoryClaim): it counts toward
  /// the cap like Lua's own.
  const MemoryClaim::Meter& outside() const { return outside_; }
  /// @throws std::bad_alloc if so many bytes more do not fit under the cap, even after a full
  /// collection.
  void RequireMemory(lua_State* L, std::size_t bytes);

  /// Raises the error that ends the script if Ctrl-C was pressed: for our own calls, between which
  /// a loop may run few instructions.
  void RaiseIfInterrupted(lua_State* L);

  /// While alive, `co` is the coroutine that runs.
  class Running {
   public:
    explicit Running(lua_State* co)
        : machine_(Machine::Of(co)), before_(std::exchange(machine_.running_state_, co)) {
      machine_.WatchLongStrings();
    }
    ~Running() {
      machine_.running_state_ = before_;
      machine_.WatchLongStrings();
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    Machine& machine_;
    lua_State* before_;
  };

  /// While alive, time is not counted: our own calls may take as long as they need.
  class Pause {
   public:
    explicit Pause(lua_State* L);
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

   private:
    Machine& machine_;
  };

  /// While alive within a pause, time is the script's again: it is called back.
  class Resume {
   public:
    explicit Resume(lua_State* L);
    ~Resume();
    Resume(const Resume&) = delete;
    Resume& operator=(const Resume&) = delete;

   private:
    Machine& machine_;
    int pauses_;
  };

 private:
  static void* Allocate(void* self, void* block, std::size_t old_size, std::size_t new_size);
  static void OnHook(lua_State* L, lua_Debug* activation);
  static int HandleMessage(lua_State* L);
  bool Fits(std::size_t bytes) const;
  void WatchLongStrings();
  double LuaSeconds();
  void BeginPause();
  void EndPause();
  std::string TimeMessage() const;
  std::string WithFullNames(std::string message) const;
  [[noreturn]] void ThrowLuaError(int status);

  MachineConfig config_;
  FileAccess files_;
  lua_State* L_ = nullptr;
  std::size_t used_ = 0;
  MemoryClaim::Meter outside_ = std::make_shared<std::size_t>(0);
  std::set<const void*> long_strings_;
  lua_State* running_state_ = nullptr;  // of the coroutine that runs
  bool running_ = false;
  StopReason stop_reason_ = StopReason::kNone;
  std::string stop_message_;
  double start_ = 0.0, read_ = 0.0, paused_ = 0.0;  // [s] of the thread's CPU; read_ is the latest
  double paused_since_ = 0.0;                       // [s] of the wall's clock
  int pauses_ = 0;
  int typed_environment_ = LUA_NOREF;
  std::vector<std::string> traceback_;
  std::filesystem::path script_folder_;
  std::string first_file_;
  std::string memory_where_;                       // of the last allocation that was refused
  std::map<std::string, std::string> full_names_;  // from the name that Lua shortened
};

/// A claim of so many bytes on the script's memory. @throws std::bad_alloc beyond its cap.
MemoryClaim ClaimMemory(lua_State* L, std::size_t bytes);

/// "file:line" of the innermost Lua function that is running, or "".
std::string WhereInLua(lua_State* L);

}  // namespace pregrasp
