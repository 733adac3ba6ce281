#pragma once

#include <vector>

#include "app/scene/finger.h"
#include "render/render_scene.h"

namespace pregrasp {

/// A finger as a picture shows it where no hand has been planned yet: the fingertip sphere that all
/// tests use, touching at p_WC from outside, and two bent links that lead away from the surface and
/// from the viewer, so that the contact stays in sight.
/// @param radius  of that sphere [m]. @param nhat_W  outward normal of the object there. @param
/// to_viewer_W  towards the camera.
std::vector<RenderBody> MakeFingerStub(Finger finger, double radius, const Vector3& p_WC,
                                       const Vector3& nhat_W, const Vector3& to_viewer_W);

}  // namespace pregrasp
