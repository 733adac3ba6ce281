#include "bindings/typed_text.h"

#include <cctype>

namespace pregrasp {
namespace {

bool IsWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Where "[[..]]" or "[==[..]==]" that opens at `begin` ends; `begin` if none opens there.
std::size_t SkipLongBracket(std::string_view text, std::size_t begin) {
  std::size_t at = begin + 1;
  while (at < text.size() && text[at] == '=') ++at;
  if (text[begin] != '[' || at >= text.size() || text[at] != '[') return begin;
  std::string close(at - begin + 1, '=');
  close.front() = close.back() = ']';
  const std::size_t end = text.find(close, at + 1);
  return end == std::string_view::npos ? text.size() : end + close.size();
}

std::size_t SkipQuoted(std::string_view text, std::size_t begin) {
  std::size_t at = begin + 1;
  while (at < text.size() && text[at] != text[begin] && text[at] != '\n') {
    at += text[at] == '\\' ? 2 : 1;
  }
  return std::min(at + 1, text.size());
}

std::size_t SkipComment(std::string_view text, std::size_t begin) {
  const std::size_t body = begin + 2;
  if (body < text.size() && text[body] == '[') {
    const std::size_t end = SkipLongBracket(text, body);
    if (end != body) return end;
  }
  return std::min(text.find('\n', begin), text.size());
}

LuaToken ReadToken(std::string_view text, std::size_t begin) {
  const char c = text[begin];
  std::size_t end = begin + 1;
  LuaToken::Kind kind = LuaToken::Kind::kSign;
  if (c == '"' || c == '\'') {
    kind = LuaToken::Kind::kString;
    end = SkipQuoted(text, begin);
  } else if (c == '[' && SkipLongBracket(text, begin) != begin) {
    kind = LuaToken::Kind::kString;
    end = SkipLongBracket(text, begin);
  } else if (IsWord(c)) {
    const bool number = std::isdigit(static_cast<unsigned char>(c)) != 0;
    kind = number ? LuaToken::Kind::kNumber : LuaToken::Kind::kName;
    while (end < text.size() && (IsWord(text[end]) || (number && text[end] == '.'))) ++end;
  }
  return {kind, text.substr(begin, end - begin), begin};
}

int DepthChange(std::string_view word) {
  for (const char* open : {"do", "if", "function", "repeat", "(", "{", "["}) {
    if (word == open) return 1;
  }
  for (const char* close : {"end", "until", ")", "}", "]"}) {
    if (word == close) return -1;
  }
  return 0;
}

}  // namespace

std::vector<LuaToken> SplitLua(std::string_view text) {
  std::vector<LuaToken> tokens;
  for (std::size_t at = 0; at < text.size();) {
    if (std::isspace(static_cast<unsigned char>(text[at])) != 0) {
      ++at;
    } else if (text.compare(at, 2, "--") == 0) {
      at = SkipComment(text, at);
    } else {
      tokens.push_back(ReadToken(text, at));
      at += tokens.back().text.size();
    }
  }
  return tokens;
}

bool PieceDepth::MayBeWhole(const std::string& line) {
  unclear_ = unclear_ || line.find("[[") != std::string::npos ||
             line.find("[=") != std::string::npos || line.find("\\z") != std::string::npos ||
             (!line.empty() && line.back() == '\\');
  if (unclear_) return true;
  for (const LuaToken& token : SplitLua(line)) {
    if (token.kind != LuaToken::Kind::kString) depth_ += DepthChange(token.text);
  }
  return depth_ <= 0;
}

std::string KeepLocals(const std::string& text) {
  const std::vector<LuaToken> tokens = SplitLua(text);
  std::string kept = text;
  std::size_t added = 0;
  int depth = 0;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].kind == LuaToken::Kind::kString) continue;
    if (depth > 0 || tokens[i].text != "local" || i + 1 == tokens.size()) {
      depth += DepthChange(tokens[i].text);
      continue;
    }
    std::size_t next = i + 2;  // after the first name
    while (next + 1 < tokens.size() && tokens[next].text == ",") next += 2;
    const std::string_view after = next < tokens.size() ? tokens[next].text : "";
    if (after == "<") continue;
    kept.replace(tokens[i].begin + added, 5, "     ");
    if (tokens[i + 1].text == "function" || after == "=") continue;
    const LuaToken& last = tokens[next - 1];
    const std::string nothing = " = nil";
    kept.insert(last.begin + last.text.size() + added, nothing);
    added += nothing.size();
  }
  return kept;
}

}  // namespace pregrasp
