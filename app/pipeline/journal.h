#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/pictures/picture.h"
#include "app/recording/run_directory.h"
#include "render/renderer.h"

namespace pregrasp {

/// Which steps get a picture.
enum class PictureMode {
  kNone,  ///< none, whatever is asked for
  kKey,   ///< the start, the planner's key steps, and those asked for
  kAll,   ///< every step
};

/// One step that was taken: what the log says of it, and all that a picture of it needs.
struct JournalStep {
  StepRecord record;
  WorldState state;
  std::vector<ContactPoint> contacts;
  bool traced = false;             ///< pictures show the contacts' normals and forces
  std::vector<std::string> lines;  ///< what happened and why
  std::shared_ptr<const PictureOverlay> overlay;  ///< what a planning stage adds; null for nothing
  bool key = false;                               ///< gets a picture in PictureMode::kKey
  /// A picture that was asked for.
  struct Shot {
    PictureConfig config;
    std::string caption;  ///< in place of the lines, unless empty
    std::string title;    ///< in place of the step's id, unless empty
  };
  std::optional<Shot> shot;
};

/// What a run comes to beside its steps.
struct RunOutcome {
  std::vector<WorldState> rollout;  ///< rollout.csv, every physics step
  std::string trace_table;          ///< trace.jsonl, empty for none
  std::string motion_table;         ///< motion.csv, empty for none
  nlohmann::json summary;           ///< any of the fields of summary.json
  nlohmann::json configuration;     ///< for manifest.json
};

/// Draws steps. The renderer is made when the first picture is: a run without pictures never loads
/// OpenGL.
class PictureDrawer {
 public:
  /// @param remake  the command that makes the pictures again; may be empty.
  PictureDrawer(std::shared_ptr<const World> world, std::uint64_t seed, std::string remake);
  ~PictureDrawer();

  /// @param start  where the ghost is. @throws InputError if the file cannot be written.
  void Draw(const JournalStep& step, const WorldState& start, const std::filesystem::path& file);

 private:
  PictureText Caption(const JournalStep& step) const;

  std::shared_ptr<const World> world_;
  std::uint64_t seed_;
  std::string remake_;
  std::unique_ptr<PictureMaker> maker_;
};

/// Writes a journal to a run directory, step by step. The last step waits until it is known whether
/// a picture of it is asked for.
class JournalWriter {
 public:
  JournalWriter(const std::filesystem::path& directory, const World& world, std::uint64_t seed,
                PictureMode pictures);

  /// Writes those steps that nothing can be added to any more: all but the last.
  void WriteUpToLast(const std::vector<JournalStep>& journal, const WorldState& start,
                     PictureDrawer& drawer);

  /// Writes the rest and the trajectory, and puts the run in its place.
  void Finish(const std::vector<JournalStep>& journal, const WorldState& start,
              PictureDrawer& drawer, const RunOutcome& outcome);

  std::filesystem::path directory() const { return run_.directory(); }
  double picture_seconds() const { return picture_seconds_; }

 private:
  void Write(const JournalStep& step, const WorldState& start, PictureDrawer& drawer);

  RunDirectory run_;
  PictureMode pictures_;
  std::size_t next_ = 0;
  double picture_seconds_ = 0.0;
};

}  // namespace pregrasp
