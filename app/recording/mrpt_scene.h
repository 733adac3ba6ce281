#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/core/math.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// What a .3Dscene shows, everything in W. Colours are linear, with opacity.
struct MrptScene {
  using Color = std::array<float, 4>;
  struct Mesh {
    std::shared_ptr<const TriangleMesh> mesh;
    RigidTransform X_WB = RigidTransform::Identity();
    Color color{};
    std::vector<Color> face_colors;  ///< one a triangle in place of `color`, or none
  };
  struct Arrow {
    Vector3 p_W, v_W;  ///< from the one along the other
    double radius = 0.0;
    Color color{};
  };
  struct Ball {
    Vector3 p_W;
    double radius = 0.0;
    Color color{};
  };
  struct Line {
    std::vector<Vector3> p_W;
    Color color{};
  };
  struct Label {
    Vector3 p_W;
    std::string text;
    Color color{};
  };
  std::vector<Mesh> meshes;
  std::vector<Arrow> arrows;
  std::vector<Ball> balls;
  std::vector<Line> lines;
  std::vector<Label> labels;
};

/// Writes a scene that MRPT's SceneViewer3D opens. @throws InputError if it cannot be written.
void WriteMrptScene(const std::filesystem::path& file, const MrptScene& scene);

}  // namespace pregrasp
