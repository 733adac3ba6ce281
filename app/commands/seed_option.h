#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

namespace pregrasp {

/// Adds --seed, a whole number from 0. (CLI11 alone would take -1 for the largest of them.)
void AddSeedOption(CLI::App& command, std::uint64_t& seed, const std::string& text);

}  // namespace pregrasp
