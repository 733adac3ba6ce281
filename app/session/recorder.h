#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <optional>

#include "app/job/timeline.h"
#include "app/recording/run_directory.h"
#include "app/session/picture_file.h"

namespace pregrasp {

/// Writes a timeline to a run directory, node by node, with pictures of the steps that its mode
/// asks for and of those that somebody does.
class Recorder {
 public:
  /// @param drawer  outlives this, as does the timeline.
  Recorder(const std::filesystem::path& directory, const Timeline& timeline, PictureMode pictures,
           PictureDrawer& drawer, RunInfo info);

  /// Writes the next node. Its own picture waits until the next one comes: another may be asked
  /// for. An interrupt leaves pictures for DrawPending: every node gets written.
  void Add(const Timeline::Node& node);
  /// A picture of a node that was added; of several of one node the last stays. @throws
  /// Interrupted, without it.
  void Shoot(const Timeline::Node& node, const Shot& shot);

  /// Draws what waits; to be called before Finish, so that the summary's seconds count it.
  /// @throws Interrupted, after which the rest still waits.
  void DrawPending();
  /// Does without the pictures that wait.
  void DropPending() { pending_.clear(); }
  /// Writes what the job has come to at `node`, and puts the run in its place.
  void Finish(const Timeline::Node& node, RunSummary summary);

  std::filesystem::path directory() const { return run_.directory(); }
  void SetError(std::string error) { run_.SetError(std::move(error)); }

 private:
  void Draw(const Timeline::Node& node, const Shot& shot);
  void WriteTables(const Timeline::Node& node);

  RunDirectory run_;
  const Timeline& timeline_;
  PictureMode pictures_;
  PictureDrawer& drawer_;
  std::deque<const Timeline::Node*> pending_;    // whose own pictures are not drawn yet
  std::map<int, nlohmann::ordered_json> drawn_;  // pictures, by the step's number
  double picture_seconds_ = 0.0;
};

}  // namespace pregrasp
