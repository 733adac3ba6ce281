#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/dynamics/world.h"
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
  bool ghost = true;     ///< the object at its start, once it has left it
  bool fingers = true;   ///< the fingers themselves
  bool axes = true;      ///< the world frame's axes at its origin

  /// @throws InputError for sizes outside 16 to 8192.
  void Validate() const;
};

/// The words of a picture.
struct PictureText {
  std::string title;
  std::vector<std::string> lines;  ///< what happened and why; "name\tvalue" is a row of a table
  std::string footer;
};

/// Turns states of one world into pictures' contents. Holds the meshes, which pictures share.
class PictureMaker {
 public:
  explicit PictureMaker(std::shared_ptr<const World> world);
  ~PictureMaker();

  /// @param start  where the ghost is.
  RenderScene Compose(const WorldState& state, const std::vector<ContactPoint>& contacts,
                      const WorldState& start, const PictureText& text,
                      const PictureConfig& config) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
