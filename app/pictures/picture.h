#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/dynamics/world.h"
#include "app/hand/hand_model.h"
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

  /// @throws InputError for sizes outside 16 to 8192.
  void Validate() const;
};

/// What a planning stage adds to a picture of the world.
struct PictureOverlay {
  /// The contact mesh, in O, in place of the object; one colour a triangle.
  std::shared_ptr<const TriangleMesh> contact_mesh;
  std::vector<Rgba> face_colors;
  /// The object at other times or in other plans.
  struct Ghost {
    RigidTransform X_WO = RigidTransform::Identity();
    Rgba color;
  };
  std::vector<Ghost> ghosts;
  std::optional<HandConfiguration> hand;  ///< the whole hand, in place of the two fingers
  /// Fingers of the hand that touch: their last links get the finger's colour.
  std::array<bool, kNumFingers> touching{};
  bool forces = true;  ///< false: no physics happens here, so no forces are drawn
  RenderLegend legend;
  /// What the picture shows at least, in automatic pictures (#points x 3, world).
  MatrixX3 focus_W = MatrixX3(0, 3);
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

  /// @param start  where the ghost is.  @param overlay  null for none.
  RenderScene Compose(const WorldState& state, const std::vector<ContactPoint>& contacts,
                      const WorldState& start, const PictureOverlay* overlay,
                      const PictureText& text, const PictureConfig& config) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
