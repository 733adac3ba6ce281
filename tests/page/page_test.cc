#include "app/page/page.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/page/film.h"
#include "app/page/page_server.h"
#include "app/page/run_steps.h"
#include "app/page/strip.h"
#include "app/pictures/words.h"
#include "app/recording/checked_file.h"
#include "app/session/session.h"
#include "tests/job/fixture.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A simulation by hand, of a scene and by a command that would do harm if they were not escaped.
class PageTest : public testing::Test {
 protected:
  static LoadedRun MakeRun(const fs::path& folder,
                           const std::optional<std::string>& status = std::nullopt) {
    SessionConfig config;
    config.threads = 1;
    config.command = "pregrasp run a.lua --out '</script><script>alert(1)</script>&\"'";
    Session session(MakeRulerScene(), config);
    session.Record(folder, PictureMode::kNone);
    const auto& touched = session.timeline().Do(session.start(), Verb::kTouch,
                                                {{"finger", "index"}, {"p_OC", {0.11, 0, 0.0015}}});
    session.timeline().Do(touched, Verb::kWait, {{"seconds", 0.05}});
    session.FinishRecording(status);
    return LoadRun(folder);
  }

  const TestFolder folder_;
  const fs::path run_ = folder_.path() / "run";
};

TEST_F(PageTest, ARunWithoutAPlanIsOneFileThatNeedsNoOtherAndIsMadeAlike) {
  const LoadedRun run = MakeRun(run_);
  const std::string page = MakePage(run);
  EXPECT_LT(page.size(), kMostPageBytes);
  EXPECT_EQ(page, MakePage(run));
  // Nothing is fetched: addresses are of the page itself, or hold what they stand for.
  int pictures = 0;
  for (const std::string name : {"src=\"", "href=\"", "action=\""}) {
    for (std::size_t at = page.find(name); at != std::string::npos; at = page.find(name, at + 1)) {
      const std::string target = page.substr(at + name.size(), 30);
      EXPECT_TRUE(target[0] == '#' || target.rfind("data:", 0) == 0) << target;
      pictures += target.rfind("data:image/jpeg;base64,", 0) == 0;
    }
  }
  EXPECT_EQ(pictures, 4);  // the start, two steps, and the last one at the top
  EXPECT_EQ(page.find("url("), std::string::npos);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;alert(1)&lt;/script&gt;&amp;&quot;"), std::string::npos);
  for (const StepFacts& step : run.steps) {
    EXPECT_NE(page.find("<code>" + step.id + "</code>"), std::string::npos);
    const std::string sentence = DescribeStep(run.scene, step, run).front();
    EXPECT_NE(page.find(sentence.substr(0, sentence.find('\t'))), std::string::npos) << sentence;
  }
  EXPECT_NE(page.find("no plan"), std::string::npos);
}

TEST_F(PageTest, AStepHasOneNumberInAllPartsOfThePage) {
  const LoadedRun run = MakeRun(run_);
  const RunSteps steps(run);
  for (const StepFacts& step : run.steps) {
    EXPECT_EQ(steps.NumberOf(step), run.number_of.at(step.id)) << step.id;
  }
  // What it says in short of the last step leads to that step.
  const std::string page = MakePage(run), last = std::to_string(run.steps.size());
  EXPECT_NE(page.find("href=\"#row-" + last + "\" data-step=\"" + last + "\">" +
                      run.steps.back().id + "</a>"),
            std::string::npos);
}

TEST_F(PageTest, AnInterruptedRunHasAPageThatSaysSo) {
  const std::string page = MakePage(MakeRun(run_, "interrupted"));
  EXPECT_NE(page.find("<span class=\"badge bad\">interrupted</span>"), std::string::npos);
}

TEST_F(PageTest, ASheetHasEveryStepOfTheStoryAndOneTooSmallForThemIsRefused) {
  const LoadedRun run = MakeRun(run_);
  EXPECT_EQ(RunSteps(run).FindStory(20).size(), 3U);
  EXPECT_EQ(RunSteps(run).FindStory(2).size(), 2U);
  Shot shot;
  shot.config.quality = RenderQuality::kDraft;
  shot.config.width = 640;
  const Image sheet = DrawContactSheet(run, shot, std::nullopt);
  EXPECT_EQ(sheet.width, 640);
  EXPECT_EQ(sheet.rgb.size(), 3U * 640U * static_cast<std::size_t>(sheet.height));
  shot.config.width = 150;
  EXPECT_THROW(DrawContactSheet(run, shot, std::nullopt), InputError);
}

TEST_F(PageTest, WithoutAMotionThereIsNoFilmAndNothingIsWritten) {
  const LoadedRun run = MakeRun(run_);
  EXPECT_TRUE(IsFilmFile("a/b.mp4") && IsFilmFile("b.gif") && !IsFilmFile("b.png"));
  const fs::path film = folder_.path() / "film.mp4";
  EXPECT_THROW(WriteFilm(run, {}, std::nullopt, film, [](int, int) {}), InputError);
  EXPECT_FALSE(fs::exists(film));
}

TEST_F(PageTest, RunsBelowAFolderAreFoundAndWhatIsNoneIsNot) {
  MakeRun(run_);
  folder_.Write("other/notes.txt", "none");
  EXPECT_EQ(FindRuns(folder_.path()), std::vector<fs::path>{"run"});
  EXPECT_EQ(FindRuns(run_), std::vector<fs::path>{"."});
  EXPECT_THROW(ServePages(folder_.path() / "none", 0, [](const std::string&) {}), InputError);
}

}  // namespace
}  // namespace pregrasp
