// The paper's table of results ("r_suc and N_path of all tasks"), and what it takes to judge ours
// beside it: every scene with every seed through the whole pipeline, failures included.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "app/core/json_text.h"
#include "app/job/fields_json.h"
#include "app/session/session.h"
#include "app/studies/read_items.h"
#include "app/studies/statistics.h"
#include "app/studies/study.h"
#include "app/studies/table_text.h"

namespace pregrasp {
namespace {

// One run: a row of table1.json, whose fields it has. A field that no step has filled in is none.
struct Row {
  std::string scene;
  std::uint64_t seed = 1;
  std::optional<std::string> status;
  std::optional<double> r_suc, r_suc_raw, r_lift;
  std::optional<int> n_paths, n_screened, rollouts;
  std::optional<bool> lift_held;
  std::optional<std::string> source;
  std::optional<std::vector<Finger>> fingers, kept;  // of the grasp; that press on
  std::optional<std::vector<RunSummary::Stage>> contacts;
  double moved_mm = 0.0, turned_deg = 0.0;   // the object, up to the grasp
  std::optional<double> neighbour_moved_mm;  // the neighbour that moved farthest
  std::optional<bool> start_certified;
  std::optional<double> mu_star;
  std::optional<int> robust_held;
  double seconds = 0.0;

  template <typename Self, typename Visit>
  static void VisitFields(Self& self, Visit&& visit) {
    visit("scene", self.scene);
    visit("seed", self.seed);
    visit("status", self.status);
    visit("r_suc", self.r_suc);
    visit("r_suc_raw", self.r_suc_raw);
    visit("r_lift", self.r_lift);
    visit("n_paths", self.n_paths);
    visit("n_screened", self.n_screened);
    visit("rollouts", self.rollouts);
    visit("lift_held", self.lift_held);
    visit("source", self.source);
    visit("fingers", self.fingers);
    visit("kept", self.kept);
    visit("contacts", self.contacts);
    visit("moved_mm", self.moved_mm);
    visit("turned_deg", self.turned_deg);
    visit("neighbour_moved_mm", self.neighbour_moved_mm);
    visit("start_certified", self.start_certified);
    visit("mu_star", self.mu_star);
    visit("robust_held", self.robust_held);
    visit("seconds", self.seconds);
  }
  bool ok() const { return status == "ok"; }
};

Row MakeRow(const RunSummary& summary) {
  Row row;
  row.scene = summary.scene;
  row.seed = summary.seed;
  row.status = summary.status;
  row.r_suc = summary.r_suc;
  row.r_suc_raw = summary.r_suc_raw;
  row.r_lift = summary.r_lift;
  row.n_paths = summary.n_paths;
  row.n_screened = summary.n_screened;
  row.rollouts = summary.counts.rollouts;
  row.lift_held = summary.lift.held;
  row.source = summary.grasps.source;
  row.fingers = summary.grasps.fingers;
  row.kept = summary.grasps.kept;
  row.contacts = summary.contacts;
  row.moved_mm = 1e3 * summary.object_motion.translation_m;
  row.turned_deg = summary.object_motion.rotation_deg;
  row.neighbour_moved_mm = summary.neighbours.moved_mm;
  row.start_certified = summary.start_grasps.certified;
  row.mu_star = summary.start_grasps.mu_star;
  row.robust_held = summary.robust.held;
  row.seconds = *summary.seconds.total;
  return row;
}

class Table1 : public Study {
 public:
  explicit Table1(const StudySetup& setup) : setup_(setup) {}

  std::int64_t num_items() const override {
    return static_cast<std::int64_t>(setup_.scenes.size()) * setup_.seeds;
  }

  nlohmann::ordered_json MakeItem(std::int64_t index) const override {
    const Scene& scene = setup_.scenes[index / setup_.seeds];
    SessionConfig config;
    config.seed = setup_.first_seed + static_cast<std::uint64_t>(index % setup_.seeds);
    config.threads = setup_.threads;
    config.planner = setup_.planner;
    config.weights = setup_.weights;
    config.command = fmt::format("pregrasp run {} --seed {}", scene.file, config.seed);
    const auto start = std::chrono::steady_clock::now();
    Session session(scene, config);
    if (!setup_.runs.empty()) {
      session.Record(setup_.runs / fmt::format("{}-{}", scene.name, config.seed),
                     PictureMode::kNone);
    }
    const RunResult result = RunPlanner(session.timeline(), setup_.run, {});
    RunSummary summary = Summarize(session.timeline(), *result.end);
    summary.status = result.status;
    summary.seconds.total =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    session.FinishRecording(std::nullopt, result.end);
    return fields::Write(MakeRow(summary));
  }

 private:
  StudySetup setup_;
};

// Tables.
// ------------------------------------------------------------------------------------------

// What the paper's table has of a task: mean (standard deviation) of three runs.
struct PaperRow {
  const char* task;
  const char* r_suc;
  const char* n_paths;
};
// By scene; the paper has one row for its keyboard, and a bottle of water where we have a carton.
const std::map<std::string, PaperRow>& PaperRows() {
  static const std::map<std::string, PaperRow> rows = {
      {"book", {"Bookshelf", "0.917 (0.058)", "1.667 (1.155)"}},
      {"plate", {"Plate", "0.800 (0.050)", "1.667 (1.155)"}},
      {"marker", {"Marker", "0.933 (0.058)", "3.667 (2.082)"}},
      {"ruler", {"Ruler", "0.817 (0.144)", "3.333 (1.528)"}},
      {"water", {"Waterbottle", "0.850 (0.180)", "3.000 (1.732)"}},
      {"container", {"Food container", "0.733 (0.340)", "2.000 (1.000)"}},
      {"keyboard_edge", {"Keyboard", "0.817 (0.076)", "1.667 (0.577)"}},
      {"keyboard_wall", {"Keyboard", "0.817 (0.076)", "1.667 (0.577)"}},
      {"cardboard", {"Cardboard", "0.800 (0.229)", "1.333 (0.577)"}},
  };
  return rows;
}

template <typename Value>
std::vector<double> Collect(const std::vector<const Row*>& rows, std::optional<Value> Row::*field) {
  std::vector<double> values;
  for (const Row* row : rows) {
    if (row->*field) values.push_back(static_cast<double>(*(row->*field)));
  }
  return values;
}

std::string FingersText(const std::vector<Finger>& fingers) {
  std::string text;
  for (const Finger finger : fingers) {
    text += (text.empty() ? "" : "+") + std::string(FingerName(finger));
  }
  return text.empty() ? "none" : text;
}

// "index 12, then thumb+index 3/12": fingers and triangles by stage.
std::string ContactsText(const Row& row) {
  if (!row.contacts) return "";
  std::string text;
  for (const RunSummary::Stage& stage : *row.contacts) {
    std::string triangles;
    for (const int triangle : stage.triangles) {
      triangles += (triangles.empty() ? " " : "/") + std::to_string(triangle);
    }
    text += (text.empty() ? "" : ", then ") + FingersText(stage.fingers) + triangles;
  }
  return text;
}

// Which fingers did it, most often first, and how far that took the object.
std::string StrategyText(const std::vector<const Row*>& rows) {
  if (rows.empty()) return "-";
  std::map<std::string, int> counts;
  std::vector<double> moved, turned, neighbours;
  for (const Row* row : rows) {
    std::string last;
    if (row->contacts && !row->contacts->empty()) last = FingersText(row->contacts->back().fingers);
    ++counts[last];
    moved.push_back(row->moved_mm);
    turned.push_back(row->turned_deg);
    if (row->neighbour_moved_mm) neighbours.push_back(*row->neighbour_moved_mm);
  }
  std::vector<std::pair<std::string, int>> order(counts.begin(), counts.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [fingers, count] : order) {
    text += (text.empty() ? "" : ", ") + fmt::format("{} {}x", fingers, count);
  }
  text += fmt::format("; {:.0f} mm, {:.0f} deg", *CalcMedian(moved), *CalcMedian(turned));
  if (!neighbours.empty()) text += fmt::format("; neighbour {:.0f} mm", *CalcMedian(neighbours));
  return text;
}

std::vector<std::string> SummaryRow(const std::string& scene, const std::vector<const Row*>& rows) {
  std::vector<const Row*> ok;
  std::vector<double> seconds;
  for (const Row* row : rows) {
    if (row->ok()) ok.push_back(row);
    seconds.push_back(row->seconds);
  }
  const auto count = static_cast<int>(rows.size());
  const auto [low, high] = CalcWilsonInterval(static_cast<int>(ok.size()), count);
  const auto paper = PaperRows().find(scene);
  const bool known = paper != PaperRows().end();
  return {scene,
          fmt::format("{} of {}", ok.size(), count),
          fmt::format("{:.2f} to {:.2f}", low, high),
          MeanText(Collect(ok, &Row::r_suc)),
          known ? paper->second.r_suc : "",
          MeanText(Collect(ok, &Row::r_suc_raw)),
          MeanText(Collect(ok, &Row::r_lift)),
          MeanText(Collect(ok, &Row::n_paths)),
          known ? paper->second.n_paths : "",
          MeanText(Collect(ok, &Row::n_screened)),
          MeanText(Collect(rows, &Row::rollouts)),
          fmt::format("{:.0f} / {:.0f}", *CalcMedian(seconds),
                      *std::max_element(seconds.begin(), seconds.end())),
          StrategyText(ok)};
}

std::string MarkdownText(const std::vector<Row>& rows) {
  std::vector<std::string> scenes;  // in the order of the items
  std::map<std::string, std::vector<const Row*>> by_scene;
  for (const Row& row : rows) {
    if (by_scene[row.scene].empty()) scenes.push_back(row.scene);
    by_scene[row.scene].push_back(&row);
  }
  std::vector<std::vector<std::string>> table = {
      {"scene", "ok", "95 % interval", "r_suc", "paper's", "r_suc raw", "r_lift", "N_paths",
       "paper's", "screened", "rollouts", "seconds, median / worst", "strategy"}};
  for (const std::string& scene : scenes) table.push_back(SummaryRow(scene, by_scene[scene]));
  std::vector<std::vector<std::string>> runs = {
      {"scene", "seed", "status", "r_suc", "N_paths", "grasp from", "contacts", "seconds"}};
  for (const Row& row : rows) {
    runs.push_back({row.scene, std::to_string(row.seed), row.status.value_or("-"),
                    row.r_suc ? fmt::format("{:.2f}", *row.r_suc) : "-",
                    row.n_paths ? std::to_string(*row.n_paths) : "-", row.source.value_or("-"),
                    ContactsText(row), fmt::format("{:.1f}", row.seconds)});
  }
  return "Means (standard deviations) are over the runs that are ok, seconds and rollouts over "
         "all.\nr_suc is the share of the generated grasps that are feasible, raw without "
         "refinement. Each is the first of up to\ngrasps.draws draws whose forces hold, and "
         "completes contacts in which a trial draw was feasible (grasps.pilots); trials do\nnot "
         "count. Of the plans of a path with at least half as many lifting grasps as any, the one "
         "that holds in most of five changed\nworlds is taken. r_lift is the share that is lifted "
         "too. N_paths counts full optimisations until success; rollouts do not\ncount the "
         "simulations of the better ones in two other worlds. The strategy is the fingers of the "
         "last stage, and how far\n(medians) the object moved and turned until it was grasped. The "
         "paper's columns are its table of all tasks, three runs each.\n\n" +
         MarkdownTable(table) + "\nEvery run:\n\n" + MarkdownTable(runs);
}

std::string CsvText(const std::vector<Row>& rows) {
  std::vector<nlohmann::ordered_json> records;
  for (const Row& row : rows) {
    records.push_back(fields::Write(row));
    records.back()["contacts"] = ContactsText(row);
  }
  return CsvTable(records);
}

StudyFiles TabulateTable1(const std::vector<nlohmann::json>& items) {
  const std::vector<Row> rows = ReadItems<Row>(items);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows) list.push_back(fields::Write(row));
  return {{"table1.json", FormatJsonIndented(list)},
          {"table1.csv", CsvText(rows)},
          {"table1.md", MarkdownText(rows)}};
}

std::string DescribeTable1Item(const nlohmann::json& item) {
  const Row row = ReadItems<Row>({item}).front();
  return fmt::format("{} seed {}: {}, {} paths, {:.1f} s", row.scene, row.seed,
                     row.status.value_or("-"), row.n_paths.value_or(0), row.seconds);
}

}  // namespace

StudyInfo Table1Study() {
  return {.name = "table1",
          .text = "every scene with every seed, beside the paper's figures",
          .make = MakeStudy<Table1>,
          .describe = DescribeTable1Item,
          .tabulate = TabulateTable1};
}

}  // namespace pregrasp
