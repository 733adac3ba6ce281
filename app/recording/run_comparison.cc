#include "app/recording/run_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/core/sha256.h"
#include "app/core/text.h"
#include "app/job/facts_json.h"
#include "app/recording/checked_file.h"
#include "app/recording/gzip_file.h"
#include "app/recording/manifest.h"
#include "app/recording/rawlog.h"
#include "app/recording/run_directory.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr char kPictures[] = "pictures.jsonl";
constexpr char kPicturesLog[] = "pictures.rawlog";
constexpr char kPicturesLink[] = "pictures_Images";

Json ParseOrdered(const std::string& text) { return Json::parse(text, nullptr, false); }

// A text among the fields of a line; "" for anything else.
std::string TextIn(const std::string& line, const char* field) {
  const Json value = ParseOrdered(line);
  if (!value.is_object() || !value.contains(field) || !value[field].is_string()) return "";
  return value[field].get<std::string>();
}

// At `separator`; without a piece after a last one.
std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> pieces;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    pieces.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return pieces;
}

std::optional<double> ParseNumber(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// A column whose numbers are choices.
bool IsChoice(const std::string& column) { return EndsWith(column, "_on") || column == "loosened"; }

bool IsOfPictures(const std::string& file) {
  return file.rfind("frames/", 0) == 0 || file == kPictures || file == kPicturesLog ||
         file == kPicturesLink;
}

// What of summary.json and manifest.json the steps decide.
Json Comparable(const std::string& file, Json document, bool to_the_last_bit) {
  if (!document.is_object()) return document;
  if (file == "summary.json") {
    for (const char* field : {"seconds", "peak_rss_mb"}) document.erase(field);
    if (!to_the_last_bit) document.erase("hash");
    return document;
  }
  Json chosen = Json::object();
  for (const char* field : {"seed", "step", "settings_at_start", "configuration"}) {
    if (document.contains(field)) chosen[field] = document[field];
  }
  return chosen;
}

// The files of two runs in the order in which their differences are told.
std::vector<std::string> FilesInOrder(const fs::path& left, const fs::path& right) {
  std::set<std::string> left_over;
  for (const fs::path& directory : {left, right}) {
    for (const std::string& file : ListRunFiles(directory).files) {
      if (!IsOfPictures(file)) left_over.insert(file);
    }
  }
  std::vector<std::string> files = {"steps.jsonl", "journal.jsonl", "scene.json",
                                    "rollout.csv", "lift.csv",      "motion.csv",
                                    "trace.jsonl", "run.rawlog",    "summary.json"};
  files.erase(std::remove_if(files.begin(), files.end(),
                             [&](const std::string& file) { return left_over.erase(file) == 0; }),
              files.end());
  files.insert(files.end(), left_over.begin(), left_over.end());
  return files;
}

}  // namespace

std::string RunDifference::Sentence(const std::string& left, const std::string& right) const {
  const std::string field = value.field.empty() ? "" : value.field + ": ";
  return fmt::format("{}: {}{} {}, {} {}", place, field, left, OneLine(value.left), right,
                     OneLine(value.right));
}

void RunComparison::Add(RunDifference difference) {
  if (done()) return;
  const std::optional<double> distance = difference.value.distance;
  // At 0 another text of the same number counts, too.
  const bool is_small = tolerance_ > 0.0 && distance && *distance <= tolerance_;
  if (!first_ && !is_small) first_ = difference;
  if (!distance) {
    if (!decision_) decision_ = std::move(difference);
  } else if (!largest_ || *distance > *largest_->value.distance) {
    largest_ = std::move(difference);
  }
}

void RunComparison::CompareJson(const std::string& place, const Json& left, const Json& right) {
  VisitDifferences(left, right, [&](const JsonDifference& difference) {
    Add({place, difference});
    return !done();
  });
}

void RunComparison::CompareSteps(const std::string& left, const std::string& right, int number) {
  if (left == right || done()) return;
  const Json step = ParseOrdered(left), other = ParseOrdered(right);
  const auto id = other.is_object() ? other.find("id") : other.end();
  const bool named = id != other.end() && id->is_string();
  CompareJson(named ? id->get<std::string>() : fmt::format("steps.jsonl, line {}", number), step,
              other);
}

void RunComparison::CompareLines(const std::string& file, const std::string& left,
                                 const std::string& right) {
  const std::vector<std::string> a = Split(left, '\n'), b = Split(right, '\n');
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && !done(); ++i) {
    if (file == "steps.jsonl") {
      CompareSteps(a[i], b[i], static_cast<int>(i) + 1);
    } else if (a[i] != b[i]) {
      CompareJson(fmt::format("{}, line {}", file, i + 1), ParseOrdered(a[i]), ParseOrdered(b[i]));
    }
  }
  if (a.size() != b.size()) {
    Add({file, {"", fmt::format("{} lines", a.size()), fmt::format("{} lines", b.size()), {}}});
  }
}

void RunComparison::CompareTables(const std::string& file, const std::string& left,
                                  const std::string& right) {
  const std::vector<std::string> a = Split(left, '\n'), b = Split(right, '\n');
  const std::vector<std::string> columns = b.empty() ? b : Split(b.front(), ',');
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && !done(); ++i) {
    if (a[i] == b[i]) continue;
    const std::string place = fmt::format("{}, line {}", file, i + 1);
    const std::vector<std::string> x = Split(a[i], ','), y = Split(b[i], ',');
    if (x.size() != y.size()) {
      Add({place, {"", fmt::format("{} cells", x.size()), fmt::format("{} cells", y.size()), {}}});
      continue;
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (x[k] == y[k]) continue;
      const std::string& column = k < columns.size() ? columns[k] : "";
      JsonDifference difference{column, x[k], y[k], {}};
      const auto p = ParseNumber(x[k]), q = ParseNumber(y[k]);
      if (p && q && !IsChoice(column)) difference.distance = CalcDistance(*p, *q);
      Add({place, difference});
    }
  }
  if (a.size() != b.size()) {
    Add({file, {"", fmt::format("{} lines", a.size()), fmt::format("{} lines", b.size()), {}}});
  }
}

void RunComparison::CompareLogs(const std::string& file, const fs::path& left,
                                const fs::path& right) {
  Rawlog a, b;
  try {
    a = LoadRawlog(left);
    b = LoadRawlog(right);
  } catch (const InputError& error) {
    Add({file, {"", error.what(), "a log of the steps", {}}});
    return;
  }
  for (std::size_t i = 0; i < std::min(a.steps.size(), b.steps.size()) && !done(); ++i) {
    const int number = static_cast<int>(i) + 1;
    CompareJson(fmt::format("{}, {}", file, b.steps[i].id), FactsToJson(a.steps[i], number),
                FactsToJson(b.steps[i], number));
  }
  if (a.steps.size() != b.steps.size()) {
    Add({file,
         {"",
          fmt::format("{} steps", a.steps.size()),
          fmt::format("{} steps", b.steps.size()),
          {}}});
  }
  if (tolerance_ == 0.0) CompareJson(file + ", header", a.header, b.header);
}

void RunComparison::CompareContents(const std::string& file, const fs::path& left,
                                    const fs::path& right) {
  const fs::path extension = fs::path(file).extension();
  if (extension == ".rawlog") return CompareLogs(file, left, right);
  const std::string a = ReadFile(left), b = ReadFile(right);
  if (extension == ".jsonl") return CompareLines(file, a, b);
  if (extension == ".csv") return CompareTables(file, a, b);
  if (file == "summary.json" || file == "manifest.json") {
    const bool to_the_last_bit = tolerance_ == 0.0;
    return CompareJson(file, Comparable(file, ParseOrdered(a), to_the_last_bit),
                       Comparable(file, ParseOrdered(b), to_the_last_bit));
  }
  CompareJson(file, ParseOrdered(a), ParseOrdered(b));
}

void RunComparison::CompareFile(const std::string& file, const fs::path& left,
                                const fs::path& right) {
  std::error_code none;
  const bool in_left = fs::exists(left, none), in_right = fs::exists(right, none);
  if (!in_left || !in_right) {
    Add({file, {"", in_left ? "a file" : "nothing", in_right ? "a file" : "nothing", {}}});
    return;
  }
  if (Sha256OfFile(left) == Sha256OfFile(right)) return;
  const bool whole = file != "summary.json" && file != "manifest.json";
  CompareContents(file, left, right);
  // The same values in other bytes.
  if (whole && tolerance_ == 0.0 && !done()) Add({file, {"", "other bytes", "its bytes", {}}});
}

void RunComparison::CompareRuns(const fs::path& left, const fs::path& right) {
  for (const std::string& file : FilesInOrder(left, right)) {
    if (done()) return;
    CompareFile(file, left / file, right / file);
  }
}

std::optional<RunDifference> FindFaultOfPictures(const fs::path& directory) {
  std::set<std::string> pictures;
  for (const std::string& file : ListRunFiles(directory).files) {
    if (file.rfind("frames/", 0) == 0) pictures.insert(file);
  }
  const auto fault = [](const char* place, const std::string& field, const std::string& left,
                        const std::string& right) {
    return RunDifference{place, {field, left, right, {}}};
  };
  std::error_code none;
  if (!fs::exists(directory / kPictures, none)) {
    if (pictures.empty()) return std::nullopt;
    return fault("frames", "", fmt::format("{} pictures", pictures.size()), "none");
  }
  const std::vector<std::string> steps = Split(ReadFile(directory / "steps.jsonl"), '\n');
  const std::vector<std::string> lines = Split(ReadFile(directory / kPictures), '\n');
  const Rawlog log = LoadRawlog(directory / kPicturesLog);
  if (lines.size() != pictures.size() || log.steps.size() != pictures.size()) {
    return fault(kPictures, "", fmt::format("{} lines", lines.size()),
                 fmt::format("{} pictures", pictures.size()));
  }
  std::map<std::string, int> number_of;
  for (const std::string& line : steps) {
    number_of.emplace(TextIn(line, "id"), static_cast<int>(number_of.size()) + 1);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const StepFacts& step = log.steps[i];
    const int number = number_of.count(step.id) > 0 ? number_of[step.id] : 0;
    const std::string name = PictureName(number, step.id);
    const std::string picture = TextIn(lines[i], "picture");
    const bool is_there = number > 0 && pictures.erase("frames/" + name) > 0;
    if (!is_there || picture != "frames/" + name || TextIn(lines[i], "step") != step.id ||
        log.pictures[i] != name) {
      return fault(kPictures, fmt::format("line {}", i + 1), picture,
                   is_there ? name : "no picture of a step");
    }
    if (FormatJson(FactsToJson(step, number)) != steps[static_cast<std::size_t>(number) - 1]) {
      return fault(kPicturesLog, step.id, "another step", "that of steps.jsonl");
    }
  }
  return std::nullopt;
}

}  // namespace pregrasp
