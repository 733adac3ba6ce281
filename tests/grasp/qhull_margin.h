#pragma once

#include <span>

#include "app/grasp/wrench.h"

namespace pregrasp {

using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// The wrenches whose hull the margin is about, from its definition: 16 edges a cone, unit normal
/// component.
MatrixX6 CalcEdgeWrenches(std::span<const WrenchContact> contacts, double mu, double torque_scale);

/// The whole hull by qhull, joggled so that symmetric sets have simplicial facets too; the smallest
/// signed distance of the origin from a facet's plane.
double CalcNearestFacetByQhull(const MatrixX6& points);

}  // namespace pregrasp
