#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/job/step_facts.h"
#include "render/render_scene.h"

namespace pregrasp {

/// What a kind of step adds to a picture of the world.
struct PictureOverlay {
  /// The contact mesh, in O, in place of the object; one colour a triangle.
  std::shared_ptr<const TriangleMesh> contact_mesh;
  std::vector<Rgba> face_colors;
  /// Triangles of it that have a label, which says so where they are turned away from the camera.
  struct TriangleLabel {
    int triangle = 0;
    std::string text;
    Rgba color;
  };
  std::vector<TriangleLabel> triangle_labels;
  /// The object as other plans leave it, as outlines.
  struct Ghost {
    RigidTransform X_WO = RigidTransform::Identity();
    Rgba color;
  };
  std::vector<Ghost> ghosts;
  /// Contacts of a grasp, or of a plan, with the force on the object there, zero for none.
  struct Contact {
    Finger finger = Finger::kThumb;
    Vector3 p_W = Vector3::Zero(), nhat_W = Vector3::UnitZ(), f_W = Vector3::Zero();
    bool holds = true;  ///< its cone has the colour of what is within limits
    std::string name;   ///< "thumb"; where no force is known, the label
  };
  std::vector<Contact> contacts;  ///< in place of the fingers of the physics
  /// Where a finger touches the object, and where that point of it goes.
  struct Way {
    Finger finger = Finger::kThumb;
    std::vector<Vector3> p_W;
    std::string name;
  };
  std::vector<Way> ways;
  std::optional<HandConfiguration> hand;  ///< the whole hand, in place of the two fingers
  /// Fingers of the hand that touch: their last links get the finger's colour.
  std::array<bool, kNumFingers> touching{};
  std::vector<std::string> colliding;  ///< parts of the hand, marked
  bool forces = true;                  ///< false: no physics happens here, so no forces are drawn
  RenderLegend legend;
  /// What the picture shows at least, in automatic pictures (#points x 3, world).
  MatrixX3 focus_W = MatrixX3(0, 3);
};

/// @param hand  of the steps.
PictureOverlay MakeOverlay(const StepFacts& step, const FactsSource& steps, const HandModel& hand);

/// Where what led to `step` began: the scene's start, settled or not.
const StepFacts& FindStart(const StepFacts& step, const FactsSource& steps);

/// Whether a run with PictureMode::kKey draws the step unasked: the start, scores, the pruned
/// graph, paths, every fifth iteration and the last, certificates, of each path the first grasp
/// that is feasible and the first that is not, of its lifts the first of each result, keyframes.
bool IsKeyStep(const StepFacts& step, const FactsSource& steps);

}  // namespace pregrasp
