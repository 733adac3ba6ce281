#include "app/page/page_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "app/job/planner_settings.h"
#include "app/page/cost_plot.h"
#include "app/page/html_text.h"
#include "app/pictures/words.h"

namespace pregrasp {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

// Adds rows of what is known.
class FactRows {
 public:
  template <typename T>
  FactRows& Add(const char* name, const std::optional<T>& value, const char* format = "{}") {
    if (value) rows_.emplace_back(name, Text(*value, format));
    return *this;
  }
  FactRows& Add(const char* name, double value, const char* format) {
    return Add(name, std::optional<double>(value), format);
  }
  FactRows& AddText(const std::string& name, const std::string& value) {
    if (!value.empty()) rows_.emplace_back(name, value);
    return *this;
  }
  std::string Table(const char* caption) const { return FactTable(caption, rows_); }

 private:
  static std::string Text(bool value, const char* /*format*/) { return value ? "yes" : "no"; }
  static std::string Text(const std::vector<Finger>& fingers, const char* /*format*/) {
    std::string text;
    for (const Finger finger : fingers) {
      text += (text.empty() ? "" : ", ") + std::string(FingerName(finger));
    }
    return text.empty() ? "none" : text;
  }
  template <typename T>
  static std::string Text(const T& value, const char* format) {
    return fmt::format(fmt::runtime(format), value);
  }
  Rows rows_;
};

std::string Ratio(const std::optional<int>& part, const std::optional<int>& whole) {
  return part && whole ? fmt::format("{} of {}", *part, *whole) : "";
}

std::string StagesTable(const RunSummary& summary) {
  if (!summary.contacts) return "";
  FactRows rows;
  int number = 0;
  for (const RunSummary::Stage& stage : *summary.contacts) {
    std::string text;
    for (std::size_t i = 0; i < stage.fingers.size(); ++i) {
      text += (text.empty() ? "" : "; ") +
              fmt::format("{} on triangle {}", FingerName(stage.fingers[i]),
                          i < stage.triangles.size() ? stage.triangles[i] : -1);
    }
    rows.AddText(fmt::format("stage {}", ++number), text.empty() ? "no finger" : text);
  }
  rows.Add("contacts made, lost or moved", summary.switches);
  return rows.Table("Contact stages");
}

std::string StepLink(const LoadedRun& run, const std::string& id) {
  return fmt::format("<a href=\"#row-{}\" data-step=\"{}\"><code>{}</code></a>",
                     run.number_of.at(id), run.number_of.at(id), EscapeHtml(id));
}

std::string YesNo(bool value) { return value ? "yes" : "no"; }

std::string Join(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : "; ") + text;
  return joined;
}

// One row of a list of alternatives: where it stands, what it is, what became of it.
struct Tried {
  const LoadedRun& run;
  const RunSteps& steps;

  std::string Mark(const StepFacts& step) const {
    return steps.IsOnWay(step) ? "<b title=\"the result came from it\">&#9679;</b>" : "";
  }

  template <typename Facts>
  std::vector<const StepFacts*> All(Verb verb) const {
    std::vector<const StepFacts*> all;
    for (const StepFacts& step : run.steps) {
      if (step.command.verb == verb && std::holds_alternative<Facts>(step.details)) {
        all.push_back(&step);
      }
    }
    return all;
  }

  // A folded table of all steps of a kind, a row each: its mark, its id, and its cells.
  template <typename Facts, typename Cells>
  std::string Table(Verb verb, const char* what, const std::vector<std::string>& columns,
                    const Cells& cells) const {
    std::vector<std::vector<std::string>> rows;
    for (const StepFacts* step : All<Facts>(verb)) {
      rows.push_back({Mark(*step), StepLink(run, step->id)});
      for (std::string& cell : cells(std::get<Facts>(step->details))) {
        rows.back().push_back(std::move(cell));
      }
    }
    if (rows.empty()) return "";
    std::vector<std::string> heads = {"", "step"};
    heads.insert(heads.end(), columns.begin(), columns.end());
    return fmt::format("<details{}><summary>{} {}</summary>\n{}</details>\n",
                       rows.size() <= 8 ? " open" : "", rows.size(), what,
                       HtmlTable("", heads, rows));
  }

  using Cells = std::vector<std::string>;

  std::string Paths() const {
    const auto cells = [this](const PathFacts& path) {
      const ScreenFacts* screen = nullptr;
      const IterationFacts* last = nullptr;
      for (const StepFacts& later : run.steps) {
        if (run.FindBefore<PathFacts>(later) != &path) continue;
        if (const auto* facts = std::get_if<ScreenFacts>(&later.details)) screen = facts;
        if (const auto* facts = std::get_if<IterationFacts>(&later.details)) last = facts;
      }
      std::string nodes;
      for (const NodeFacts& node : path.nodes) {
        nodes += fmt::format("{}thumb {}, index {}", nodes.empty() ? "" : "; then ", node.thumb,
                             node.index);
      }
      return Cells{fmt::format("{:.3f}", path.score), nodes,
                   screen == nullptr
                       ? ""
                       : fmt::format("{:.3f} (doing nothing {:.3f}), round {}", screen->value,
                                     screen->rest_reward, screen->round),
                   last == nullptr ? "" : fmt::format("{:.3f}", last->best_cost)};
    };
    return Table<PathFacts>(Verb::kPath, "paths",
                            {"score", "triangles", "worth in screening", "best cost"}, cells);
  }

  std::string Certificates() const {
    return Table<CertifyFacts>(
        Verb::kCertify, "plans simulated for a certificate",
        {"path", "plan", "certified", "why not", "largest force"}, [](const CertifyFacts& facts) {
          return Cells{std::to_string(facts.path), std::to_string(facts.plan),
                       YesNo(facts.certified), EscapeHtml(Join(facts.reasons)),
                       fmt::format("{:.2f} N", facts.max_force_N)};
        });
  }

  std::string Grasps() const {
    return Table<GraspFacts>(Verb::kGrasp, "grasps tested", {"from", "feasible", "why", "margin"},
                             [](const GraspFacts& facts) {
                               return Cells{
                                   EscapeHtml(fmt::format("{} {}", facts.source, facts.number)),
                                   YesNo(facts.feasible), EscapeHtml(facts.sentence),
                                   facts.margin ? fmt::format("{:.3f}", *facts.margin) : ""};
                             });
  }

  std::string Lifts() const {
    return Table<LiftFacts>(Verb::kLift, "lifts simulated",
                            {"grasp", "held", "why", "came", "fingers slid", "pushes"},
                            [](const LiftFacts& facts) {
                              return Cells{std::to_string(facts.grasp),
                                           YesNo(facts.held),
                                           EscapeHtml(facts.sentence),
                                           fmt::format("{:.1f} mm", 1e3 * facts.height_m),
                                           fmt::format("{:.1f} mm", facts.slip_mm),
                                           facts.held ? fmt::format("{} of 6", facts.pushes) : ""};
                            });
  }
};

}  // namespace

std::string ResultTables(const RunSummary& s) {
  std::string html = "<div class=\"tables\">\n";
  html += FactRows()
              .Add("status", s.status)
              .Add("scene within the physical rules", s.within_rules)
              .Add("object moved", std::optional(1e3 * s.object_motion.translation_m), "{:.1f} mm")
              .Add("object turned", std::optional(s.object_motion.rotation_deg), "{:.1f} deg")
              .Add("its largest speed", std::optional(s.object_motion.max_speed), "{:.3f} m/s")
              .Table("Verdict");
  html += FactRows()
              .Add("grasps tried at the start", s.start_grasps.tried)
              .Add("feasible there", s.start_grasps.feasible)
              .Add("proved ungraspable", s.start_grasps.certified)
              .Add("up to a friction of", s.start_grasps.mu_star, "{:.3g}")
              .Table("Start");
  html += StagesTable(s);
  html += FactRows()
              .AddText("feasible", Ratio(s.grasps.feasible, s.grasps.tried))
              .AddText("lifting", Ratio(s.grasps.lifting, s.grasps.feasible))
              .Add("fingers", s.grasps.fingers)
              .Add("pressing on from the plan", s.grasps.kept)
              .Add("found by", s.grasps.source)
              .Add("margin", s.wrench.margin, "{:.3f}")
              .Add("least normal force", s.wrench.min_normal_N, "{:.2f} N")
              .Table("Grasp");
  html += FactRows()
              .Add("held", s.lift.held)
              .Add("height", s.lift.height_m, "{:.3f} m")
              .Add("fingers slid", s.lift.slip_mm, "{:.2f} mm")
              .Add("turned", s.lift.turn_deg, "{:.2f} deg")
              .Add("pushes withstood, of six", s.lift.pushes)
              .Add("held with half the stiffness", s.lift.soft)
              .Add("held with twice the stiffness", s.lift.stiff)
              .Table("Lift");
  html += FactRows()
              .Add("frames", s.motion.frames)
              .Add("failed", s.motion.failed)
              .Add("loosened", s.motion.loosened)
              .Add("largest tip error", s.motion.max_tip_error_mm, "{:.3f} mm")
              .Add("least clearance", s.motion.min_clearance_mm, "{:.2f} mm")
              .Add("fastest joint", s.motion.max_joint_speed, "{:.2f} rad/s")
              .Add("fastest wrist", s.motion.max_wrist_speed, "{:.2f} m/s")
              .Add("forearm free", s.motion.forearm_free)
              .Add("keyframes solved", s.motion.order)
              .Table("Hand motion");
  html += FactRows()
              .AddText("end alike", Ratio(s.robust.held, s.robust.worlds))
              .Add("worst shift", s.robust.worst_shift_mm, "{:.1f} mm")
              .Add("worst turn", s.robust.worst_turn_deg, "{:.1f} deg")
              .Table("In changed worlds");
  html += FactRows()
              .Add("moved at most", s.neighbours.moved_mm, "{:.2f} mm")
              .Add("turned at most", s.neighbours.turned_deg, "{:.2f} deg")
              .Add("the one that moved most", s.neighbours.worst)
              .Table("Neighbours");
  html += FactRows()
              .Add("friction of fingertips", s.physics.mu_tip, "{:.3g}")
              .Add("largest force", s.physics.max_force_N, "{:.3g} N")
              .Add("deepest overlap", s.physics.max_penetration_mm, "{:.3f} mm")
              .Add("time step", 1e3 * s.physics.dt, "{:.4g} ms")
              .Table("Physics");
  html += FactRows()
              .Add("contact states", s.counts.nodes)
              .Add("kept", s.counts.kept)
              .Add("paths screened", s.n_screened)
              .Add("paths optimised", s.n_paths)
              .Add("iterations", s.counts.iterations)
              .Add("simulated plans", s.counts.rollouts)
              .Table("Counts");
  html += FactRows()
              .Add("in all", s.seconds.total, "{:.2f} s")
              .Add("geometry", s.seconds.geometry, "{:.2f} s")
              .Add("graph", s.seconds.graph, "{:.2f} s")
              .Add("trajectory", s.seconds.trajectory, "{:.2f} s")
              .Add("grasp", s.seconds.grasp, "{:.2f} s")
              .Add("motion", s.seconds.motion, "{:.2f} s")
              .Add("pictures", s.seconds.pictures, "{:.2f} s")
              .Add("memory at most", s.peak_rss_mb, "{:.0f} MB")
              .Table("Time");
  return html + "</div>\n";
}

std::string TriedTables(const LoadedRun& run, const RunSteps& steps) {
  const Tried tried{run, steps};
  const std::string tables = tried.Paths() + tried.Certificates() + tried.Grasps() + tried.Lifts();
  return tables.empty() ? "" : "<p class=\"hint\">&#9679; led to the result.</p>\n" + tables;
}

std::string MadeOfTables(const LoadedRun& run) {
  const nlohmann::json& manifest = run.manifest;
  const auto text = [&](const char* name) {
    const auto found = manifest.find(name);
    return found != manifest.end() && found->is_string() ? found->get<std::string>()
                                                         : std::string();
  };
  std::string html = FactRows()
                         .AddText("made again by", text("command"))
                         .AddText("scene file", text("scene_file"))
                         .AddText("seed", std::to_string(run.summary.seed))
                         .AddText("program", text("planner_version"))
                         .AddText("commit", text("git_hash"))
                         .AddText("compiler", text("compiler"))
                         .AddText("processor", text("processor"))
                         .Add("SHA-256 of the result's tables", run.summary.hash)
                         .Table("This run");
  FactRows changed;
  const nlohmann::json defaults = PlannerSettings({});
  if (const auto settings = manifest.find("settings_at_start"); settings != manifest.end()) {
    for (const auto& [name, value] : settings->items()) {
      if (!defaults.contains(name) || defaults[name] != value) {
        changed.AddText(name, value.dump());
      }
    }
  }
  html += changed.Table("Settings that are not as by default");
  FactRows libraries;
  if (const auto found = manifest.find("libraries"); found != manifest.end()) {
    for (const auto& [name, version] : found->items()) {
      if (version.is_string()) libraries.AddText(name, version.get<std::string>());
    }
  }
  return "<div class=\"tables\">\n" + html + libraries.Table("Libraries") + "</div>\n";
}

}  // namespace pregrasp
