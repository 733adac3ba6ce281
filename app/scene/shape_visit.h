#pragma once

#include <type_traits>

#include "app/core/check.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// Calls `visit` with the shape as what it is: a Box, Cylinder, Capsule or Sphere, or the
/// TriangleMesh of a Mesh or Cloud. Where a new kind of shape is forgotten, that does not compile.
/// The shape is no Union.
template <typename Visit>
decltype(auto) VisitLeaf(const Shape& leaf, const Visit& visit) {
  using Result = std::invoke_result_t<Visit, const Box&>;
  return std::visit(
      [&](const auto& shape) -> Result {
        using Kind = std::decay_t<decltype(shape)>;
        if constexpr (std::is_same_v<Kind, Union>) {
          PREGRASP_CHECK(false, "a union is no leaf");
          return visit(Box());
        } else if constexpr (std::is_same_v<Kind, Mesh> || std::is_same_v<Kind, Cloud>) {
          return visit(shape.mesh);
        } else {
          return visit(shape);
        }
      },
      leaf);
}

/// Calls `visit(leaf, X_BP)` for every shape within `shape` that is no union, its frame P placed in
/// B; nested unions are flattened.
/// @param X_BP  places `shape` itself.
template <typename Visit>
void ForEachLeaf(const Shape& shape, const RigidTransform& X_BP, const Visit& visit) {
  const auto* whole = std::get_if<Union>(&shape);
  if (whole == nullptr) {
    visit(shape, X_BP);
    return;
  }
  for (const PlacedShape& part : whole->parts) {
    ForEachLeaf(part.shape, X_BP * part.X_BP, visit);
  }
}

}  // namespace pregrasp
