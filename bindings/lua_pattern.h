#pragma once

#include <bitset>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pregrasp {

/// Counts the steps of matching and calls `poll`, which may throw, every 4096 of them.
class MatchSteps {
 public:
  explicit MatchSteps(std::function<void()> poll) : poll_(std::move(poll)) {}
  void Count() {
    if ((++steps_ & 0xFFFU) == 0) poll_();
  }

 private:
  std::function<void()> poll_;
  unsigned steps_ = 0;
};

/// A pattern of Lua (reference manual 5.4, section 6.4.1), compiled once and matched by
/// backtracking like Lua's own, but counting its steps, so that a pattern that would run for years
/// can be stopped. Lua's own matcher cannot.
class LuaPattern {
 public:
  static constexpr int kMaxCaptures = 32;

  struct Capture {
    std::size_t begin = 0, end = 0;
    bool position = false;  ///< "()": only `begin` counts
  };
  struct Match {
    std::size_t begin = 0, end = 0;
    std::vector<Capture> captures;
  };

  /// @param anchors  whether a leading ^ ties the match to the start (not so in gmatch).
  explicit LuaPattern(std::string_view pattern, bool anchors = true);

  bool anchored() const { return anchored_; }

  /// Tries to match at `begin` exactly.
  /// @throws std::invalid_argument with Lua's wording when it meets a malformed part of the
  /// pattern.
  bool MatchAt(std::string_view subject, std::size_t begin, MatchSteps& steps, Match& match) const;

  /// The first match at or after `begin`, or at `begin` only if the pattern is anchored.
  bool Find(std::string_view subject, std::size_t begin, MatchSteps& steps, Match& match) const;

 private:
  enum class Kind {
    kSet,
    kOpen,
    kPosition,
    kClose,
    kBackReference,
    kBalance,
    kFrontier,
    kEnd,
    kBad
  };
  struct Item {
    Kind kind = Kind::kSet;
    char quantifier = 0;  // of a set: 0, '?', '*', '+' or '-'
    std::bitset<256> set;
    int capture = 0;           // that this item closes or refers to
    char open = 0, close = 0;  // of a balance
    std::string error;         // of a bad item: raised when matching gets there, as Lua does
  };
  class Matcher;

  void Compile(std::string_view pattern);
  void Bad(const std::string& error);

  bool anchored_ = false;
  std::vector<Item> items_;
};

}  // namespace pregrasp
