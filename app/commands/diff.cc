#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>

#include "app/commands/commands.h"
#include "app/job/facts_json.h"
#include "app/recording/loaded_run.h"

namespace pregrasp {
namespace {

struct DiffOptions {
  std::string left, right;
};

int Diff(const DiffOptions& options) {
  const LoadedRun left = LoadRun(options.left), right = LoadRun(options.right);
  const std::size_t count = std::min(left.steps.size(), right.steps.size());
  for (std::size_t i = 0; i < count; ++i) {
    const StepFacts &a = left.steps[i], &b = right.steps[i];
    if (a.id != b.id) {
      fmt::print("step {}: {} and {}\n", i + 1, a.id, b.id);
      return 0;
    }
    if (const auto difference = CompareFacts(a, b)) {
      fmt::print("step {}, {}: {}: {} and {}\n", i + 1, a.id, difference->field, difference->left,
                 difference->right);
      return 0;
    }
  }
  if (left.steps.size() != right.steps.size()) {
    fmt::print("the first {} steps are the same; then one ends, of {} and {}\n", count,
               left.steps.size(), right.steps.size());
    return 0;
  }
  fmt::print("{} steps, all facts the same\n", count);
  return 0;
}

}  // namespace

void AddDiff(const Subcommand& app, Action& action) {
  auto options = std::make_shared<DiffOptions>();
  const Subcommand command =
      app.AddCommand("diff", "Say where two finished runs first differ: step, field, both values");
  command.Add("RUN_DIR", options->left, "One run directory").Required();
  command.Add("RUN_DIR_2", options->right, "The other").Required();
  command.OnChosen([options, &action] { action = [options] { return Diff(*options); }; });
}

}  // namespace pregrasp
