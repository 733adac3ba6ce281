#include "app/batch/shell_words.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace pregrasp {
namespace {

TEST(ShellWordsTest, AShellReadsThemBack) {
  const std::vector<std::string> words = {"printf",  "%s|",   "plain/a.lua", "two words",
                                          "it's",    "$HOME", "`ls`",        "",
                                          "a\"b\\c", "x;y&z*"};
  std::FILE* const shell = popen(ShellWords(words).c_str(), "r");
  ASSERT_NE(shell, nullptr);
  std::string read;
  for (int c = 0; (c = std::fgetc(shell)) != EOF;) read += static_cast<char>(c);
  EXPECT_EQ(pclose(shell), 0);
  EXPECT_EQ(read, "plain/a.lua|two words|it's|$HOME|`ls`||a\"b\\c|x;y&z*|");
}

TEST(ShellWordsTest, WhatNeedsNoQuotesHasNone) {
  EXPECT_EQ(ShellWords({"eval", "--set", "mppi.patience=3", "--scenes", "book,ruler"}),
            "eval --set mppi.patience=3 --scenes book,ruler");
}

}  // namespace
}  // namespace pregrasp
