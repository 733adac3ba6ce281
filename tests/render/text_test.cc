#include <gtest/gtest.h>

#include "render/canvas.h"
#include "render/caption_card.h"
#include "render/font.h"
#include "render/footer.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

Image White(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3, 255)};
}

TEST(Utf8Test, DecodesAndEncodesEveryLength) {
  const std::string text = "a\u00b0\u03bb\u2192\U0001F600";
  const std::u32string decoded = DecodeUtf8(text);
  EXPECT_EQ(decoded, U"a\u00b0\u03bb\u2192\U0001F600");
  EXPECT_EQ(EncodeUtf8(decoded), text);
}

TEST(Utf8Test, MalformedBytesBecomeReplacementsAndNeverRunPastTheEnd) {
  EXPECT_EQ(DecodeUtf8("\xff"), U"\ufffd");
  EXPECT_EQ(DecodeUtf8("a\x80z"), U"a\ufffdz");
  EXPECT_EQ(DecodeUtf8("\xe2\x86"), U"\ufffd");
  EXPECT_EQ(DecodeUtf8("\xc0\xaf"), U"\ufffd\ufffd");
}

TEST(FontTest, HasTheCharactersOfCaptions) {
  FontSet fonts;
  for (const FontFace face : {FontFace::kSans, FontFace::kBold, FontFace::kMono}) {
    const Glyph& missing = fonts.GetGlyph(face, 16.0F, 0x10FFFD);
    for (const char32_t c : std::u32string(U"aZ09\u00b0\u00b5\u03bb\u03bc\u03c3\u03c6\u00d7\u00b7"
                                           U"\u2192\u2190\u2026\u2265\u00b1")) {
      const Glyph& glyph = fonts.GetGlyph(face, 16.0F, c);
      EXPECT_GT(glyph.advance, 0.0F) << static_cast<int>(c);
      EXPECT_NE(glyph.coverage, missing.coverage) << static_cast<int>(c);
    }
  }
}

TEST(FontTest, MonospaceHasOneWidth) {
  FontSet fonts;
  EXPECT_FLOAT_EQ(fonts.TextWidth(FontFace::kMono, 14.0F, "iiii"),
                  fonts.TextWidth(FontFace::kMono, 14.0F, "W\u03bb\u2192\u00b0"));
}

TEST(FooterTest, NothingOfACommandIsCutAtAnyWidthOrSizeOfType) {
  FontSet fonts;
  const std::string note = "12 labels have no room   grid 10 cm and 1 m",
                    before =
                        "scenes/ruler.lua \u00b7 seed 3 \u00b7 path.2.lift.15~5 \u00b7 t = 5.500 s",
                    command = "again: pregrasp run scenes/ruler.lua --seed 3";
  const std::string folder(150, 'w');
  const auto letters = [](std::string text) {
    for (const std::string left_out : {" ", "\u00b7"}) {
      for (std::size_t at; (at = text.find(left_out)) != std::string::npos;) {
        text.erase(at, left_out.size());
      }
    }
    return text;
  };
  for (const auto& [width, height] : {std::pair(1280, 720), {640, 360}, {480, 270}}) {
    const Image image{width, height, {}};
    for (const double font_scale : {1.0, 2.0, 4.0}) {
      const OverlayStyle style(image, font_scale);
      for (const std::string& more : {std::string(), " --out " + folder}) {
        const std::string text = before + " \u00b7 " + command + more;
        const FooterText footer = LayOutFooter(fonts, style, text, note, {width, height});
        std::string shown;
        for (const std::string& line : footer.lines) {
          shown += line;
          EXPECT_LE(fonts.TextWidth(FontFace::kMono, footer.size, line), width - 2 * style.px(16))
              << line;
        }
        EXPECT_EQ(letters(shown), letters(text)) << width << " " << font_scale;
        EXPECT_LE(footer.height, 0.5 * height + 1.0);
        ASSERT_LT(footer.note_line, footer.lines.size());
      }
    }
  }
  const auto lines = [&](int width, int height) {
    const OverlayStyle style(Image{width, height, {}}, 1.0);
    return LayOutFooter(fonts, style, before + " \u00b7 " + command, note, {width, height}).lines;
  };
  EXPECT_EQ(lines(1600, 900).size(), 1U);
  ASSERT_GE(lines(640, 360).size(), 2U);
  EXPECT_EQ(lines(640, 360)[0], before);
  EXPECT_EQ(lines(640, 360)[1], command);  // whole, on a line of its own
}

TEST(CaptionTest, TheCardStaysAtTheUpperLeftUnlessAnotherCornerHidesClearlyLess) {
  FontSet fonts;
  RenderCaption caption;
  caption.title = "A title of some length";
  caption.lines = {"one line of words", "another\t1.25"};
  const auto draw = [&](const CardArea& area) {
    Image image{800, 450, std::vector<std::uint8_t>(800 * 450 * 3, 200)};
    Canvas canvas(image, fonts);
    const auto card = DrawCaptionCard(canvas, fonts, OverlayStyle(image, 1.0), caption, area);
    EXPECT_TRUE(card.has_value());
    return card.value_or(Rect());
  };
  const auto box = [](double x, double y, double width, double height) {
    return std::vector<Vector2>{{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
  };
  const Rect usual = draw({430.0, {}, {}});
  EXPECT_LT(usual.right(), 400.0);
  EXPECT_LT(usual.bottom(), 200.0);
  EXPECT_EQ(draw({430.0, {}, {box(-400, 0, usual.x + 402.0, 450)}}).x,
            usual.x);  // hides next to nothing of it
  EXPECT_GT(draw({430.0, {}, {box(usual.x + 10.0, usual.y + 10.0, 8, 8)}}).x, 400.0);
  const Rect right = draw({430.0, {}, {box(0, 0, 400, 450)}});
  EXPECT_GT(right.x, 400.0);
  EXPECT_EQ(right.y, usual.y);
  const Rect low = draw({430.0, {}, {box(0, 0, 800, 220)}});
  EXPECT_EQ(low.x, usual.x);
  EXPECT_GT(low.y, 220.0);
  EXPECT_LE(low.bottom(), 430.0);
  const Rect taken{500.0, 60.0, 250.0, 300.0};
  EXPECT_EQ(draw({430.0, taken, {box(0, 0, 400, 450)}}).x, usual.x);  // no corner is free
}

TEST(CaptionTest, TheLegendStaysAtTheLowerRightUnlessAnotherCornerHidesClearlyLess) {
  FontSet fonts;
  RenderLegend legend;
  legend.title = "cost";
  legend.swatches = {{BadColor(), "one colour"}, {GoodColor(), "another"}};
  const auto draw = [&](const CardArea& area) {
    Image image{800, 450, std::vector<std::uint8_t>(800 * 450 * 3, 200)};
    Canvas canvas(image, fonts);
    return DrawLegend(canvas, fonts, OverlayStyle(image, 1.0), legend, area).value_or(Rect());
  };
  const auto low = [](double x) {
    return std::vector<Vector2>{{x, 225}, {800, 225}, {800, 450}, {x, 450}};
  };
  const Rect usual = draw({430.0, {}, {}, true});
  EXPECT_GT(usual.x, 500.0);
  EXPECT_GT(usual.y, 225.0);
  EXPECT_EQ(draw({430.0, {}, {low(790)}, true}).x, usual.x);
  const Rect left = draw({430.0, {}, {low(400)}, true});
  EXPECT_LT(left.right(), 400.0);
  EXPECT_EQ(left.y, usual.y);
  const Rect top = draw({430.0, {}, {low(0)}, true});
  EXPECT_EQ(top.x, usual.x);
  EXPECT_LT(top.bottom(), 225.0);
  EXPECT_EQ(draw({430.0, {}, {low(0)}, false}).y, usual.y);  // the card's
}

TEST(CaptionTest, WrappedLinesFitAndKeepEveryWord) {
  FontSet fonts;
  const std::string text =
      "The index finger presses down and drags the ruler over the edge of the table";
  for (const double width : {60.0, 120.0, 300.0, 2000.0}) {
    std::string joined;
    for (const std::string& line : WrapText(fonts, FontFace::kSans, 14.0F, text, width)) {
      EXPECT_LE(fonts.TextWidth(FontFace::kSans, 14.0F, line), width);
      joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, text);
  }
}

TEST(CaptionTest, TooLongAWordIsCutWithAnEllipsis) {
  FontSet fonts;
  const std::string cut =
      FitText(fonts, FontFace::kMono, 12.0F,
              "\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb\u03bb", 50.0);
  EXPECT_LE(fonts.TextWidth(FontFace::kMono, 12.0F, cut), 50.0);
  EXPECT_EQ(DecodeUtf8(cut).back(), U'\u2026');
  EXPECT_EQ(DecodeUtf8(cut).front(), U'\u03bb');
  EXPECT_EQ(FitText(fonts, FontFace::kMono, 12.0F, "short", 500.0), "short");
}

TEST(CanvasTest, ShapesCoverWhatTheyShouldWithSoftEdges) {
  FontSet fonts;
  Image image = White(40, 40);
  Canvas canvas(image, fonts);
  canvas.FillRect({10.5, 10, 9.5, 10}, FromSrgb(0x000000));
  const auto at = [&image](int x, int y) { return image.rgb[(y * 40 + x) * 3]; };
  EXPECT_EQ(at(9, 15), 255);
  EXPECT_NEAR(at(10, 15), 128, 1);  // half covered
  EXPECT_EQ(at(11, 15), 0);
  EXPECT_EQ(at(19, 15), 0);
  EXPECT_EQ(at(20, 15), 255);
  canvas.FillDisc({30, 30}, 5.0, FromSrgb(0x000000, 0.5F));
  EXPECT_NEAR(at(30, 30), 128, 1);
  EXPECT_EQ(at(36, 30), 255);
  double covered = 0.0;  // the area of a disc, from its pixels
  for (int y = 22; y < 38; ++y) {
    for (int x = 22; x < 38; ++x) covered += (255 - at(x, y)) / 127.5;
  }
  EXPECT_NEAR(covered, kPi * 25.0, 1.0);
}

TEST(CanvasTest, NothingIsDrawnOutsideThePicture) {
  FontSet fonts;
  Image image = White(16, 16);
  Canvas canvas(image, fonts);
  canvas.FillRoundedRect({-10, -10, 50, 5}, 3, ObjectColor());
  canvas.FillDisc({100, 100}, 20, ObjectColor());
  canvas.DrawLine({-50, -20}, {-5, 60}, 4, ObjectColor());
  canvas.DrawText(FontFace::kSans, 20, {-500, 5}, "far to the left", ObjectColor());
  canvas.DrawText(FontFace::kSans, 20, {17, 15}, "right", ObjectColor());
  EXPECT_EQ(image.rgb, White(16, 16).rgb);
}

TEST(PaletteTest, ScoreColoursRiseEvenlyInLightness) {
  double last = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const Rgba c = ScoreColor(i / 100.0);
    const double luminance = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(luminance, last) << i;
    last = luminance;
  }
  EXPECT_EQ(ScoreColor(-1.0).b, ScoreColor(0.0).b);
  EXPECT_EQ(ScoreColor(2.0).r, ScoreColor(1.0).r);
}

}  // namespace
}  // namespace pregrasp
