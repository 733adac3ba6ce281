#pragma once

#include <filesystem>
#include <vector>

#include "app/commands/commands.h"
#include "app/training/make_item.h"

namespace pregrasp {

/// What every part of `pregrasp dataset` must be told alike, because it decides the items.
struct ItemOptions {
  ItemConfig config;
  std::vector<std::filesystem::path> excluded;

  void AddTo(const Subcommand& command);
  void AddLabelsTo(const Subcommand& command);

  /// The configuration with the excluded objects: those of the scenes named, else of all
  /// evaluation scenes. @throws InputError.
  ItemConfig Resolve() const;
};

// Subcommands of it.
void AddDatasetPictures(const Subcommand& dataset, Action& action);

}  // namespace pregrasp
