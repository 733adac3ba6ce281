#pragma once

#include <vector>

#include "app/core/thread_pool.h"
#include "app/geometry/sharp_edges.h"
#include "app/grasp/grasp_world.h"

namespace pregrasp {

// Where fingertips can touch the object's convex edges and corners. The normal of such a contact
// leads from where the sphere touches to the sphere's centre, and may be any of the fan between the
// faces' normals that leaves the sphere free of the surroundings. Plans and grasps keep to faces;
// these contacts are for the question whether the object can be grasped where it stands.

/// Edges whose faces meet at more than this are such edges [rad]: a fan that is not wider is told
/// by the normals of the faces' samples. Smaller than kSharpAngle, so that the question covers more
/// than the edges that contacts of plans keep away from.
inline constexpr double kLeastFan = kPi / 36.0;

/// Contacts that stand for all that a fingertip sphere of `radius` can have at `points`: the free
/// part of each fan, and a little more, lies in the hull of those given there. A part of a fan is
/// left out only where it is blocked as a whole, by the bound that a centre moves no farther than
/// radius times the turn; undecided parts, at most 0.02 degrees wide at edges, 0.1 to 1 degree at
/// corners (the more corners, the wider), count as free. Directions between two of an arc need no
/// wider cone: equal circular cones around its ends have those between in their hull.
/// @param points  FindEdgePoints of the object.
/// @param slack   how far the sphere may overlap the object itself [m]; the surroundings not at
///                all.
/// @param X_WB    every body's pose, the object first.
/// @return in the order of `points`; all with `on_edge` set, and the index finger's.
std::vector<GraspContact> FindOuterEdgeContacts(const GraspWorld& world,
                                                const std::vector<EdgePoint>& points, double radius,
                                                double slack,
                                                const std::vector<RigidTransform>& X_WB,
                                                ThreadPool& pool);

/// Contacts that a fingertip sphere of `radius` does have at `points`, for searches: of each fan
/// directions no more than 5 degrees apart (corners: 12), and the last free ones of an edge's.
std::vector<GraspContact> FindFreeEdgeContacts(const GraspWorld& world,
                                               const std::vector<EdgePoint>& points, double radius,
                                               double slack,
                                               const std::vector<RigidTransform>& X_WB);

}  // namespace pregrasp
