// The fields of steps and scenes, as cards and tables name them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/pictures/words.h"
#include "app/scene/finger.h"

namespace pregrasp {
namespace {

const std::map<std::string, std::string>& WordsOfFields() {
  static const std::map<std::string, std::string> kWords = {
      {"t", "time [s]"},
      {"details.best_cost", "best cost"},
      {"details.clearance_mm", "clearance [mm]"},
      {"details.height_m", "height lifted [m]"},
      {"details.hold_shift_mm", "moves while held [mm]"},
      {"details.hold_turn_deg", "turns while held [deg]"},
      {"details.margin", "margin"},
      {"details.max_force_N", "largest force [N]"},
      {"details.max_speed", "largest speed [m/s]"},
      {"details.mean_cost", "mean cost"},
      {"details.min_clearance_mm", "least clearance [mm]"},
      {"details.min_normal_N", "least normal force [N]"},
      {"details.moved_mm", "moved [mm]"},
      {"details.mu", "friction of fingertips"},
      {"details.mu_star", "friction up to which the proof holds"},
      {"details.physics_steps", "physics steps"},
      {"details.released_shift_mm", "moves if released [mm]"},
      {"details.released_turn_deg", "turns if released [deg]"},
      {"details.rest_reward", "worth of doing nothing"},
      {"details.rotated_deg", "turned [deg]"},
      {"details.score", "score"},
      {"details.score_scale", "weight of the terms that break ties"},
      {"details.shift_mm", "off its way [mm]"},
      {"details.slip_mm", "fingertips slid [mm]"},
      {"details.step_shift_mm", "elsewhere at half the step [mm]"},
      {"details.step_turn_deg", "turned elsewhere at half the step [deg]"},
      {"details.tip_error_mm", "tip error [mm]"},
      {"details.max_tip_error_mm", "largest tip error [mm]"},
      {"details.turn_deg", "turned off its way [deg]"},
      {"details.value", "worth"}};
  return kWords;
}

// Names that stand within others, and what they are measured in.
struct PartWords {
  std::string words, unit;
};

const std::map<std::string, PartWords>& WordsOfParts() {
  static const std::map<std::string, PartWords> kWords = {
      {"X_WB", {"pose", ""}},
      {"X_WH", {"palm's pose", ""}},
      {"command", {"what was asked for", ""}},
      {"contacts", {"contact", ""}},
      {"cost", {"cost", ""}},
      {"f_O", {"force, in the object's frame", "N"}},
      {"f_W", {"force", "N"}},
      {"final_score", {"score at the end", ""}},
      {"friction", {"friction", ""}},
      {"gravity", {"gravity", "m/s^2"}},
      {"grip", {"contact", ""}},
      {"inertia", {"inertia", "kg m^2"}},
      {"initial", {"states that may begin, the one in place", ""}},
      {"kept", {"states kept, the one in place", ""}},
      {"mass", {"mass", "kg"}},
      {"max_force", {"largest force", "N"}},
      {"max_penetration_mm", {"deepest overlap", "mm"}},
      {"max_tip_overlap_mm", {"deepest overlap of a fingertip", "mm"}},
      {"nhat_O", {"normal, in the object's frame", ""}},
      {"nhat_W", {"normal", ""}},
      {"on", {"whether it takes part", ""}},
      {"p_OC", {"contact, in the object's frame", "m"}},
      {"p_O_com", {"centre of mass", "m"}},
      {"p_W", {"place", "m"}},
      {"p_WB", {"place", "m"}},
      {"p_WF", {"place", "m"}},
      {"p_WO_end", {"place where it leaves the object", "m"}},
      {"p_WTarget", {"target", "m"}},
      {"p_WTargets", {"target", "m"}},
      {"q", {"joint angle", "rad"}},
      {"q_WB", {"turn as a quaternion", ""}},
      {"q_WO_end", {"turn in which it leaves the object, as a quaternion", ""}},
      {"reward", {"worth", ""}},
      {"rollouts", {"plan", ""}},
      {"room", {"room for grasps", ""}},
      {"s_c", {"score here of state", ""}},
      {"s_n", {"score without surroundings of state", ""}},
      {"slip", {"way slid", "m"}},
      {"slipping", {"whether it slides", ""}},
      {"stage_scores", {"score, stage", ""}},
      {"stages", {"stage", ""}},
      {"terms", {"cost term", ""}},
      {"touching", {"whether it touches", ""}},
      {"v_WB", {"speed", "m/s"}},
      {"v_slip_W", {"speed of sliding", "m/s"}},
      {"w_WB", {"rate of turning", "rad/s"}}};
  return kWords;
}

struct FieldPart {
  std::string name;
  std::vector<int> indices;
};

// "rollouts[3].p_WO_end[0]" as its parts.
std::vector<FieldPart> SplitField(const std::string& field) {
  std::vector<FieldPart> parts(1);
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field[i] == '.') {
      parts.emplace_back();
    } else if (field[i] == '[') {
      parts.back().indices.push_back(std::atoi(field.c_str() + i + 1));
      i = std::min(field.find(']', i), field.size() - 1);
    } else {
      parts.back().name += field[i];
    }
  }
  return parts;
}

bool IsLower(char c) { return c >= 'a' && c <= 'z'; }

// What is not in the table: "released_shift_mm" is "released shift", in mm, "thumb_p_OC_x" is
// "thumb p_OC_x".
PartWords SpellOut(std::string name) {
  static const std::pair<const char*, const char*> kUnits[] = {
      {"_mm", "mm"}, {"_deg", "deg"}, {"_N", "N"}, {"_m", "m"}, {"_t", "s"}, {"_seconds", "s"}};
  PartWords words;
  for (const auto& [ending, unit] : kUnits) {
    const std::string text = ending;
    if (name.size() > text.size() &&
        name.compare(name.size() - text.size(), text.size(), text) == 0) {
      words.unit = unit;
      name.resize(name.size() - text.size());
      break;
    }
  }
  for (std::size_t i = 1; i + 1 < name.size(); ++i) {
    if (name[i] == '_' && IsLower(name[i - 1]) && IsLower(name[i + 1])) name[i] = ' ';
  }
  words.words = name;
  return words;
}

// A vector's elements have the names of axes, others numbers from 1; states and triangles are
// counted from 0 everywhere.
std::string WordOfIndex(const std::string& name, int index) {
  static const char* const kAxes[] = {"x", "y", "z"};
  const bool vector = name.size() > 2 && name[1] == '_' && name != "s_c" && name != "s_n" &&
                      name[0] != 'q' && name != "p_WTargets";
  if (vector || name == "gravity") return index < 3 ? fmt::format(", {}", kAxes[index]) : "";
  if (name == "s_c" || name == "s_n") return fmt::format(" {}", index);
  return fmt::format(" {}", index + 1);
}

}  // namespace

std::string DescribeField(const std::string& field) {
  const auto found = WordsOfFields().find(field);
  if (found != WordsOfFields().end()) return found->second;
  std::string text, unit;
  for (const FieldPart& part : SplitField(field)) {
    if (part.name == "details" || part.name.empty()) continue;
    if (!text.empty()) text += ": ";
    unit.clear();
    if (part.name == "bodies" && !part.indices.empty()) {
      text += part.indices[0] == 0 ? "the object" : fmt::format("body {}", part.indices[0] + 1);
      continue;
    }
    if (part.name == "fingers" && !part.indices.empty() && part.indices[0] < kNumFingers) {
      text += kFingerNames[static_cast<std::size_t>(part.indices[0])];
      continue;
    }
    const auto known = WordsOfParts().find(part.name);
    const PartWords words = known != WordsOfParts().end() ? known->second : SpellOut(part.name);
    text += words.words;
    unit = words.unit;
    for (const int index : part.indices) text += WordOfIndex(part.name, index);
  }
  if (!unit.empty()) text += fmt::format(" [{}]", unit);
  return text;
}

std::string DescribeValue(const std::string& value, const std::string& other) {
  const auto number = [](const std::string& text) -> std::optional<double> {
    char* end = nullptr;
    const double parsed = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') return std::nullopt;
    return parsed;
  };
  const std::optional<double> one = number(value), two = number(other);
  if (!one || !two) return value;
  for (int digits = 4; digits < 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", *one, digits);
    if (text != fmt::format("{:.{}g}", *two, digits)) return text;
  }
  return value;
}

}  // namespace pregrasp
