#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <string>

#include "app/core/math.h"
#include "app/hand/hand_model.h"

namespace pregrasp {

/// A URDF file's text, small and flat enough for a parser that descends by recursion.
/// @throws InputError
std::string ReadUrdfText(const std::filesystem::path& file);

/// The links and joints of a URDF, which form a tree. `file` is what errors name.
/// @param complaint  set to what the parser said of a part that it left out, if there is one.
/// @throws InputError
urdf::ModelInterfaceSharedPtr ParseUrdf(const std::filesystem::path& file, const std::string& text,
                                        std::string* complaint);

Vector3 FromUrdf(const urdf::Vector3& v);
RigidTransform FromUrdf(const urdf::Pose& pose);

/// What a joint's type is called in an error.
std::string MovementOf(const urdf::Joint& joint);

/// What a collision shape's type is called in an error.
std::string ShapeOf(const urdf::Collision& collision);

/// A mesh's file without "package://NAME/" or "file://".
std::string MeshFileOf(const urdf::Mesh& mesh);

/// Adds the mass and inertia of a URDF's link, whose frame is at X_LB, to a link of ours.
void AddInertia(const urdf::Link& urdf, const RigidTransform& X_LB, HandLink* link);

}  // namespace pregrasp
