#include "bindings/machine.h"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <new>
#include <utility>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "bindings/protect.h"
#include "bindings/sandbox.h"

namespace pregrasp {
namespace {

constexpr int kHookInstructions = 200;  // one string operation may take milliseconds
// A string of this size takes longer than 200 small ones, to compare above all: while there is one,
// the hook comes at every other instruction.
constexpr std::size_t kLongString = 256U << 10U;
constexpr int kHookWithLongStrings = 2;

double ThreadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Needs no system call, as the thread's CPU time does: that takes as long as a short call of ours.
double WallSeconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double CoarseSeconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Typed text that begins beyond this line is a chunk "stdin+5000", whose own lines count from
// there: a newline for each line before it would be read again with every piece.
constexpr int kTypedBlock = 1000;

// "stdin+5000:12" as "stdin:5012".
std::string JoinTypedLines(std::string text) {
  const std::string mark = "stdin+";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t block = at + mark.size();
    std::size_t colon = block, end = 0;
    while (colon < text.size() && std::isdigit(static_cast<unsigned char>(text[colon]))) ++colon;
    if (colon == block || colon - block > 9 || colon >= text.size() || text[colon] != ':') continue;
    for (end = colon + 1; end < text.size() && end - colon < 8; ++end) {
      if (!std::isdigit(static_cast<unsigned char>(text[end]))) break;
    }
    if (end == colon + 1) continue;
    const int line = std::stoi(text.substr(block, colon - block)) +
                     std::stoi(text.substr(colon + 1, end - colon - 1));
    text.replace(at, end - at, "stdin:" + std::to_string(line));
  }
  return text;
}

// The Lua functions that are running, innermost first, at most so many.
std::vector<std::string> TraceLua(lua_State* L) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> lines;
  lua_Debug info{};
  for (int level = 0; lua_getstack(L, level, &info) != 0; ++level) {
    lua_getinfo(L, "Sln", &info);
    if (info.currentline <= 0) continue;
    if (lines.size() == kMost) {
      lines.emplace_back("..");
      break;
    }
    std::string line = std::string(info.short_src) + ":" + std::to_string(info.currentline);
    if (info.name != nullptr) line += std::string(", in ") + info.name;
    lines.push_back(JoinTypedLines(std::move(line)));
  }
  return lines;
}

// "name:12:" at the front, as Lua and WhereInLua write it.
bool StartsWithPosition(const std::string& message) {
  for (std::size_t i = message.find(':'); i != std::string::npos; i = message.find(':', i + 1)) {
    std::size_t digits = i + 1;
    while (digits < message.size() && std::isdigit(static_cast<unsigned char>(message[digits]))) {
      ++digits;
    }
    if (digits > i + 1 && digits < message.size() && message[digits] == ':') return true;
    if (message.find(' ') < i) return false;
  }
  return false;
}

}  // namespace

void MachineConfig::Validate() const {
  if (!(std::isfinite(seconds) && seconds > 0.0)) {
    throw InputError("--time", "", "seconds above 0", FormatDouble(seconds));
  }
}

Machine& Machine::Of(lua_State* L) { return **static_cast<Machine**>(lua_getextraspace(L)); }

Machine::Machine(const MachineConfig& config) : config_(config) {
  config.Validate();
  L_ = lua_newstate(Allocate, this);
  if (L_ == nullptr) throw std::bad_alloc();
  running_state_ = L_;
  *static_cast<Machine**>(lua_getextraspace(L_)) = this;
  OpenSandbox(L_);
}

Machine::~Machine() { lua_close(L_); }

void* Machine::Allocate(void* self, void* block, std::size_t old_size, std::size_t new_size) {
  auto* machine = static_cast<Machine*>(self);
  const std::size_t old_bytes = block == nullptr ? 0 : old_size;
  if (new_size == 0) {
    machine->used_ -= old_bytes;
    if (old_bytes > kLongString) machine->long_strings_.erase(block);
    std::free(block);
    return nullptr;
  }
  if (new_size > old_bytes) {
    // For a new block, the size that comes in is the kind of object.
    const bool string = block == nullptr && old_size == LUA_TSTRING;
    if (!machine->Fits(new_size - old_bytes) || (string && new_size > kMaxString + 64)) {
      // No message handler runs for this error: remember where it began. Reading the line allocates
      // nothing in Lua.
      machine->memory_where_ = WhereInLua(machine->L_);
      return nullptr;
    }
    // The hook does not run within a string operation: many long ones are stopped here.
    if (new_size > 65536 && machine->running_ && machine->pauses_ == 0 &&
        (machine->stopped() || machine->LuaSeconds() > machine->config_.seconds)) {
      if (!machine->stopped()) {
        machine->stop_reason_ = StopReason::kTime;
        machine->stop_message_ = machine->first_file_ + ": " + machine->TimeMessage();
      }
      return nullptr;
    }
  }
  void* result = std::realloc(block, new_size);
  if (result == nullptr) return nullptr;
  machine->used_ += new_size - old_bytes;
  if (block == nullptr && old_size == LUA_TSTRING && new_size > kLongString) {
    machine->long_strings_.insert(result);
    machine->WatchLongStrings();
  }
  return result;
}

bool Machine::Fits(std::size_t bytes) const { return used_ + *outside_ + bytes <= config_.bytes; }

void Machine::RequireMemory(lua_State* L, std::size_t bytes) {
  if (!Fits(bytes)) lua_gc(L, LUA_GCCOLLECT);
  if (!Fits(bytes)) throw std::bad_alloc();
}

MemoryClaim ClaimMemory(lua_State* L, std::size_t bytes) {
  Machine& machine = Machine::Of(L);
  machine.RequireMemory(L, bytes);
  return MemoryClaim(machine.outside(), bytes);
}

// Coroutines have hooks of their own, which they begin with as those are where they are made.
void Machine::WatchLongStrings() {
  if (!running_ || stopped() || running_state_ == nullptr) return;
  const int count = long_strings_.empty() ? kHookInstructions : kHookWithLongStrings;
  if (lua_gethookcount(running_state_) == count) return;
  lua_sethook(running_state_, OnHook, LUA_MASKCOUNT, count);
}

void Machine::RaiseIfInterrupted(lua_State* L) {
  if (!InterruptRequested()) return;
  if (!stopped()) Stop(L, StopReason::kInterrupt, "interrupted");
  RaiseIfStopped(L);
}

double Machine::LuaSeconds() {
  if (pauses_ == 0) read_ = ThreadSeconds();
  return read_ - start_ - paused_;
}

void Machine::BeginPause() { paused_since_ = WallSeconds(); }

// A pause is as long as the wall says where it is short, and never longer than the CPU time since
// that was read last: while the thread waits, none passes.
void Machine::EndPause() {
  constexpr double kShort = 5e-5;  // [s]
  double seconds = WallSeconds() - paused_since_;
  if (seconds > kShort) {
    const double now = ThreadSeconds();
    seconds = std::min(seconds, now - read_);
    read_ = now;
  }
  paused_ += seconds;
}

Machine::Pause::Pause(lua_State* L) : machine_(Machine::Of(L)) {
  if (machine_.pauses_++ == 0) machine_.BeginPause();
}

Machine::Pause::~Pause() {
  if (--machine_.pauses_ == 0) machine_.EndPause();
}

Machine::Resume::Resume(lua_State* L)
    : machine_(Machine::Of(L)), pauses_(std::exchange(machine_.pauses_, 0)) {
  if (pauses_ > 0) machine_.EndPause();
}

Machine::Resume::~Resume() {
  machine_.pauses_ = pauses_;
  if (pauses_ > 0) machine_.BeginPause();
}

void Machine::Stop(lua_State* L, StopReason reason, const std::string& message) {
  if (stop_reason_ == StopReason::kNone) {
    stop_reason_ = reason;
    stop_message_ = message;
  }
  lua_sethook(L, OnHook, LUA_MASKCOUNT, 1);
  lua_sethook(L_, OnHook, LUA_MASKCOUNT, 1);
}

std::string Machine::TimeMessage() const {
  return "out of time after " + FormatDouble(config_.seconds) + " s of Lua" +
         (config_.time_flag.empty() ? "" : " (" + config_.time_flag + " gives it more)");
}

std::string Machine::MemoryMessage() const {
  return "not enough memory: a script has " + std::to_string(config_.bytes >> 20U) +
         " MB, a string " + std::to_string(kMaxString >> 20U) + " MB";
}

void Machine::RaiseIfStopped(lua_State* L) {
  if (!stopped()) return;
  lua_sethook(L, OnHook, LUA_MASKCOUNT, 1);  // of this coroutine, should it catch the error
  lua_pushlstring(L, stop_message_.data(), stop_message_.size());
  lua_error(L);
}

void Machine::CheckTime(lua_State* L) {
  if (!stopped()) {
    if (InterruptRequested()) {
      Stop(L, StopReason::kInterrupt, "interrupted");
    } else if (pauses_ == 0 && LuaSeconds() > config_.seconds) {
      const std::string where = WhereInLua(L);
      Stop(L, StopReason::kTime, (where.empty() ? first_file_ : where) + ": " + TimeMessage());
    }
  }
  RaiseIfStopped(L);
}

void Machine::OnHook(lua_State* L, lua_Debug* /*activation*/) {
  Machine& machine = Of(L);
  // Reading the CPU's clock is a system call: ask the cheap clock whether it may have moved.
  static thread_local double last = 0.0;
  const double now = CoarseSeconds();
  if (machine.stop_reason_ == StopReason::kNone && now == last && !InterruptRequested()) return;
  last = now;
  machine.CheckTime(L);
  machine.WatchLongStrings();
}

int Machine::HandleMessage(lua_State* L) {
  Of(L).traceback_ = TraceLua(L);
  std::string message;
  if (lua_type(L, 1) == LUA_TSTRING || luaL_getmetafield(L, 1, "__tostring") != LUA_TNIL) {
    lua_settop(L, 1);
    message = luaL_tolstring(L, 1, nullptr);
  } else {
    message = std::string("an error whose value is a ") + luaL_typename(L, 1);
  }
  if (!StartsWithPosition(message)) {
    const std::string where = WhereInLua(L);
    if (!where.empty()) message = where + ": " + message;
  }
  lua_pushlstring(L, message.data(), message.size());
  return 1;
}

std::string Machine::WithFullNames(std::string message) const {
  for (const auto& [shortened, full] : full_names_) {
    for (std::size_t at = message.find(shortened); at != std::string::npos;
         at = message.find(shortened, at + full.size())) {
      message.replace(at, shortened.size(), full);
    }
  }
  return JoinTypedLines(std::move(message));
}

void Machine::ThrowLuaError(int status) {
  std::string message = "an error without a message";
  if (lua_type(L_, -1) == LUA_TSTRING) message = lua_tostring(L_, -1);
  lua_settop(L_, 0);
  if (status == LUA_ERRMEM) {
    message = (memory_where_.empty() ? first_file_ : memory_where_) + ": " + MemoryMessage();
  } else if (status == LUA_ERRERR) {
    message = first_file_ + ": an error in an error handler";
  }
  throw InputError(WithFullNames(message));
}

void Machine::LoadFile(lua_State* L, const std::filesystem::path& file) {
  const std::string name = file.string();
  if (first_file_.empty()) {
    first_file_ = name;
    script_folder_ = file.parent_path().empty() ? "." : file.parent_path();
    files_.AllowReadsBelow(script_folder_);
  }
  // Lua's messages hold the end of a long name only; WithFullNames puts the rest back.
  constexpr std::size_t kFits = LUA_IDSIZE - 1, kKept = LUA_IDSIZE - 4;
  if (name.size() > kFits) full_names_["..." + name.substr(name.size() - kKept)] = name;
  std::string text = ReadPlainFile(file, kMaxSource);
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
  if (!text.empty() && text[0] == '#') text.insert(0, "--");  // a script that starts with #!
  if (!text.empty() && text[0] == LUA_SIGNATURE[0]) {
    throw InputError(name, "", "Lua as text", "bytecode");
  }
  if (luaL_loadbufferx(L, text.data(), text.size(), ("@" + name).c_str(), "t") != LUA_OK) {
    std::string message = lua_tostring(L, -1);
    lua_pop(L, 1);
    throw InputError(WithFullNames(message));
  }
  PushEnvironment(L);
  lua_setupvalue(L, -2, 1);
}

void Machine::LoadTyped(const std::string& text, int line) {
  if (first_file_.empty()) {
    first_file_ = "stdin";
    script_folder_ = ".";
  }
  const int block = (line - 1) / kTypedBlock * kTypedBlock;
  const std::string name = block == 0 ? "=stdin" : "=stdin+" + std::to_string(block);
  const std::string numbered = std::string(static_cast<std::size_t>(line - 1 - block), '\n') + text;
  if (luaL_loadbufferx(L_, numbered.data(), numbered.size(), name.c_str(), "t") != LUA_OK) {
    std::string message = lua_tostring(L_, -1);
    lua_pop(L_, 1);
    throw InputError(JoinTypedLines(std::move(message)));
  }
  PushTypedEnvironment(L_);
  lua_setupvalue(L_, -2, 1);
}

void Machine::PushTypedEnvironment(lua_State* L) {
  if (typed_environment_ == LUA_NOREF) {
    PushEnvironment(L);
    typed_environment_ = luaL_ref(L, LUA_REGISTRYINDEX);
  }
  lua_rawgeti(L, LUA_REGISTRYINDEX, typed_environment_);
}

void Machine::Call(int arguments, int results) {
  stop_reason_ = StopReason::kNone;
  traceback_.clear();
  const int function = lua_gettop(L_) - arguments;
  lua_pushcfunction(L_, HandleMessage);
  lua_insert(L_, function);
  lua_sethook(L_, OnHook, LUA_MASKCOUNT,
              long_strings_.empty() ? kHookInstructions : kHookWithLongStrings);
  start_ = read_ = ThreadSeconds();
  paused_ = 0.0;
  running_ = true;
  const int status = lua_pcall(L_, arguments, results, function);
  running_ = false;
  lua_sethook(L_, nullptr, 0, 0);
  switch (stop_reason_) {
    case StopReason::kNone:
      break;
    case StopReason::kTime:
      lua_settop(L_, 0);
      throw InputError(WithFullNames(stop_message_));
    case StopReason::kInterrupt:
      lua_settop(L_, 0);
      throw Interrupted();
    case StopReason::kInternal:
      lua_settop(L_, 0);
      throw InternalError(stop_message_);
  }
  if (status != LUA_OK) ThrowLuaError(status);
  lua_remove(L_, function);
}

bool InSameFile(const std::string& message, const std::string& where) {
  const std::size_t file = where.rfind(':') + 1;  // with the colon
  return file < message.size() && message.compare(0, file, where, 0, file) == 0 &&
         std::isdigit(static_cast<unsigned char>(message[file])) != 0;
}

std::string WhereInLua(lua_State* L) {
  lua_Debug info{};
  for (int level = 0; lua_getstack(L, level, &info) != 0; ++level) {
    lua_getinfo(L, "Sl", &info);
    if (info.currentline > 0) {
      const char* source =
          info.source[0] == '@' || info.source[0] == '=' ? info.source + 1 : info.short_src;
      return JoinTypedLines(std::string(source) + ":" + std::to_string(info.currentline));
    }
  }
  return "";
}

}  // namespace pregrasp
