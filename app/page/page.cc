#include "app/page/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "app/core/error.h"
#include "app/core/json_values.h"
#include "app/page/html_text.h"
#include "app/page/page_graph.h"
#include "app/page/page_space.h"
#include "app/page/page_tables.h"
#include "app/page/run_steps.h"
#include "app/page/strip.h"
#include "app/pictures/words.h"
#include "app/recording/checked_file.h"
#include "app/session/picture_file.h"
#include "render/jpeg.h"

namespace pregrasp {
namespace {

constexpr std::size_t kMostPictures = 32;
constexpr int kPictureWidth = 960, kPictureHeight = 540;  // [pixels]
constexpr std::size_t kMostPictureBytes = 2'600'000;      // of all, as files

// The heading under which a step is told, by what made it.
const char* Chapter(Verb verb) {
  switch (verb) {
    case Verb::kOpen:
    case Verb::kSettle:
    case Verb::kVerdict:
      return "The start";
    case Verb::kMesh:
    case Verb::kScore:
    case Verb::kPrune:
      return "Where fingers may touch";
    case Verb::kPath:
    case Verb::kScreen:
      return "Which contacts, in which order";
    case Verb::kIterate:
    case Verb::kCertify:
      return "The push";
    case Verb::kGrasp:
      return "The grasp";
    case Verb::kLift:
      return "The lift";
    case Verb::kKeyframe:
    case Verb::kFill:
    case Verb::kSmooth:
    case Verb::kFrame:
      return "The hand";
    case Verb::kTouch:
    case Verb::kLetGo:
    case Verb::kMove:
    case Verb::kWait:
      return "The simulation";
  }
  return "";
}

nlohmann::ordered_json CameraJson(const CameraConfig& camera) {
  return {{"p_WCam", ToJson(camera.p_WCam)},
          {"p_WTarget", ToJson(camera.p_WTarget)},
          {"fov_deg", camera.fov_deg}};
}

class Page {
 public:
  // In brief, what did not lead to the result says one sentence and has no place in space.
  Page(const LoadedRun& run, bool brief) : run_(run), steps_(run), brief_(brief) {}

  std::string Make() {
    story_ = steps_.FindStory(kMostPictures);
    tried_ = TriedTables(run_, steps_);
    DrawPictures();
    std::string html = Head();
    html += "<header><p class=\"where\">pregrasp</p>\n<h1>" + EscapeHtml(run_.summary.scene) +
            ", seed " + std::to_string(run_.summary.seed) + " " + Badge() + "</h1>\n" + Key() +
            "</header>\n" + Contents() + "<main>\n";
    html += Section("short", "In short", InShort());
    html += Section("result", "The result in numbers", ResultTables(run_.summary));
    html += SpaceSection();
    html += Section("story", "What happened, and why", Story());
    html += GraphSection();
    html += CostSection();
    html += Section("tried", "What was tried", tried_);
    html += Section("steps", "All steps", AllSteps());
    html += Section("made", "How this run was made", MadeOfTables(run_));
    html += "</main>\n";
    nlohmann::ordered_json space = PageSpace(run_, Pointers());
    space["cameras"] = {{"story", CameraJson(story_camera_)},
                        {"film", CameraJson(film_camera_ ? *film_camera_ : story_camera_)}};
    html +=
        "<script type=\"application/json\" id=\"space-data\">" + ScriptJson(space) + "</script>\n";
    for (const char* script : {"turntable.js", "space.js", "graph.js", "steps.js"}) {
      html += fmt::format("<script>\n{}</script>\n", PageAsset(script));
    }
    return html + "</body>\n</html>\n";
  }

 private:
  bool InBrief(const StepFacts& step) const { return brief_ && !steps_.IsOnWay(step); }

  std::vector<const StepFacts*> Pointers() const {
    std::vector<const StepFacts*> all;
    for (const StepFacts& step : run_.steps) all.push_back(InBrief(step) ? nullptr : &step);
    return all;
  }

  void DrawPictures() {
    PictureDrawer drawer(run_.scene, LabelsOf(run_));
    Shot shot;
    shot.config.width = kPictureWidth;
    shot.config.height = kPictureHeight;
    shot.config.card = shot.config.footer = false;
    shot.config.font_scale = 1.25;
    // One camera for what the object does, one for the hand, which comes from far off.
    std::vector<const StepFacts*> planned, hand;
    for (const StepFacts* step : story_) {
      if (step->command.verb == Verb::kVerdict) continue;  // looks as what it is a verdict on
      (std::holds_alternative<FrameFacts>(step->details) ? hand : planned).push_back(step);
    }
    std::map<const StepFacts*, Image> images;
    const std::array<std::vector<const StepFacts*>, 2> strips{planned, hand};
    for (const auto& strip : strips) {
      if (strip.empty()) continue;
      shot.config.camera = drawer.FrameSteps(strip, run_, shot.config);
      if (&strip == &strips.front()) story_camera_ = *shot.config.camera;
      if (&strip == &strips.back()) film_camera_ = *shot.config.camera;
      const CameraConfig camera = *shot.config.camera;
      for (const StepFacts* step : strip) {
        shot.config.camera = drawer.FrameOnWay(camera, *step, run_, shot.config);
        images[step] = drawer.Render(*step, run_, shot);
      }
    }
    for (const int quality : {86, 74, 60, 45, 30}) {
      std::size_t bytes = 0;
      for (const auto& [step, image] : images) {
        std::string& jpeg = pictures_[step];
        jpeg = EncodeJpeg(image, quality);
        bytes += jpeg.size();
      }
      if (bytes <= kMostPictureBytes) return;
    }
  }

  std::vector<std::string> Words(const StepFacts& step) const {
    return DescribeStep(run_.scene, step, run_);
  }

  std::string Head() const {
    const std::string title =
        EscapeHtml(fmt::format("{}, seed {}: {}", run_.summary.scene, run_.summary.seed,
                               run_.summary.status.value_or("no plan")));
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<meta name=\"color-scheme\" content=\"light dark\">\n"
           "<link rel=\"icon\" href=\"data:,\">\n<title>" +
           title + "</title>\n<style>\n" + PageAsset("page.css") + PageAsset("figures.css") +
           "</style>\n</head>\n<body>\n";
  }

  std::string Badge() const {
    const std::string status = run_.summary.status.value_or("no plan");
    const char* kind = status == "ok" ? "good" : run_.summary.status ? "bad" : "plain";
    return fmt::format("<span class=\"badge {}\">{}</span>", kind, EscapeHtml(status));
  }

  // The picture that says most: where the way ends, or the last one that was drawn.
  std::string Key() const {
    const StepFacts* last = nullptr;
    for (const StepFacts* step : story_) {
      if (steps_.IsOnWay(*step) && pictures_.count(step) > 0) last = step;
    }
    return last == nullptr ? "" : Picture(*last, false);
  }

  std::string Picture(const StepFacts& step, bool named) const {
    const auto found = pictures_.find(&step);
    if (found == pictures_.end()) return "";
    const std::vector<std::string> words = Words(step);
    const std::string text = words.empty() ? step.id : words.front();
    return fmt::format(
        "<img src=\"data:image/jpeg;base64,{}\" width=\"{}\" height=\"{}\" alt=\"{}\"{}>",
        Base64(found->second), kPictureWidth, kPictureHeight,
        EscapeHtml(step.id + ": " + text.substr(0, text.find('\t'))),
        named ? fmt::format(" data-picture=\"{}\"", steps_.NumberOf(step)) : "");
  }

  std::string Contents() const {
    std::string html = "<nav aria-label=\"Contents\"><ul>\n";
    const auto add = [&](const char* id, const char* title) {
      html += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, title);
    };
    add("short", "In short");
    add("result", "Numbers");
    html += "<li class=\"scripted\"><a href=\"#space\">In space</a></li>\n";
    add("story", "What happened");
    if (graph()) add("graph", "Contact graph");
    if (HasCosts()) add("costs", "Costs");
    if (!tried_.empty()) add("tried", "Tried");
    add("steps", "All steps");
    add("made", "Made of");
    return html + "</ul></nav>\n";
  }

  static std::string Section(const char* id, const char* title, const std::string& content) {
    if (content.empty()) return "";
    return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, content);
  }

  // What screening found of a path, beside the others: "" for none.
  std::string Screening(int rank) const {
    std::map<int, const ScreenFacts*> last;  // by path
    for (const StepFacts& step : run_.steps) {
      if (const auto* screen = std::get_if<ScreenFacts>(&step.details)) last[screen->path] = screen;
    }
    const auto own = last.find(rank);
    if (own == last.end()) return "";
    const double value = own->second->value;
    const auto better = std::count_if(
        last.begin(), last.end(), [&](const auto& other) { return other.second->value > value; });
    return fmt::format(
        " Of {} paths that were screened {}: {:.3f}, where doing nothing is worth {:.3f}.",
        last.size(),
        better == 0   ? "it is worth most"
        : better == 1 ? "one is worth more"
                      : fmt::format("{} are worth more", better),
        value, own->second->rest_reward);
  }

  // One sentence of each kind of decision on the way, the last of its kind.
  std::string InShort() const {
    std::map<int, std::pair<int, std::string>> said;  // by rank in the story: number, sentence
    const auto say = [&](int rank, const StepFacts& step) {
      std::string text;
      for (const std::string& line : Words(step)) {
        if (line.find('\t') == std::string::npos) text += (text.empty() ? "" : " ") + line;
      }
      if (const auto* path = std::get_if<PathFacts>(&step.details)) text += Screening(path->rank);
      if (std::holds_alternative<CertifyFacts>(step.details)) {
        for (const std::string& line : Words(step)) {  // what moves the object
          const std::size_t tab = line.find('\t');
          if (tab == std::string::npos || line.rfind("stage ", 0) != 0) continue;
          text += fmt::format(" S{}: {}.", line.substr(1, tab - 1), line.substr(tab + 1));
        }
      }
      if (!text.empty()) said[rank] = {steps_.NumberOf(step), text};
    };
    for (const StepFacts& step : run_.steps) {
      const bool on_way = steps_.IsOnWay(step);
      switch (step.command.verb) {
        case Verb::kVerdict:
          say(0, step);
          break;
        case Verb::kPath:
          if (on_way) say(1, step);
          break;
        case Verb::kCertify:
          if (on_way) say(2, step);
          break;
        case Verb::kSmooth:
          if (on_way) say(5, step);
          break;
        case Verb::kTouch:
        case Verb::kLetGo:
        case Verb::kMove:
        case Verb::kWait:
          if (on_way) say(6, step);
          break;
        default:
          break;
      }
    }
    if (const StepFacts* grasp = FindGrasp(steps_.way())) say(3, *grasp);
    if (const StepFacts* lift = FindLift(steps_.way())) say(4, *lift);
    if (said.empty() && !Words(steps_.end()).empty()) say(7, steps_.end());
    std::string html;
    for (const auto& [rank, sentence] : said) {
      html +=
          fmt::format("<li>{} <a class=\"step\" href=\"#row-{}\" data-step=\"{}\">{}</a></li>\n",
                      EscapeHtml(sentence.second), sentence.first, sentence.first,
                      EscapeHtml(run_.steps[static_cast<std::size_t>(sentence.first) - 1].id));
    }
    const std::string status = fmt::format("<p>Status: <b>{}</b>.</p>\n",
                                           EscapeHtml(run_.summary.status.value_or("no plan")));
    return html.empty() ? status : status + "<ol class=\"short\">\n" + html + "</ol>\n";
  }

  std::string Story() const {
    std::string html =
                    "<p class=\"hint\">In the order in which it was computed, the hand's motion in "
                    "time.</p>\n",
                chapter;
    for (const StepFacts* step : story_) {
      const std::string heading = Chapter(step->command.verb);
      if (heading != chapter) html += "<h3>" + heading + "</h3>\n";
      chapter = heading;
      html += fmt::format(
          "<figure class=\"step\" id=\"step-{0}\">\n{1}<figcaption>\n<h4><code>{2}</code> "
          "<span class=\"time\">t = {3:.2f} s</span>{4}</h4>\n{5}</figcaption></figure>\n",
          steps_.NumberOf(*step), Picture(*step, true), EscapeHtml(step->id), step->t,
          steps_.IsOnWay(*step) || step->command.verb == Verb::kVerdict
              ? ""
              : " <span class=\"aside\">not on the way to the result</span>",
          LinesToHtml(Words(*step)));
    }
    return html;
  }

  const std::optional<ContactGraph>& graph() const {
    if (!restored_) {
      graph_ = RestoreGraph(run_);
      restored_ = true;
    }
    return graph_;
  }

  std::string GraphSection() const {
    if (!graph()) return "";
    std::string html =
        "<p>" + EscapeHtml(GraphWords()) +
        " With scripts, states that were pruned are pale, and any can be asked.</p>\n";
    html += "<div class=\"graph\" id=\"graph-view\"><div class=\"matrix-box\">" +
            GraphSvg(*graph()) + "</div><div class=\"scripted graph-side\"></div></div>\n";
    html += ReasonList("Why the states of the path are in it", StatesOfPath(), " open");
    html += ReasonList("Why the next ones are not", NextPruned(), " open");
    std::vector<int> best = graph()->kept();
    std::stable_sort(best.begin(), best.end(), [this](int a, int b) {
      return graph()->nodes()[a].rank_c < graph()->nodes()[b].rank_c;
    });
    constexpr std::size_t kListed = 12;
    if (best.size() > kListed) best.resize(kListed);
    html += ReasonList(fmt::format("The best {} of those that were kept", best.size()), best, "");
    html += "<script type=\"application/json\" id=\"graph-data\">" +
            ScriptJson(PageGraph(*graph())) + "</script>\n";
    return Section("graph", "The contact graph", html);
  }

  // The states of the path that led to the result, in its order, each once.
  std::vector<int> StatesOfPath() const {
    std::vector<int> states;
    for (const StepFacts* step : steps_.way()) {
      const auto* path = std::get_if<PathFacts>(&step->details);
      if (path == nullptr) continue;
      states.clear();  // the last one that was followed
      for (const NodeFacts& node : path->nodes) {
        if (std::find(states.begin(), states.end(), node.id) == states.end()) {
          states.push_back(node.id);
        }
      }
    }
    return states;
  }

  // Those that were pruned and have the best rank, by each score.
  std::vector<int> NextPruned() const {
    std::vector<int> next;
    for (const auto rank : {&ContactNode::rank_c, &ContactNode::rank_n}) {
      const ContactNode* best = nullptr;
      for (const ContactNode& node : graph()->nodes()) {
        if (graph()->Why(node.id).verdict != NodeReason::Verdict::kPruned) continue;
        if (best == nullptr || node.*rank < best->*rank) best = &node;
      }
      if (best != nullptr && (next.empty() || next.front() != best->id)) next.push_back(best->id);
    }
    return next;
  }

  std::string ReasonList(const std::string& title, const std::vector<int>& nodes,
                         const char* open) const {
    std::string list;
    for (const int id : nodes) {
      list += "<li>" + EscapeHtml(DescribeReason(graph()->Why(id))) + ".</li>\n";
    }
    if (list.empty()) return "";
    return fmt::format("<details{}><summary>{}</summary>\n<ul>\n{}</ul></details>\n", open, title,
                       list);
  }

  bool HasCosts() const {
    return std::any_of(run_.steps.begin(), run_.steps.end(),
                       [](const StepFacts& step) { return step.command.verb == Verb::kIterate; });
  }

  std::string CostSection() const {
    std::string html;
    for (const CostPlot& plot : MakeCostPlots(run_)) {
      html += "<figure>" + ToSvg(plot) + "<figcaption><p>" + EscapeHtml(plot.title) +
              ".</p></figcaption></figure>\n";
    }
    return Section("costs", "What the iterations gained", html);
  }

  std::string SpaceSection() const {
    return "<section id=\"space\" class=\"scripted\">\n<h2>The motion in space</h2>\n"
           "<div id=\"film-view\"></div>\n</section>\n";
  }

  std::string AllSteps() const {
    std::string html =
        "<div id=\"step-view\" class=\"scripted\"></div>\n<details id=\"step-list\"><summary>" +
        std::to_string(run_.steps.size()) +
        " steps as a list</summary>\n<div class=\"wide\"><table><thead><tr><th scope=\"col\"></th>"
        "<th scope=\"col\">step</th><th scope=\"col\">made from</th><th scope=\"col\">t</th><th "
        "scope=\"col\">what it says</th></tr></thead>\n<tbody>\n";
    int number = 0;
    for (const StepFacts& step : run_.steps) {
      ++number;
      std::vector<std::string> words = Words(step);
      if (InBrief(step)) words.resize(std::min<std::size_t>(words.size(), 1));
      html += fmt::format(
          "<tr id=\"row-{0}\"><td>{0}</td><td><code>{1}</code></td><td><code>{2}</code></td>"
          "<td>{3:.2f}&nbsp;s</td><td>{4}</td></tr>\n",
          number, EscapeHtml(step.id), EscapeHtml(step.command.node), step.t, LinesToHtml(words));
    }
    return html + "</tbody></table></div></details>\n";
  }

  const LoadedRun& run_;
  const RunSteps steps_;
  const bool brief_;
  std::vector<const StepFacts*> story_;
  std::map<const StepFacts*, std::string> pictures_;  // JPEG files' bytes
  std::string tried_;
  CameraConfig story_camera_;
  std::optional<CameraConfig> film_camera_;
  mutable std::optional<ContactGraph> graph_;
  mutable bool restored_ = false;
};

}  // namespace

std::string MakePage(const LoadedRun& run) {
  std::string page = Page(run, false).Make();
  if (page.size() > kMostPageBytes) page = Page(run, true).Make();
  if (page.size() > kMostPageBytes) {
    throw InputError(run.directory.string(), "",
                     fmt::format("a run whose page is at most {} bytes", kMostPageBytes),
                     std::to_string(page.size()));
  }
  return page;
}

void WritePage(const LoadedRun& run, const std::filesystem::path& file) {
  WriteFile(file, MakePage(run));
}

}  // namespace pregrasp
