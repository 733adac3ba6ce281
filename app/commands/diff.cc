#include <fmt/core.h>

#include <memory>
#include <string>
#include <vector>

#include "app/commands/commands.h"
#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/core/text.h"
#include "app/recording/checked_file.h"
#include "app/recording/manifest.h"
#include "app/recording/run_comparison.h"

namespace pregrasp {
namespace {

struct DiffOptions {
  std::string left, right;
};

nlohmann::ordered_json Read(const std::string& run, const char* file) {
  const std::filesystem::path path = std::filesystem::path(run) / file;
  ParseJson(ReadFile(path), path.string());
  return nlohmann::ordered_json::parse(ReadFile(path));
}

// Two documents side by side, where they differ.
void PrintSideBySide(const std::string& title, const nlohmann::ordered_json& left,
                     const nlohmann::ordered_json& right) {
  bool first = true;
  VisitDifferences(left, right, [&](const JsonDifference& difference) {
    if (first) fmt::print("{}\n", title);
    first = false;
    fmt::print("  {:<34} {:<24} {}\n", difference.field, OneLine(difference.left),
               OneLine(difference.right));
    return true;
  });
}

int Diff(const DiffOptions& options) {
  for (const std::string& run : {options.left, options.right}) {
    RequireFinishedRun(run);
  }
  RunComparison comparison(0.0);
  comparison.CompareRuns(options.left, options.right);
  if (!comparison.first()) {
    fmt::print("every step and every file the same\n");
    return 0;
  }
  fmt::print("{}\n", comparison.first()->Sentence("one says", "the other"));
  PrintSideBySide("scene", Read(options.left, "scene.json"), Read(options.right, "scene.json"));
  const nlohmann::ordered_json left = Read(options.left, "manifest.json"),
                               right = Read(options.right, "manifest.json");
  for (const char* field : {"seed", "configuration"}) {
    PrintSideBySide(field, {{field, left.value(field, nlohmann::ordered_json())}},
                    {{field, right.value(field, nlohmann::ordered_json())}});
  }
  nlohmann::ordered_json results[] = {Read(options.left, "summary.json"),
                                      Read(options.right, "summary.json")};
  for (nlohmann::ordered_json& summary : results) {
    for (const char* field : {"seconds", "peak_rss_mb", "hash"}) {
      if (summary.is_object()) summary.erase(field);
    }
  }
  PrintSideBySide("summary", results[0], results[1]);
  return 0;
}

}  // namespace

void AddDiff(const Subcommand& app, Action& action) {
  auto options = std::make_shared<DiffOptions>();
  const Subcommand command = app.AddCommand(
      "diff",
      "Say where two finished runs first differ, and their settings and results side by side");
  command.Add("RUN_DIR", options->left, "One run directory").Required();
  command.Add("RUN_DIR_2", options->right, "The other").Required();
  command.OnChosen([options, &action] { action = [options] { return Diff(*options); }; });
}

}  // namespace pregrasp
