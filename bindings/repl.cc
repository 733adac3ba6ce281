#include "bindings/repl.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <vector>

#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/recording/build_info.h"
#include "bindings/help.h"
#include "bindings/line_editor.h"
#include "bindings/protect.h"
#include "bindings/sandbox.h"
#include "bindings/show.h"
#include "bindings/typed_text.h"

namespace pregrasp {
namespace {

constexpr int kPipeWidth = 160;  // of tables, where there is no terminal [characters]

// Whether a syntax error says that the text only needs to go on.
bool IsUnfinished(const std::string& message) {
  const std::string mark = "<eof>";
  return message.size() >= mark.size() &&
         message.compare(message.size() - mark.size(), mark.size(), mark) == 0;
}

// Prints its arguments as values. Upvalue 1: the width.
int ShowResults(lua_State* L) {
  return Protect(L, [L] {
    const int count = lua_gettop(L);
    const auto width = static_cast<int>(lua_tointeger(L, lua_upvalueindex(1)));
    for (int i = 1; i <= count; ++i) {
      const std::string text = ShowValue(L, i, width) + '\n';
      std::fwrite(text.data(), 1, text.size(), stdout);
    }
    std::fflush(stdout);
    return 0;
  });
}

// print at the prompt: tables and our values as an expression shows them. Upvalue 1: the width.
int PrintValues(lua_State* L) {
  return Protect(L, [L] {
    const int count = lua_gettop(L);
    const auto width = static_cast<int>(lua_tointeger(L, lua_upvalueindex(1)));
    std::vector<std::string> texts;
    bool lines = false;
    for (int i = 1; i <= count; ++i) {
      if (lua_istable(L, i) || lua_isuserdata(L, i)) {
        texts.push_back(ShowValue(L, i, width));
      } else {
        PushText(L, i);
        std::size_t size = 0;
        const char* text = lua_tolstring(L, -1, &size);
        texts.emplace_back(text, size);
        lua_pop(L, 1);
      }
      lines = lines || texts.back().find('\n') != std::string::npos;
    }
    const std::string text = fmt::format("{}\n", fmt::join(texts, lines ? "\n" : "\t"));
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
    return 0;
  });
}

class Repl {
 public:
  explicit Repl(const ScriptConfig& config);

  void OpenScene(const std::filesystem::path& scene);
  void ReadAll();
  void Finish(const std::optional<std::string>& status) { script_.FinishRecordings(status); }
  void FinishFailed(const std::string& error) { script_.FinishFailedRecordings(error); }

 private:
  void Greet() const;
  std::optional<std::string> ReadLine(bool first);
  bool ReadPiece();
  bool TryLoad(const std::string& text);
  void Evaluate();
  void Report(const std::string& message);
  lua_State* L() { return script_.machine().state(); }

  ScriptMachine script_;
  std::unique_ptr<LineEditor> editor_;  // null from a pipe
  std::string session_;                 // what the scene's session is called when greeting
  int line_ = 0;                        // lines read
};

Repl::Repl(const ScriptConfig& config) : script_(config) {
  if (isatty(STDIN_FILENO) != 0) {
    editor_ = std::make_unique<LineEditor>(HistoryFile(), [this](const std::string& line) {
      return CompleteLine(script_.machine(), line);
    });
  }
  script_.machine().PushTypedEnvironment(L());
  lua_pushcfunction(L(), PrintHelp);
  lua_setfield(L(), -2, "help");
  lua_pushinteger(L(), editor_ ? editor_->width() : kPipeWidth);
  lua_pushcclosure(L(), PrintValues, 1);
  lua_setfield(L(), -2, "print");
  lua_pop(L(), 1);
  script_.machine().LoadTyped("pg = require 'pregrasp'", 1);
  script_.machine().Call(0, 0);
}

void Repl::OpenScene(const std::filesystem::path& scene) {
  script_.machine().LoadTyped("s = pg.open(...) return tostring(s)", 1);
  lua_pushstring(L(), scene.c_str());
  try {
    script_.machine().Call(1, 1);
  } catch (const InputError& error) {
    const std::string message = error.what(), caller = "stdin:1: open: ";
    throw InputError(message.rfind(caller, 0) == 0 ? message.substr(caller.size()) : message);
  }
  session_ = lua_tostring(L(), -1);
  lua_pop(L(), 1);
}

void Repl::Greet() const {
  fmt::print("pregrasp {}, {}: help() for help, Tab completes, Ctrl-D ends\n", ProgramVersion(),
             LUA_RELEASE);
  if (!session_.empty()) fmt::print("s = {}\n", session_);
  std::fflush(stdout);
}

std::optional<std::string> Repl::ReadLine(bool first) {
  ++line_;
  if (editor_) return editor_->Read(first ? "> " : ">> ");
  std::string line;
  const bool read = static_cast<bool>(std::getline(std::cin, line));
  ThrowIfInterrupted();
  return read ? std::optional(line) : std::nullopt;
}

// Leaves the chunk on the stack if the text is complete. @throws InputError if more cannot mend it.
bool Repl::TryLoad(const std::string& text) {
  Machine& machine = script_.machine();
  const int first = line_ - static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  try {
    machine.LoadTyped("return " + text, first);
    const std::vector<LuaToken> tokens = SplitLua(text);
    if (tokens.empty()) return true;  // blanks and comments
    lua_pop(L(), 1);
    // Not `return f()`, a tail call, which would be missing from tracebacks.
    const std::size_t end = tokens.back().begin + tokens.back().text.size();
    machine.LoadTyped("(...)(" + text.substr(0, end) + ")", first);
    return true;
  } catch (const InputError&) {
    // no expression
  }
  try {
    machine.LoadTyped(KeepLocals(text), first);
    return true;
  } catch (const InputError& error) {
    if (!IsUnfinished(error.what())) throw;
    return false;
  }
}

// Reads lines until they are a chunk, and leaves it on the stack; false at the end of the input.
bool Repl::ReadPiece() {
  std::string text;
  PieceDepth depth;
  for (;;) {
    const std::optional<std::string> line = ReadLine(text.empty());
    if (!line) {
      if (text.empty()) return false;
      --line_;
      const bool whole = TryLoad(text);  // or says what is wrong in it
      ++line_;
      if (whole) return true;
      throw InputError(fmt::format("stdin:{}: the input ends within a statement", line_ - 1));
    }
    if (!text.empty()) text += '\n';
    text += *line;
    // At a terminal a mistake is told at once.
    const bool may_be_whole = depth.MayBeWhole(*line);
    if ((editor_ || may_be_whole) && TryLoad(text)) return true;
  }
}

// Runs the chunk on the stack. An expression is one that calls its argument with its values.
void Repl::Evaluate() {
  lua_pushinteger(L(), editor_ ? editor_->width() : kPipeWidth);
  lua_pushcclosure(L(), ShowResults, 1);
  script_.machine().Call(1, 0);
}

void Repl::Report(const std::string& message) {
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", OneLine(message).c_str());
  const std::vector<std::string>& traceback = script_.machine().traceback();
  if (traceback.size() < 2) return;
  for (const std::string& line : traceback) std::fprintf(stderr, "    %s\n", line.c_str());
}

void Repl::ReadAll() {
  if (editor_) Greet();
  for (;;) {
    bool running = false;
    try {
      if (!ReadPiece()) return;
      running = true;
      Evaluate();
    } catch (const InputError& error) {
      if (!editor_) throw;
      Report(error.what());
    } catch (const Interrupted&) {
      if (!editor_ || TerminationRequested()) throw;
      ClearInterrupt();
      if (running) std::fputs("\ninterrupted\n", stderr);
    }
  }
}

}  // namespace

void RunRepl(const std::optional<std::filesystem::path>& scene, const ScriptConfig& config) {
  LeaveNothingOnFailure(config, [&] {
    Repl repl(config);
    try {
      if (scene) repl.OpenScene(*scene);
      repl.ReadAll();
      repl.Finish(std::nullopt);
    } catch (const Interrupted&) {
      ClearInterrupt();
      repl.Finish("interrupted");
      throw;
    } catch (const InputError& error) {
      repl.FinishFailed(error.what());
      throw;
    }
  });
}

}  // namespace pregrasp
