#pragma once

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

  /// Writes the next node. Its own picture waits for DrawPending: only when all steps are there is
  /// it known what one camera has to show.
  void Add(const Timeline::Node& node);
  /// A picture of a node that was added, drawn now; of several of one node the last stays. One
  /// without a camera is drawn once more by DrawPending. @throws Interrupted, without it.
  void Shoot(const Timeline::Node& node, const Shot& shot);

  /// Draws what waits, by one camera (PictureMaker::ShareCamera); to be called before Finish, so
  /// that the summary's seconds count it. @throws Interrupted, after which all still waits: with
  /// more steps it may be another camera.
  void DrawPending();
  /// Does without the pictures that wait.
  void DropPending() { pending_.clear(); }
  /// Writes what the job has come to at `node`, and puts the run in its place.
  void Finish(const Timeline::Node& node, RunSummary summary);

  std::filesystem::path directory() const { return run_.directory(); }
  void SetError(std::string error) { run_.SetError(std::move(error)); }

 private:
  struct Pending {
    Shot shot;
    bool asked = false;  // else of the node's own picture, which the mode may leave out
  };

  void Draw(const Timeline::Node& node, const Shot& shot);
  void WriteTables(const Timeline::Node& node);

  RunDirectory run_;
  const Timeline& timeline_;
  PictureMode pictures_;
  PictureDrawer& drawer_;
  std::map<int, Pending> pending_;               // pictures that wait, by the step's number
  std::map<int, nlohmann::ordered_json> drawn_;  // pictures, by the step's number
  double picture_seconds_ = 0.0;
};

}  // namespace pregrasp
