#pragma once

#include "app/grasp/contact_places.h"
#include "app/grasp/feasible_grasp.h"
#include "app/networks/grasp_generator.h"

namespace pregrasp {

/// Between the spheres of two fingertips after projection [m]: what inverse kinematics asks of
/// clearances (IkConfig::clearance_buffer), so that a hand can place them.
inline constexpr double kTipRoom = 6e-4;

/// Projects generated points to the object, all together: every finger gets a place where its tip
/// can be, with room for all tips, whatever the points are. Each goes to the place nearest to its
/// point; tips without room push each other apart along the surface; where that finds no room, they
/// are placed one after another, each at the nearest place with room. Contacts of `fixed` are kept
/// as they are.
/// @param may_drop  leave out ring and little where their points are not finite; all others that
/// are
///                  not finite count as the middle of the object.
/// @return contacts in order of their fingers. A finger is missing if it is left out or its tip can
/// be nowhere; tips overlap only if the object has no room for them, or fixed ones do.
std::vector<GraspContact> ProjectSpaced(const ContactPlaces& places, const GraspPoints& generated,
                                        const std::vector<GraspContact>& fixed, bool may_drop);

}  // namespace pregrasp
