#include "bindings/lua_pattern.h"

#include <cctype>
#include <stdexcept>

namespace pregrasp {
namespace {

using CharSet = std::bitset<256>;

unsigned char Byte(char c) { return static_cast<unsigned char>(c); }

// The class behind %letter: an upper-case letter is the complement, and what is no letter of a
// class stands for itself.
CharSet ClassOf(char letter) {
  CharSet set;
  bool known = true;
  for (int c = 0; c < 256 && known; ++c) {
    bool in = false;
    switch (std::tolower(Byte(letter))) {
      case 'a':
        in = c < 128 && std::isalpha(c);
        break;
      case 'c':
        in = c < 128 && std::iscntrl(c);
        break;
      case 'd':
        in = c < 128 && std::isdigit(c);
        break;
      case 'g':
        in = c < 128 && std::isgraph(c);
        break;
      case 'l':
        in = c < 128 && std::islower(c);
        break;
      case 'p':
        in = c < 128 && std::ispunct(c);
        break;
      case 's':
        in = c < 128 && std::isspace(c);
        break;
      case 'u':
        in = c < 128 && std::isupper(c);
        break;
      case 'w':
        in = c < 128 && std::isalnum(c);
        break;
      case 'x':
        in = c < 128 && std::isxdigit(c);
        break;
      case 'z':
        in = c == 0;
        break;
      default:
        known = false;
    }
    set[c] = in;
  }
  if (!known) {
    set.reset();
    set.set(Byte(letter));
    return set;
  }
  return std::isupper(Byte(letter)) ? ~set : set;
}

// The set [..] that starts at pattern[begin]; `end` becomes the index after its ].
// Returns false if there is no ].
bool ParseSet(std::string_view pattern, std::size_t begin, std::size_t& end, CharSet& set) {
  const std::size_t first =
      begin + (begin + 1 < pattern.size() && pattern[begin + 1] == '^' ? 2 : 1);
  end = first;
  do {  // a ] in the first place stands for itself
    if (end >= pattern.size()) return false;
    if (pattern[end++] == '%' && end < pattern.size()) ++end;
    if (end >= pattern.size()) return false;
  } while (pattern[end] != ']');
  for (std::size_t i = first; i < end; ++i) {
    if (pattern[i] == '%') {
      set |= ClassOf(pattern[++i]);
    } else if (i + 2 < end && pattern[i + 1] == '-') {
      for (int c = Byte(pattern[i]); c <= Byte(pattern[i + 2]); ++c) set.set(c);
      i += 2;
    } else {
      set.set(Byte(pattern[i]));
    }
  }
  if (first == begin + 2) set.flip();
  ++end;
  return true;
}

}  // namespace

LuaPattern::LuaPattern(std::string_view pattern, bool anchors) {
  if (anchors && !pattern.empty() && pattern.front() == '^') {
    anchored_ = true;
    pattern.remove_prefix(1);
  }
  Compile(pattern);
}

void LuaPattern::Bad(const std::string& error) {
  Item item;
  item.kind = Kind::kBad;
  item.error = error;
  items_.push_back(item);
}

void LuaPattern::Compile(std::string_view pattern) {
  std::vector<int> open;  // captures not closed yet
  std::vector<bool> closed;
  for (std::size_t i = 0; i < pattern.size();) {
    Item item;
    const char c = pattern[i];
    const char next = i + 1 < pattern.size() ? pattern[i + 1] : '\0';
    if (c == '(') {
      if (closed.size() == kMaxCaptures) return Bad("too many captures");
      const bool position = next == ')';
      item.kind = position ? Kind::kPosition : Kind::kOpen;
      if (!position) open.push_back(static_cast<int>(closed.size()));
      closed.push_back(position);
      i += position ? 2 : 1;
    } else if (c == ')') {
      if (open.empty()) return Bad("invalid pattern capture");
      item.kind = Kind::kClose;
      item.capture = open.back();
      closed[open.back()] = true;
      open.pop_back();
      ++i;
    } else if (c == '$' && i + 1 == pattern.size()) {
      item.kind = Kind::kEnd;
      ++i;
    } else if (c == '%' && i + 1 == pattern.size()) {
      return Bad("malformed pattern (ends with '%')");
    } else if (c == '%' && next == 'b') {
      if (i + 3 >= pattern.size()) return Bad("malformed pattern (missing arguments to '%b')");
      item.kind = Kind::kBalance;
      item.open = pattern[i + 2];
      item.close = pattern[i + 3];
      i += 4;
    } else if (c == '%' && next == 'f') {
      if (i + 2 >= pattern.size() || pattern[i + 2] != '[') {
        return Bad("missing '[' after '%f' in pattern");
      }
      item.kind = Kind::kFrontier;
      if (!ParseSet(pattern, i + 2, i, item.set)) return Bad("malformed pattern (missing ']')");
    } else if (c == '%' && std::isdigit(Byte(next))) {
      item.kind = Kind::kBackReference;
      item.capture = next - '1';
      if (item.capture < 0 || item.capture >= static_cast<int>(closed.size()) ||
          !closed[item.capture]) {
        return Bad(std::string("invalid capture index %") + next + " in pattern");
      }
      i += 2;
    } else {
      if (c == '[') {
        if (!ParseSet(pattern, i, i, item.set)) return Bad("malformed pattern (missing ']')");
      } else if (c == '%') {
        item.set = ClassOf(next);
        i += 2;
      } else {
        c == '.' ? item.set.set() : item.set.set(Byte(c));
        ++i;
      }
      if (i < pattern.size() &&
          std::string_view("?*+-").find(pattern[i]) != std::string_view::npos) {
        item.quantifier = pattern[i++];
      }
    }
    items_.push_back(item);
  }
  if (!open.empty()) Bad("unfinished capture");
}

class LuaPattern::Matcher {
 public:
  Matcher(const LuaPattern& pattern, std::string_view subject, MatchSteps& steps)
      : items_(pattern.items_), subject_(subject), steps_(steps) {}

  // The end of the match of items from `index` on at subject position `at`, or kNone.
  std::size_t Run(std::size_t index, std::size_t at) {
    constexpr int kMaxDepth = 200;  // as deep as Lua's own goes
    if (++depth_ > kMaxDepth) throw std::invalid_argument("pattern too complex");
    const std::size_t end = RunItems(index, at);
    --depth_;
    return end;
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<Capture> captures;

 private:
  bool Single(const Item& item, std::size_t at) {
    steps_.Count();
    return at < subject_.size() && item.set[Byte(subject_[at])];
  }

  std::size_t RunItems(std::size_t index, std::size_t at) {
    for (; index < items_.size(); ++index) {
      steps_.Count();
      const Item& item = items_[index];
      switch (item.kind) {
        case Kind::kBad:
          throw std::invalid_argument(item.error);
        case Kind::kEnd:
          if (at != subject_.size()) return kNone;
          break;
        case Kind::kOpen:
        case Kind::kPosition: {
          captures.push_back({at, at, item.kind == Kind::kPosition});
          const std::size_t end = Run(index + 1, at);
          if (end == kNone) captures.pop_back();
          return end;
        }
        case Kind::kClose: {
          const std::size_t before = captures[item.capture].end;
          captures[item.capture].end = at;
          const std::size_t end = Run(index + 1, at);
          if (end == kNone) captures[item.capture].end = before;
          return end;
        }
        case Kind::kBackReference: {
          const Capture& capture = captures[item.capture];
          // Lua's own never finds the text of a position capture again: its length is no length.
          if (capture.position) return kNone;
          const std::string_view text = subject_.substr(capture.begin, capture.end - capture.begin);
          if (subject_.substr(at, text.size()) != text) return kNone;
          at += text.size();
          break;
        }
        case Kind::kBalance:
          at = RunBalance(item, at);
          if (at == kNone) return kNone;
          break;
        case Kind::kFrontier: {
          const unsigned char before = at == 0 ? 0 : Byte(subject_[at - 1]);
          const unsigned char here = at == subject_.size() ? 0 : Byte(subject_[at]);
          if (item.set[before] || !item.set[here]) return kNone;
          break;
        }
        case Kind::kSet:
          if (item.quantifier != 0) return RunQuantified(index, at);
          if (!Single(item, at)) return kNone;
          ++at;
          break;
      }
    }
    return at;
  }

  std::size_t RunQuantified(std::size_t index, std::size_t at) {
    const Item& item = items_[index];
    if (item.quantifier == '-') {
      for (;; ++at) {
        const std::size_t end = Run(index + 1, at);
        if (end != kNone) return end;
        if (!Single(item, at)) return kNone;
      }
    }
    std::size_t last = at;
    const std::size_t most = item.quantifier == '?' ? 1 : subject_.size();
    while (last - at < most && Single(item, last)) ++last;
    const std::size_t first = item.quantifier == '+' ? at + 1 : at;
    for (; last + 1 > first; --last) {
      const std::size_t end = Run(index + 1, last);
      if (end != kNone) return end;
      if (last == 0) break;
    }
    return kNone;
  }

  std::size_t RunBalance(const Item& item, std::size_t at) {
    if (at >= subject_.size() || subject_[at] != item.open) return kNone;
    std::size_t depth = 1;
    for (++at; at < subject_.size(); ++at) {
      steps_.Count();
      if (subject_[at] == item.close) {
        if (--depth == 0) return at + 1;
      } else if (subject_[at] == item.open) {
        ++depth;
      }
    }
    return kNone;
  }

  const std::vector<Item>& items_;
  std::string_view subject_;
  MatchSteps& steps_;
  int depth_ = 0;
};

bool LuaPattern::MatchAt(std::string_view subject, std::size_t begin, MatchSteps& steps,
                         Match& match) const {
  Matcher matcher(*this, subject, steps);
  const std::size_t end = matcher.Run(0, begin);
  if (end == Matcher::kNone) return false;
  match.begin = begin;
  match.end = end;
  match.captures = std::move(matcher.captures);
  return true;
}

bool LuaPattern::Find(std::string_view subject, std::size_t begin, MatchSteps& steps,
                      Match& match) const {
  for (; begin <= subject.size(); ++begin) {
    if (MatchAt(subject, begin, steps, match)) return true;
    if (anchored_) return false;
  }
  return false;
}

}  // namespace pregrasp
