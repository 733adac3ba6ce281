#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "app/pictures/picture.h"

namespace pregrasp {

/// Which steps get a picture.
enum class PictureMode {
  kNone,  ///< none, whatever is asked for
  kKey,   ///< key steps (IsKeyStep), and those asked for
  kAll,   ///< every step
};
/// "none", "key" or "all". @throws InputError naming `where` and `field`.
PictureMode ParsePictureMode(const std::string& text, const std::string& where,
                             const std::string& field);

/// A picture that is asked for.
struct Shot {
  PictureConfig config;
  std::string caption;         ///< in place of the step's sentences, unless empty
  std::string title;           ///< in place of the step's id, unless empty
  bool shares_camera = false;  ///< with the run's other pictures: nobody named one
};
/// An object of pictures.jsonl (app/recording/README.md), and back. @throws InputError.
nlohmann::ordered_json ShotToJson(const Shot& shot);
Shot ShotFromJson(const nlohmann::json& value, const std::string& where);

/// The picture that a finished run took of a step; the usual one where it took none.
/// @throws InputError if pictures.jsonl cannot be read.
Shot FindShot(const std::filesystem::path& run, const std::string& step);

/// Shows these overlays and no others. @throws InputError naming "overlay".
void SetOverlays(PictureConfig& config, const std::vector<std::string>& names);
/// "draft", "normal" or "still". @throws InputError naming "quality".
RenderQuality ParseQuality(const std::string& text);

/// What the words of a picture say beside its step.
struct PictureLabels {
  std::uint64_t seed = 1;
  std::string scene_file;  ///< as the user gave it, or the scene's name
  std::string command;     ///< that makes the pictures again; may be empty
};

/// Draws steps to PNG files. The renderer is made when the first picture is: a run without pictures
/// never loads OpenGL.
class PictureDrawer {
 public:
  PictureDrawer(Scene scene, PictureLabels labels);
  ~PictureDrawer();

  /// @throws InputError if the file cannot be written.
  void Draw(const StepFacts& step, const FactsSource& steps, const Shot& shot,
            const std::filesystem::path& file);

  /// The picture itself.
  Image Render(const StepFacts& step, const FactsSource& steps, const Shot& shot);

  /// PictureMaker::CalcFocus and Frame, of which FrameSteps is both.
  MatrixX3 CalcFocus(const std::vector<const StepFacts*>& shown, const FactsSource& steps,
                     const PictureConfig& config);
  CameraConfig Frame(const MatrixX3& focus_W, const PictureConfig& config,
                     const std::optional<Vector3>& view = std::nullopt);
  CameraConfig FrameSteps(const std::vector<const StepFacts*>& shown, const FactsSource& steps,
                          const PictureConfig& config,
                          const std::optional<Vector3>& view = std::nullopt);

  /// PictureMaker::FrameOnWay.
  CameraConfig FrameOnWay(const CameraConfig& camera, const StepFacts& step,
                          const FactsSource& steps, const PictureConfig& config);

  /// PictureMaker::ShareCamera.
  void ShareCamera(std::vector<StepPicture>& pictures, const FactsSource& steps);

  const Scene& scene() const { return scene_; }

  /// Writes what the picture shows, but for its texts beside the scene, as a .3Dscene for MRPT's
  /// SceneViewer3D, which looks at it from anywhere. @throws InputError likewise.
  void WriteScene(const StepFacts& step, const FactsSource& steps, const Shot& shot,
                  const std::filesystem::path& file);

 private:
  const PictureMaker& Maker();
  RenderScene Compose(const StepFacts& step, const FactsSource& steps, const Shot& shot);
  PictureText Caption(const StepFacts& step, const FactsSource& steps, const Shot& shot) const;

  Scene scene_;
  PictureLabels labels_;
  std::unique_ptr<PictureMaker> maker_;
};

}  // namespace pregrasp
