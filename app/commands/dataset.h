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
  std::filesystem::path objects;

  void AddTo(const Subcommand& command);
  void AddLabelsTo(const Subcommand& command);

  /// The configuration with the excluded objects, those of the scenes named, else of all
  /// evaluation scenes; and with the meshes of `objects` that resemble none of them, whose others
  /// are named on the terminal. @throws InputError.
  ItemConfig Resolve() const;
};

// Subcommands of it.
void AddDatasetPictures(const Subcommand& dataset, Action& action);

}  // namespace pregrasp
