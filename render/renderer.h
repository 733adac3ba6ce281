#pragma once

#include <memory>
#include <string>

#include "render/image.h"
#include "render/render_scene.h"

namespace pregrasp {

enum class RenderQuality {
  kDraft,   ///< no multisampling, no ambient occlusion
  kNormal,  ///< 4x multisampling, soft shadows
  kStill,   ///< and ambient occlusion
};

struct RenderConfig {
  int width = 1280, height = 720;  ///< [pixels], 16 to 8192
  RenderQuality quality = RenderQuality::kNormal;

  void Validate() const;
};

/// Draws offscreen with Mesa's core profile. One long-lived context per process is the intended
/// use; a Renderer is bound to the thread that made it. The same scene gives the same bytes.
class Renderer {
 public:
  Renderer();
  ~Renderer();
  Renderer(Renderer&&) noexcept;

  /// @throws InputError for a size or a direction that it cannot draw; Interrupted, between passes.
  Image Render(const RenderScene& scene, const RenderConfig& config);

  /// GL_RENDERER, OSMesa or EGL, and GL_VERSION, for `info`.
  std::string description() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A camera that shows every solid body's points in `focus` (#points x 3, world) from the direction
/// `dir_W` (towards the camera), with a border.
RenderCamera FrameCamera(const MatrixX3& focus, const Vector3& dir_W, double aspect,
                         double fov_deg = 35.0);

}  // namespace pregrasp
