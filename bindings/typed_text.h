#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pregrasp {

/// A word, number, string or sign of Lua text, without comments and blanks.
struct LuaToken {
  enum class Kind { kName, kNumber, kString, kSign };
  Kind kind = Kind::kSign;
  std::string_view text;
  std::size_t begin = 0;  ///< in the text
};

/// Splits Lua text; never fails: what is unfinished goes to the end of the text.
std::vector<LuaToken> SplitLua(std::string_view text);

/// Whether lines of Lua text, added one by one, may be a whole piece: cheap, so that text which
/// comes from a pipe is not compiled again with each of its lines.
class PieceDepth {
 public:
  /// False if the lines since the last Clear are certainly unfinished: more is opened than closed.
  bool MayBeWhole(const std::string& line);
  void Clear() { *this = PieceDepth(); }

 private:
  int depth_ = 0;
  bool unclear_ = false;  // a string or comment may go on over the line's end
};

/// Text as it was typed, with each `local` that stands outside of all blocks taken out: at a prompt
/// each piece is a chunk of its own, whose locals would be gone with it. `local x <const>` stays.
std::string KeepLocals(const std::string& text);

}  // namespace pregrasp
