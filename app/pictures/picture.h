#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/core/number_range.h"
#include "app/job/step_facts.h"
#include "app/scene/scene.h"
#include "render/renderer.h"

namespace pregrasp {

/// What a picture shows and how; the names are those of a script's shot{..}.
struct PictureConfig {
  int width = 1280, height = 720;  ///< [pixels]
  RenderQuality quality = RenderQuality::kStill;
  std::optional<CameraConfig> camera;  ///< otherwise the scene's, otherwise an automatic one
  bool forces = true;    ///< arrows of the fingers' forces and of the object's weight, with newtons
  bool cones = true;     ///< friction cones at the fingers
  bool contacts = true;  ///< where the object is supported
  bool trace = false;    ///< normals and forces at all contact points
  bool ghost = true;     ///< the object at its start, once it has left it
  bool fingers = true;   ///< the fingers themselves
  bool axes = true;      ///< the world frame's axes at its origin
  // Of planning stages:
  bool mesh = true;      ///< the contact mesh in place of the object
  bool scores = true;    ///< its colours, and the legend
  bool rollouts = true;  ///< where plans leave the object
  bool hand = true;      ///< the whole hand
  // Words, which overlays leave alone:
  bool card = true;            ///< title and sentences, at the upper left
  bool legend = true;          ///< what colours mean
  bool footer = true;          ///< how to make the picture again
  double font_scale = 1.0;     ///< of all type, of kFontScale
  bool fixed_corners = false;  ///< card and legend stay in theirs whatever they hide: in a film

  static constexpr NumberRange kFontScale{0.3, 4.0};

  /// @throws InputError for sizes outside 16 to 8192, or type outside kFontScale.
  void Validate() const;
};

/// How long a force's arrow is in pictures of a scene.
struct ForceScale {
  double metres_per_newton = 0.0;
  double shrunk = 1.0;  ///< what arrows and points measure, of their size at full-size objects

  /// Within what can be seen and what does not hide the rest [m].
  double Length(double newtons) const;
};
/// @param scene  loaded.
ForceScale CalcForceScale(const Scene& scene);

/// The words of a picture.
struct PictureText {
  std::string title;
  std::vector<std::string> lines;  ///< what happened and why; "name\tvalue" is a row of a table
  std::string footer;
};

/// A picture that is to be made of a step.
struct StepPicture {
  const StepFacts* step = nullptr;
  PictureConfig config;
};

/// Turns steps of one scene into pictures' contents: a function of the step's facts, of the steps
/// before it and of the scene. Holds the meshes, which pictures share.
class PictureMaker {
 public:
  /// @param scene  loaded.
  explicit PictureMaker(Scene scene);
  ~PictureMaker();

  RenderScene Compose(const StepFacts& step, const FactsSource& steps, const PictureText& text,
                      const PictureConfig& config) const;

  /// What matters in every one of these steps: the object, where plans leave it, the hand, as
  /// points of the world (#points x 3). Of several steps those do not count whose object was
  /// dropped, by a lift that failed or far below everything else, nor those whose hand is still on
  /// its way from afar: all others would be small. @param shown  at least one.
  MatrixX3 CalcFocus(const std::vector<const StepFacts*>& shown, const FactsSource& steps,
                     const PictureConfig& config) const;

  /// One camera that shows all these points. The scene's own, if it has one and `view` is not
  /// given. @param view  towards the camera, z against gravity; unset takes the automatic one.
  CameraConfig Frame(const MatrixX3& focus_W, const PictureConfig& config,
                     const std::optional<Vector3>& view = std::nullopt) const;

  /// `camera`, or where that does not show a hand that is still on its way from afar, it moved back
  /// until it does.
  CameraConfig FrameOnWay(const CameraConfig& camera, const StepFacts& step,
                          const FactsSource& steps, const PictureConfig& config) const;

  /// Gives those of these pictures that have no camera one: of all that are as wide for their
  /// height the same, framed over all their steps. What CalcFocus leaves aside frames nothing:
  /// where that camera does not show it, it is moved back for a hand on its way (FrameOnWay), and
  /// what falls away keeps an automatic one of its own.
  void ShareCamera(std::vector<StepPicture>& pictures, const FactsSource& steps) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
