#include "render/renderer.h"

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>

#include <cstdlib>
#include <optional>
#include <string>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "render/camera.h"
#include "render/font.h"
#include "render/frame_content.h"
#include "render/frame_data.h"
#include "render/light.h"
#include "render/occlusion_pass.h"
#include "render/overlay.h"
#include "render/picture_pass.h"
#include "render/shadow_pass.h"
#include "render/upright.h"

namespace pregrasp {
namespace {

// Larger pictures are drawn in tiles, so that memory stays bounded and an interrupt is soon seen.
constexpr int kTileWidth = 2048;          // at most [pixels]
constexpr int kTileArea = 1 << 19;        // about, at most [pixels]
constexpr int kOcclusionSize = 1024;      // longest side of the occlusion buffer [pixels]
constexpr double kLightRadius = 0.045;    // tan of the angular radius of the light
constexpr double kOcclusionReach = 0.07;  // of the view's height

void CopyMatrix(const Eigen::Matrix4d& from, float* to) {
  const Eigen::Matrix4f m = from.cast<float>();
  std::copy(m.data(), m.data() + 16, to);
}

// Infinite far plane and reversed depth: near / distance, which spends a float's precision evenly.
Eigen::Matrix4d Projection(const CameraView& view, double near) {
  Eigen::Matrix4d P = Eigen::Matrix4d::Zero();
  P(0, 0) = 1.0 / (view.tan_half_fov * view.aspect());
  P(1, 1) = 1.0 / view.tan_half_fov;
  P(2, 3) = near;
  P(3, 2) = -1.0;
  return P;
}

Eigen::Matrix4d ViewFromWorld(const CameraView& view) {
  Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
  X.topLeftCorner<3, 3>() = view.R_WCam.transpose();
  X.topRightCorner<3, 1>() = -view.R_WCam.transpose() * view.p_WCam;
  return X;
}

// Of 1 cm, 10 cm, 1 m, .., the finest spacing whose squares are not crowded at the target; every
// tenth line is bolder.
double GridSpacing(const CameraView& view) {
  constexpr double kFewestPixels = 16.0;  // of a picture 720 high
  const double smallest = kFewestPixels / 720.0 * view.view_height();
  double spacing = 0.01;
  while (spacing < smallest) spacing *= 10.0;
  return spacing;
}

double GroundHeight(const RenderScene& scene, const FrameContent& content) {
  if (scene.ground_z) return *scene.ground_z;
  double z = 0.0;
  bool any = false;
  for (const auto& box : content.solid_bounds_W) {
    z = any ? std::min(z, box.min().z()) : box.min().z();
    any = true;
  }
  return z;
}

int TileWidth(const RenderConfig& config) { return std::min(config.width, kTileWidth); }
int TileHeight(const RenderConfig& config) {
  return std::min(config.height, kTileArea / TileWidth(config));
}

// What was asked of Mesa so far is drawn now: it would else come in one piece that cannot be
// interrupted. @throws Interrupted.
void FinishPass() {
  gl.Finish();
  ThrowIfInterrupted();
}

// Draws with a default for Mesa's rasteriser threads that suits many cores; the user's own
// LP_NUM_THREADS wins. Pixels do not depend on it.
void LimitRasterThreads() {
  constexpr int kMost = 8;
  if (std::getenv("LP_NUM_THREADS") == nullptr) {
    const int cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    setenv("LP_NUM_THREADS", std::to_string(std::clamp(cores, 1, kMost)).c_str(), 0);
  }
}

}  // namespace

void RenderConfig::Validate() const {
  const auto check = [](const char* field, int value) {
    if (value < 16 || value > 8192) {
      throw InputError("picture", field, "16 to 8192 pixels", std::to_string(value));
    }
  };
  check("width", width);
  check("height", height);
}

struct Renderer::Impl {
  GlContext context;
  MeshCache cache;
  AnnotationMeshes annotations;
  FrameData data;
  ShadowPass shadow_pass;
  OcclusionPass occlusion_pass;
  PicturePass picture_pass;
  FontSet fonts;
  std::optional<TileTargets> tile;
  std::optional<ShadowTargets> shadows;
  std::optional<OcclusionTargets> occlusion;

  void SizeTargets(const RenderConfig& config) {
    const int samples = config.quality == RenderQuality::kDraft ? 0 : 4;
    const int w = TileWidth(config), h = TileHeight(config);
    if (!tile || tile->width != w || tile->height != h || tile->samples != samples) {
      tile.reset();
      tile.emplace(w, h, samples);
    }
    const int shadow_size = config.quality == RenderQuality::kDraft || config.height <= 360 ? 1024
                            : config.height <= 1080                                         ? 2048
                                                                                            : 4096;
    if (!shadows || shadows->size != shadow_size) {
      shadows.reset();
      shadows.emplace(shadow_size);
    }
    if (config.quality == RenderQuality::kStill) {
      const double shrink = std::min(
          0.5, static_cast<double>(kOcclusionSize) / std::max(config.width, config.height));
      const int ow = std::max(8, static_cast<int>(std::lround(config.width * shrink)));
      const int oh = std::max(8, static_cast<int>(std::lround(config.height * shrink)));
      if (!occlusion || occlusion->width != ow || occlusion->height != oh) {
        occlusion.reset();
        occlusion.emplace(ow, oh);
      }
    }
  }

  FrameBlock MakeFrame(const RenderScene& scene, const CameraView& view, const ShadowFit& fit,
                       const Vector3& to_light, double ground_z) const {
    FrameBlock frame{};
    const double near = 2e-3 * view.target_distance;
    CopyMatrix(Projection(view, near) * ViewFromWorld(view), frame.clip_from_world);
    CopyMatrix(ViewFromWorld(view), frame.view_from_world);
    for (int layer = 0; layer < kShadowLayers; ++layer) {
      CopyMatrix(fit.layers[layer].map_from_world, frame.shadow_from_world[layer]);
      frame.shadow_width[layer] = static_cast<float>(fit.layers[layer].width);
      frame.shadow_width[2 + layer] = static_cast<float>(fit.layers[layer].depth);
    }
    const auto set = [](float* to, const Vector3& xyz, double w) {
      for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(xyz[i]);
      to[3] = static_cast<float>(w);
    };
    set(frame.eye, view.p_WCam, view.tan_half_fov);
    set(frame.to_light, to_light, kLightRadius);
    set(frame.map_x, fit.x_W, 0.0);
    set(frame.map_y, fit.y_W, 0.0);
    set(frame.picture, Vector3(view.width, view.height, 0.0), 0.0);
    set(frame.target, scene.camera.p_WTarget, view.view_height());
    set(frame.ground, Vector3(ground_z, GridSpacing(view), scene.ground ? 1.0 : 0.0),
        8.0 * view.target_distance);
    set(frame.tuning,
        Vector3(near, kOcclusionReach * view.view_height(), std::max(view.height / 720.0, 0.5)),
        shadows->size);
    return frame;
  }

  void ReadTile(int x, int y, int w, int h, Image& image) const {
    if (tile->samples > 0) {
      gl.BindFramebuffer(GL_READ_FRAMEBUFFER, tile->draw.get());
      gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, tile->read.get());
      gl.BlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
      gl.BindFramebuffer(GL_READ_FRAMEBUFFER, tile->read.get());
    } else {
      gl.BindFramebuffer(GL_READ_FRAMEBUFFER, tile->draw.get());
    }
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(w) * h * 4);
    gl.ReadPixels(0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    for (int row = 0; row < h; ++row) {
      // The tile's rows count upwards, the image's downwards.
      const std::uint8_t* from = &rgba[static_cast<std::size_t>(h - 1 - row) * w * 4];
      const int image_row = image.height - y - h + row;
      std::uint8_t* to = &image.rgb[(static_cast<std::size_t>(image_row) * image.width + x) * 3];
      for (int column = 0; column < w; ++column, from += 4, to += 3) {
        std::copy(from, from + 3, to);
      }
    }
  }
};

Renderer::Renderer() {
  LimitRasterThreads();
  impl_ = std::make_unique<Impl>();
}

Renderer::~Renderer() {
  if (impl_) impl_->context.MakeCurrent();
}

Renderer::Renderer(Renderer&&) noexcept = default;

Image Renderer::Render(const RenderScene& scene, const RenderConfig& config) {
  config.Validate();
  if (!scene.up_W.allFinite() || std::abs(scene.up_W.norm() - 1.0) > 1e-6) {
    throw InputError("picture", "up_W", "a direction of unit length", "another");
  }
  // What follows takes +z for up.
  if (!scene.up_W.isApprox(Vector3::UnitZ(), 1e-9)) {
    return Render(Rotated(scene, UprightRotation(scene.up_W)), config);
  }
  const CameraView view = MakeCameraView(scene.camera, config.width, config.height);
  Impl& impl = *impl_;
  impl.context.MakeCurrent();
  impl.cache.DropDead();
  const FrameContent content = CollectContent(scene, view, impl.annotations, impl.cache);
  ThrowIfInterrupted();
  impl.SizeTargets(config);
  Vector3 to_light = scene.to_light_W.value_or(DefaultLightDirection(view));
  if (!to_light.allFinite() || to_light.norm() < 1e-9) {
    throw InputError("picture", "to_light_W", "a direction", "zero, nan or inf");
  }
  to_light.normalize();
  const ShadowFit fit = FitShadow(view, to_light, content.solid_bounds_W);
  FrameBlock frame = impl.MakeFrame(scene, view, fit, to_light, GroundHeight(scene, content));
  impl.data.Upload(content, impl.cache);
  impl.data.SetBlock(frame);
  impl.shadow_pass.Run(content, fit, *impl.shadows);
  FinishPass();
  if (config.quality == RenderQuality::kStill) {
    impl.occlusion_pass.Run(content, scene.ground, *impl.occlusion);
    FinishPass();
  }
  Image image{config.width, config.height, {}};
  image.rgb.resize(static_cast<std::size_t>(config.width) * config.height * 3);
  const int width = impl.tile->width, height = impl.tile->height;
  for (int y = 0; y < config.height; y += height) {
    for (int x = 0; x < config.width; x += width) {
      frame.picture[2] = static_cast<float>(x);
      frame.picture[3] = static_cast<float>(y);
      impl.data.SetBlock(frame);
      impl.picture_pass.Run(content, impl.data, config.quality, scene.ground, *impl.tile,
                            {x, y, config.width, config.height});
      impl.ReadTile(x, y, std::min(width, config.width - x), std::min(height, config.height - y),
                    image);
      ThrowIfInterrupted();
    }
  }
  const GLenum error = gl.GetError();  // of any call since the last picture
  PREGRASP_CHECK(error == GL_NO_ERROR, error);
  DrawOverlay(image, impl.fonts, scene, view, scene.ground ? GridSpacing(view) : 0.0);
  return image;
}

std::string Renderer::description() const {
  impl_->context.MakeCurrent();
  return impl_->context.description();
}

}  // namespace pregrasp
