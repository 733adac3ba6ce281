#include "bindings/typed_text.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

std::string Join(const std::string& text) {
  std::string joined;
  for (const LuaToken& token : SplitLua(text)) {
    if (!joined.empty()) joined += '|';
    joined += token.text;
  }
  return joined;
}

TEST(SplitLuaTest, KnowsWordsNumbersStringsSignsAndComments) {
  EXPECT_EQ(Join("a.b2:c(1.5e3, 0x1F)"), "a|.|b2|:|c|(|1.5e3|,|0x1F|)");
  EXPECT_EQ(Join("x = \"a \\\" b\" .. 'c' -- d\ny"), "x|=|\"a \\\" b\"|.|.|'c'|y");
  EXPECT_EQ(Join("[[a\n]b]] [==[ ]] ]==] t[1]"), "[[a\n]b]]|[==[ ]] ]==]|t|[|1|]");
  EXPECT_EQ(Join("--[[ a\nb ]] c --[==[ d"), "c");
}

TEST(SplitLuaTest, TakesWhatIsUnfinishedToTheEnd) {
  EXPECT_EQ(Join("f \"abc"), "f|\"abc");
  EXPECT_EQ(Join("f [[abc\nd"), "f|[[abc\nd");
  EXPECT_EQ(Join("'\\"), "'\\");
  EXPECT_EQ(Join(""), "");
}

TEST(KeepLocalsTest, TakesLocalOutWhereItWouldBeLost) {
  EXPECT_EQ(KeepLocals("local a = 1"), "      a = 1");
  EXPECT_EQ(KeepLocals("o:back(3);  local b = o:fork{ local_ = 1 }"),
            "o:back(3);        b = o:fork{ local_ = 1 }");
  EXPECT_EQ(KeepLocals("local function f() local x = 1 end"), "      function f() local x = 1 end");
  EXPECT_EQ(KeepLocals("local a, b local c = 2"), "      a, b = nil       c = 2");
}

TEST(KeepLocalsTest, LeavesTheRestAsItIs) {
  for (const char* text :
       {"do local a = 1 end", "for i = 1, 2 do local a = i end", "if x then local a = 1 end",
        "repeat local a = 1 until a", "f(function() local a = 1 end)", "local a <const> = 1",
        "x = 'local a = 1'", "-- local a = 1", "local", "while x do local function f() end end"}) {
    EXPECT_EQ(KeepLocals(text), text);
  }
}

}  // namespace
}  // namespace pregrasp
