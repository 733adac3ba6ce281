#include "app/commands/seed_option.h"

#include <algorithm>

namespace pregrasp {

void AddSeedOption(CLI::App& command, std::uint64_t& seed, const std::string& text) {
  const CLI::Validator digits(
      [](const std::string& value) {
        const bool whole = !value.empty() && std::all_of(value.begin(), value.end(), [](char c) {
          return c >= '0' && c <= '9';
        });
        return whole ? std::string() : "expected a whole number from 0, got \"" + value + '"';
      },
      "N", "seed");
  command.add_option("--seed", seed, text)->capture_default_str()->check(digits);
}

}  // namespace pregrasp
