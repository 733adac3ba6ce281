// Studies as their tables show them, from records of our own making.
#include "app/studies/study.h"

#include <gtest/gtest.h>

#include <set>

#include "app/core/error.h"
#include "app/core/json_text.h"

namespace pregrasp {
namespace {

nlohmann::json Row(const std::string& scene, std::uint64_t seed, const std::string& status,
                   double r_suc, int n_paths, double seconds) {
  return {{"scene", scene},
          {"seed", seed},
          {"status", status},
          {"r_suc", r_suc},
          {"r_suc_raw", 0.5 * r_suc},
          {"r_lift", nullptr},
          {"n_paths", n_paths},
          {"n_screened", 0},
          {"rollouts", 480},
          {"lift_held", status == "ok"},
          {"source", "generator"},
          {"fingers", {"thumb", "index"}},
          {"kept", {"index"}},
          {"contacts", {{{"fingers", {"index"}}, {"triangles", {12}}}}},
          {"moved_mm", 40.0},
          {"turned_deg", 10.0},
          {"neighbour_moved_mm", nullptr},
          {"start_certified", true},
          {"mu_star", 1.2},
          {"robust_held", 4},
          {"seconds", seconds}};
}

std::string FileOf(const StudyFiles& files, const std::string& name) {
  for (const auto& [file, text] : files) {
    if (file == name) return text;
  }
  ADD_FAILURE() << "no " << name;
  return "";
}

TEST(StudiesTest, AreFoundByNameAndOthersAreRefusedWithAllThereAre) {
  std::set<std::string> names;
  for (const StudyInfo& study : Studies()) {
    EXPECT_EQ(FindStudy(study.name).text, study.text);
    EXPECT_TRUE(names.insert(study.name).second) << study.name;
  }
  try {
    FindStudy("table9");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "--study");
    for (const std::string& name : names) {
      EXPECT_NE(error.expected().find(name), std::string::npos) << name;
    }
  }
}

TEST(Table1Test, MeansAreOverSuccessesAndFailuresAreShown) {
  const StudyFiles files = FindStudy("table1").tabulate(
      {Row("book", 1, "ok", 0.9, 1, 10.0), Row("book", 2, "ok", 0.7, 3, 20.0),
       Row("book", 3, "not_certified", 0.0, 10, 90.0)});
  const std::string text = FileOf(files, "table1.md");
  // r_suc of the two, the paper's bookshelf beside it, then raw; N_paths likewise.
  EXPECT_NE(text.find("| book | 2 of 3 | 0.21 to 0.94 | 0.800 (0.141) | 0.917 (0.058) | "
                      "0.400 (0.071) | - | 2.000 (1.414) | 1.667 (1.155) |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| 20 / 90 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| book | 3 | not_certified |"), std::string::npos) << text;
  EXPECT_NE(text.find("index 2x; 40 mm, 10 deg"), std::string::npos) << text;
}

TEST(Table1Test, JsonIsAListOfTheRecordsAndCsvHasARowEach) {
  const std::vector<nlohmann::json> items = {Row("book", 1, "ok", 0.9, 1, 10.0),
                                             Row("plate", 1, "start_graspable", 0.0, 0, 1.0)};
  const StudyFiles files = FindStudy("table1").tabulate(items);
  EXPECT_EQ(ParseJson(FileOf(files, "table1.json"), "table1.json"), nlohmann::json(items));
  const std::string csv = FileOf(files, "table1.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_EQ(csv.find("scene,seed,status,r_suc,"), 0U) << csv;
  EXPECT_NE(csv.find("\nplate,1,start_graspable,"), std::string::npos) << csv;
}

TEST(Table1Test, ASceneThatThePaperLacksHasNoFigureOfIts) {
  const StudyFiles files =
      FindStudy("table1").tabulate({Row("teapot", 1, "not_certified", 0.0, 10, 5.0)});
  const std::string text = FileOf(files, "table1.md");
  EXPECT_NE(text.find("| teapot | 0 of 1 | 0.00 to 0.79 | - |  | - | - | - |  |"),
            std::string::npos)
      << text;
}

TEST(IkOrderTest, AnItemIsAFunctionOfItsSeedAndTheTableSaysWhichOrderHasLess) {
  StudySetup setup;
  setup.seeds = 2;
  setup.first_seed = 5;
  const StudyInfo& info = FindStudy("ik-order");
  const std::unique_ptr<Study> study = info.make(setup);
  ASSERT_EQ(study->num_items(), 2);
  nlohmann::json item = study->MakeItem(1);
  EXPECT_EQ(item["problem"], 6);
  for (const char* order : {"reverse", "forward"}) {
    EXPECT_GE(item[order]["keyframes"], 8) << order;
    EXPECT_GT(item[order]["wrist_turn_deg"], 0.0) << order;
    EXPECT_GE(item[order]["wrist_turn_deg"], item[order]["largest_wrist_turn_deg"]) << order;
  }
  item["reverse"]["wrist_turn_deg"] = 40.0;
  item["forward"]["wrist_turn_deg"] = 100.0;
  nlohmann::json other = item;
  other["reverse"]["wrist_turn_deg"] = 60.0;
  const StudyFiles files = info.tabulate({item, other});
  const std::string text = FileOf(files, "ik-order.md");
  EXPECT_NE(text.find("| turn of the wrist between keyframes, sum [deg] | 50.000 (14.142) | "
                      "100.000 (0.000) | 2 | 0 |"),
            std::string::npos)
      << text;
  EXPECT_EQ(ParseJson(FileOf(files, "ik-order.json"), ""), nlohmann::json({item, other}));
  const std::string svg = FileOf(files, "ik-order.svg");
  std::size_t points = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos;
       at = svg.find("<circle", at + 1))
    ++points;
  EXPECT_EQ(points, 2U);
}

TEST(Table1Test, ADamagedRecordIsNamed) {
  nlohmann::json row = Row("book", 1, "ok", 0.9, 1, 10.0);
  row["r_suc"] = "high";
  try {
    FindStudy("table1").tabulate({row});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("r_suc"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace pregrasp
