#include "app/page/strip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "app/page/pair.h"
#include "app/pictures/words.h"
#include "app/session/session.h"
#include "render/canvas.h"
#include "render/palette.h"
#include "tests/job/fixture.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// The ruler, touched and drawn along by so much.
class StripTest : public testing::Test {
 protected:
  static SessionConfig MakeConfig() {
    SessionConfig config;
    config.threads = 1;
    return config;
  }
  static const Timeline::Node& Touch(Session& session) {
    return session.timeline().Do(session.start(), Verb::kTouch,
                                 {{"finger", "index"}, {"p_OC", {0.11, 0, 0.0015}}});
  }
  static const Timeline::Node& Draw(Session& session, const Timeline::Node& from, double by) {
    const Vector3 target_W = from.facts.fingers[1].p_WTarget + Vector3(by, 0.0, -0.012);
    return session.timeline().Do(from, Verb::kMove,
                                 {{"finger", "index"},
                                  {"p_WTarget", {target_W.x(), target_W.y(), target_W.z()}},
                                  {"seconds", 0.2}});
  }
  LoadedRun MakeRun(const std::string& name, double by) const {
    Session session(MakeRulerScene(), MakeConfig());
    session.Record(folder_.path() / name, PictureMode::kNone);
    Draw(session, Touch(session), by);
    session.FinishRecording();
    return LoadRun(folder_.path() / name);
  }

  static Shot MakeShot(int width) {
    Shot shot;
    shot.config.quality = RenderQuality::kDraft;
    shot.config.width = width;
    return shot;
  }

  // How many pixels have the colour of a mark.
  static int CountMarked(const Image& image) {
    const Rgba mark = BadColor();
    int count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      bool same = true;
      const float channels[] = {mark.r, mark.g, mark.b};
      for (std::size_t k = 0; k < 3; ++k) {
        const double expected = 255.0 * SrgbFromLinear(channels[k]);
        same = same && std::abs(image.rgb[i + k] - expected) <= 1.0;
      }
      count += same ? 1 : 0;
    }
    return count;
  }

  const TestFolder folder_;
};

TEST_F(StripTest, OneCameraIsFramedOverAllStepsAndEachSaysWhatHappened) {
  const LoadedRun run = MakeRun("run", 0.1);
  PictureDrawer drawer(run.scene, LabelsOf(run));
  const StepFacts& start = run.steps.front();
  StepFacts end = run.steps.back();
  end.bodies[0].p_WB.x() += 0.5;  // far enough for another camera
  const auto cells =
      MakeCells({{&start, &run, &drawer}, {&end, &run, &drawer}, {}}, MakeShot(640), std::nullopt);
  ASSERT_EQ(cells.size(), 3U);
  EXPECT_EQ(cells[1].title, "sim.2   t = 0.20 s");
  EXPECT_FALSE(cells[1].sentence.empty());
  EXPECT_FALSE(cells[2].draw);
  Shot shot = MakeShot(1600);
  shot.config.height = 900;
  shot.config.card = shot.config.footer = false;
  const CameraConfig both = drawer.FrameSteps({&start, &end}, run, shot.config),
                     first = drawer.FrameSteps({&start}, run, shot.config);
  EXPECT_NE(both.p_WCam, first.p_WCam);
  shot.config.camera = both;
  shot.config.width = 320;
  shot.config.height = 180;
  EXPECT_EQ(cells[0].draw(320, 180).rgb, drawer.Render(start, run, shot).rgb);
  EXPECT_EQ(cells[1].draw(320, 180).rgb, drawer.Render(end, run, shot).rgb);
}

TEST_F(StripTest, StepsStandInOneRowInTheirOrderAndUnknownOnesAreRefused) {
  const LoadedRun run = MakeRun("run", 0.1);
  const Shot shot = MakeShot(700);
  const Image two = DrawStripOfRun(run, {"sim.1", "sim.2"}, shot, std::nullopt),
              three = DrawStripOfRun(run, {"sim.2", "scene.start", "sim.1"}, shot, std::nullopt);
  EXPECT_EQ(two.width, 700);
  EXPECT_LT(three.height, two.height);  // three in a row are smaller than two
  EXPECT_NE(two.rgb, DrawStripOfRun(run, {"sim.2", "sim.1"}, shot, std::nullopt).rgb);
  EXPECT_EQ(CountMarked(two), 0);
  EXPECT_THROW(DrawStripOfRun(run, {"sim.3"}, shot, std::nullopt), InputError);
  EXPECT_THROW(DrawStripOfRun(run, {"sim.1", "sim.2"}, MakeShot(300), std::nullopt), InputError);
}

TEST(PictureGridTest, PairsOfOneStepStandSideBySideAndNothingIsLeftBlank) {
  PictureGrid grid;
  std::vector<int> widths;
  grid.cells.resize(2);
  for (PictureGrid::Cell& cell : grid.cells) {
    cell.title = "sim.1   t = 0.20 s";
    cell.sentence = "one line";
    cell.draw = [&widths](int width, int height) {
      widths.push_back(width);
      return Image{width, height,
                   std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3, 0)};
    };
  }
  grid.row_names = {"A", "B"};
  grid.columns = 1;
  grid.width = 2400;
  grid.height = 1440;
  EXPECT_EQ(DrawGrid(grid).width, 2400);
  EXPECT_GT(widths.at(0), 1150);
  widths.clear();
  // Two steps of two runs are as high as they may be, and the sheet as wide as they are.
  grid.columns = 2;
  for (const int copy : {0, 1}) grid.cells.push_back(grid.cells[static_cast<std::size_t>(copy)]);
  const Image sheet = DrawGrid(grid);
  EXPECT_GT(widths.at(0), 800);
  EXPECT_NEAR(sheet.width, 2 * widths.at(0), 80);
  EXPECT_NEAR(sheet.height, 1440, 10);
}

TEST(PictureGridTest, ManyStepsAndLargeTypeLeavePicturesThatCanBeSeen) {
  for (const double font_scale : {1.0, 4.0}) {
    for (const std::size_t count : {20U, 48U}) {
      PictureGrid grid;
      int narrowest = 100000;
      grid.most_lines = 8;
      grid.font_scale = font_scale;
      grid.cells.resize(count);
      for (PictureGrid::Cell& cell : grid.cells) {
        cell.title = "48. path.2.grasp.10~4   t = 3.10 s";
        cell.sentence = "Iteration 15: 48 plans, of noise about the mean or of steady pushes";
        cell.draw = [&narrowest](int width, int height) {
          narrowest = std::min(narrowest, width);
          return Image{width, height,
                       std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 3, 0)};
        };
      }
      const Image sheet = DrawGrid(grid);
      EXPECT_LE(sheet.height, grid.height);
      EXPECT_GE(narrowest, 200) << count << " " << font_scale;
    }
  }
}

TEST_F(StripTest, TwoRunsFirstDifferWhereDiffSaysAndThereTheyAreFramed) {
  const LoadedRun run = MakeRun("run", 0.1), same = MakeRun("same", 0.1),
                  other = MakeRun("other", 0.05);
  EXPECT_EQ(FindFirstDifference(run, same).left, nullptr);
  const FirstDifference difference = FindFirstDifference(run, other);
  EXPECT_EQ(difference.left, &run.Get("sim.2"));
  EXPECT_EQ(difference.right, &other.Get("sim.2"));
  // In the words of the card, with its units.
  EXPECT_EQ(difference.text.rfind("The first step that differs, sim.2, has ", 0), 0U)
      << difference.text;
  const auto row = [](const LoadedRun& of) {
    const std::vector<std::string> lines = DescribeStep(of.scene, of.Get("sim.2"), of);
    return *std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
      return line.find('\t') != std::string::npos;
    });
  };
  const std::string a = row(run), b = row(other);
  const std::size_t tab = a.find('\t');
  ASSERT_NE(a, b);
  EXPECT_NE(difference.text.find(a.substr(0, tab) + ": A " + a.substr(tab + 1) + ", B " +
                                 b.substr(tab + 1)),
            std::string::npos)
      << difference.text;
  const Shot shot = MakeShot(900);
  const auto marked = [&](const LoadedRun& against, const std::vector<std::string>& ids) {
    return CountMarked(DrawPairOfRuns(run, against, ids, shot, std::nullopt));
  };
  EXPECT_GT(marked(other, {}), 1000);
  EXPECT_GT(marked(other, {"sim.1", "sim.2"}), 1000);
  EXPECT_EQ(marked(other, {"sim.1"}), 0);
  EXPECT_EQ(marked(same, {}), 0);
  EXPECT_THROW(marked(other, {"sim.3"}), InputError);
}

TEST_F(StripTest, ARunThatGoesOnDiffersFromOneThatEndsInItsNextStep) {
  Session session(MakeRulerScene(), MakeConfig());
  const Timeline::Node& touched = Touch(session);
  session.Save(folder_.path() / "short");
  const Timeline::Node& drawn = Draw(session, touched, 0.05);
  session.Save(folder_.path() / "long");
  const LoadedRun ends = LoadRun(folder_.path() / "short"),
                  goes_on = LoadRun(folder_.path() / "long");
  const FirstDifference difference = FindFirstDifference(ends, goes_on);
  EXPECT_EQ(difference.left, nullptr);
  EXPECT_EQ(difference.right, &goes_on.Get(drawn.id()));
}

TEST_F(StripTest, TwoBranchesOfASessionAreFramedWhereTheyPart) {
  Session session(MakeRulerScene(), MakeConfig());
  const Timeline::Node& touched = Touch(session);
  const Timeline::Node &far = Draw(session, touched, 0.1), &near = Draw(session, touched, 0.02);
  const Timeline& timeline = session.timeline();
  const FirstDifference difference = FindFirstDifference(timeline, far, timeline, near);
  EXPECT_EQ(difference.left, &far.facts);
  EXPECT_EQ(difference.right, &near.facts);
  EXPECT_NE(difference.text.find("the same up to " + touched.id()), std::string::npos);
  const auto draw = [&](const Timeline::Node& a, const Timeline::Node& b) {
    return DrawPairOfBranches({timeline, a, session.drawer()}, {timeline, b, session.drawer()},
                              MakeShot(900));
  };
  EXPECT_GT(CountMarked(draw(far, near)), 1000);
  EXPECT_EQ(CountMarked(draw(far, far)), 0);
  EXPECT_GT(CountMarked(draw(far, touched)), 500);  // one goes on
}

}  // namespace
}  // namespace pregrasp
