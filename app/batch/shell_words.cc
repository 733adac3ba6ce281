#include "app/batch/shell_words.h"

#include <cctype>

namespace pregrasp {

std::string ShellWord(const std::string& word) {
  const std::string plain = "_-+=:,./@%";
  bool quote = word.empty();
  std::string quoted = "'";
  for (const char c : word) {
    quote = quote ||
            (!std::isalnum(static_cast<unsigned char>(c)) && plain.find(c) == std::string::npos);
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  quoted += '\'';
  return quote ? quoted : word;
}

std::string ShellWords(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += ShellWord(word);
  }
  return line;
}

}  // namespace pregrasp
