#include "app/page/html_text.h"

#include <gtest/gtest.h>

namespace pregrasp {
namespace {

TEST(HtmlTextTest, WhatMeansSomethingToABrowserIsEscaped) {
  EXPECT_EQ(EscapeHtml("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
  EXPECT_EQ(EscapeHtml("t = 1 s · ok"), "t = 1 s · ok");
}

TEST(HtmlTextTest, Base64IsThatOfTheStandardsExamples) {  // RFC 4648, section 10
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(HtmlTextTest, JsonCannotEndTheScriptThatItStandsIn) {
  const nlohmann::ordered_json value = {{"a", "</script><!--"}, {"b", {1, 2.5}}};
  const std::string text = ScriptJson(value);
  EXPECT_EQ(text.find('<'), std::string::npos) << text;
  EXPECT_EQ(nlohmann::ordered_json::parse(text), value);
}

TEST(HtmlTextTest, SentencesAreParagraphsAndRowsAreATable) {
  EXPECT_EQ(LinesToHtml({"It <moves>.", "cost\t0.5", "mean\t1 & 2", "So."}),
            "<p>It &lt;moves&gt;.</p>\n<table class=\"facts\">\n"
            "<tr><th scope=\"row\">cost</th><td>0.5</td></tr>\n"
            "<tr><th scope=\"row\">mean</th><td>1 &amp; 2</td></tr>\n</table>\n<p>So.</p>\n");
  EXPECT_EQ(FactTable("empty", {}), "");
}

}  // namespace
}  // namespace pregrasp
