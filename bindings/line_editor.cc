#include "bindings/line_editor.h"

#include <histedit.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cwchar>

#include "app/core/interrupt.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kHistorySize = 1000;

// What Ctrl-D gives. Typed ahead, before the terminal is in raw mode, it comes as a zero byte.
constexpr wchar_t kEndOfInput = 4;

// Waits until stdin can be read; false when a signal asks to stop. The signals are let in only
// while waiting, so that none is missed between the look at the flag and the wait.
bool WaitForInput() {
  sigset_t stops, before;
  sigemptyset(&stops);
  sigaddset(&stops, SIGINT);
  sigaddset(&stops, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stops, &before);
  pollfd input = {STDIN_FILENO, POLLIN, 0};
  int ready = 0;
  while (!InterruptRequested() && ready <= 0) {
    ready = ppoll(&input, 1, nullptr, &before);
    if (ready < 0 && errno != EINTR) break;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return !InterruptRequested();
}

// libedit's own reader goes on waiting after a signal.
int ReadCharacter(EditLine* /*editor*/, wchar_t* character) {
  std::mbstate_t state{};
  for (;;) {
    if (!WaitForInput()) {
      errno = EINTR;
      return -1;
    }
    char byte = 0;
    const ssize_t count = read(STDIN_FILENO, &byte, 1);
    if (count <= 0) return static_cast<int>(count);
    const std::size_t used = std::mbrtowc(character, &byte, 1, &state);
    if (used == 0) *character = kEndOfInput;
    if (used == 0) return 1;
    if (used == static_cast<std::size_t>(-2)) continue;
    if (used == static_cast<std::size_t>(-1)) {
      state = {};
      continue;  // not of this encoding: as if it had not been typed
    }
    return 1;
  }
}

std::string CommonStart(const std::vector<std::string>& words) {
  std::string start = words.front();
  for (const std::string& word : words) {
    const auto differ = std::mismatch(start.begin(), start.end(), word.begin(), word.end());
    start.erase(differ.first, start.end());
  }
  return start;
}

}  // namespace

struct LineEditor::Impl {
  EditLine* editor = nullptr;
  History* history = nullptr;
  HistEvent event{};
  fs::path file;
  Completer completer;
  std::string prompt;

  static Impl& Of(EditLine* editor) {
    void* self = nullptr;
    el_get(editor, EL_CLIENTDATA, &self);
    return *static_cast<Impl*>(self);
  }
  static char* Prompt(EditLine* editor) { return Of(editor).prompt.data(); }
  static unsigned char CompleteKey(EditLine* editor, int key);
  void List(const std::vector<std::string>& words) const;
};

unsigned char LineEditor::Impl::CompleteKey(EditLine* editor, int /*key*/) {
  const LineInfo* line = el_line(editor);
  const std::string before(line->buffer, line->cursor);
  if (before.find_first_not_of(' ') == std::string::npos) {
    return el_insertstr(editor, "  ") == 0 ? CC_REFRESH : CC_ERROR;
  }
  const Impl& self = Of(editor);
  const Completion completion = self.completer(before);
  if (completion.words.empty()) return CC_ERROR;
  const std::string start = CommonStart(completion.words);
  const std::size_t typed = before.size() - completion.begin;
  if (start.size() > typed) {
    return el_insertstr(editor, start.c_str() + typed) == 0 ? CC_REFRESH : CC_ERROR;
  }
  if (completion.words.size() == 1) return CC_NORM;
  self.List(completion.words);
  return CC_REDISPLAY;
}

void LineEditor::Impl::List(const std::vector<std::string>& words) const {
  std::size_t widest = 0;
  for (const std::string& word : words) widest = std::max(widest, word.size());
  const std::size_t columns = std::max<std::size_t>(1, 80 / (widest + 2));
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool last = (i + 1) % columns == 0 || i + 1 == words.size();
    std::printf("%s%-*s%s", i == 0 ? "\n" : "", last ? 0 : static_cast<int>(widest + 2),
                words[i].c_str(), last ? "\n" : "");
  }
  std::fflush(stdout);
}

LineEditor::LineEditor(const fs::path& history, Completer completer)
    : impl_(std::make_unique<Impl>()) {
  std::setlocale(LC_CTYPE, "");  // for what is typed; numbers stay as they are
  impl_->completer = std::move(completer);
  impl_->file = history;
  impl_->editor = el_init("pregrasp", stdin, stdout, stderr);
  impl_->history = history_init();
  EditLine* editor = impl_->editor;
  el_set(editor, EL_CLIENTDATA, impl_.get());
  el_set(editor, EL_PROMPT, Impl::Prompt);
  el_set(editor, EL_EDITOR, "emacs");
  el_set(editor, EL_GETCFN, ReadCharacter);
  el_set(editor, EL_HIST, ::history, impl_->history);
  el_set(editor, EL_ADDFN, "complete", "Complete the word", Impl::CompleteKey);
  el_set(editor, EL_BIND, "^I", "complete", nullptr);
  el_set(editor, EL_BIND, "^R", "em-inc-search-prev", nullptr);
  ::history(impl_->history, &impl_->event, H_SETSIZE, kHistorySize);
  ::history(impl_->history, &impl_->event, H_SETUNIQUE, 1);
  if (!history.empty()) ::history(impl_->history, &impl_->event, H_LOAD, history.c_str());
}

LineEditor::~LineEditor() {
  if (!impl_->file.empty()) {
    std::error_code ignored;
    fs::create_directories(impl_->file.parent_path(), ignored);
    ::history(impl_->history, &impl_->event, H_SAVE, impl_->file.c_str());
  }
  history_end(impl_->history);
  el_end(impl_->editor);
}

std::optional<std::string> LineEditor::Read(const std::string& prompt) {
  impl_->prompt = prompt;
  el_resize(impl_->editor);
  int count = 0;
  const char* line = el_gets(impl_->editor, &count);
  if (line == nullptr || count <= 0) {
    std::fputs(InterruptRequested() ? "^C\n" : "\n", stdout);
    el_reset(impl_->editor);
    ThrowIfInterrupted();
    return std::nullopt;
  }
  std::string text(line, static_cast<std::size_t>(count));
  if (text.back() == '\n') text.pop_back();
  if (text.find_first_not_of(" \t") != std::string::npos) {
    ::history(impl_->history, &impl_->event, H_ENTER, text.c_str());
  }
  return text;
}

int LineEditor::width() const {
  winsize size{};
  constexpr int kUsual = 80;
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

fs::path HistoryFile() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state != '\0') return fs::path(state) / "pregrasp_history";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return fs::path(home) / ".local/state/pregrasp_history";
}

}  // namespace pregrasp
