#pragma once

#include <stdexcept>
#include <string>

namespace pregrasp {

/// The user's input is wrong: a scene, an asset, a flag, a Lua argument. Ends as one line on stderr
/// and exit code 2.
class InputError : public std::runtime_error {
 public:
  /// @param where     file and line ("scenes/a.lua:12"), a flag ("--seed") or a call ("s:settle").
  /// @param field     the offending field as the user wrote it ("object.mass"); may be empty.
  /// @param expected  what would have been right ("a mass above 0 kg").
  /// @param got       what came instead ("-0.2"); may be empty.
  InputError(std::string where, std::string field, std::string expected, std::string got);

  /// A line that is complete already: what Lua's own parser or a script's error() says.
  explicit InputError(const std::string& line);

  const std::string& where() const { return where_; }
  const std::string& field() const { return field_; }
  const std::string& expected() const { return expected_; }
  const std::string& got() const { return got_; }

 private:
  std::string where_, field_, expected_, got_;
};

/// Our bug: a PREGRASP_CHECK did not hold. Ends as one line and exit code 1.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace pregrasp
