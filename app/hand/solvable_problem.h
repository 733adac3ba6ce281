#pragma once

#include <array>
#include <vector>

#include "app/core/rng.h"
#include "app/hand/ik.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// What lies on the table.
enum class IkObject { kBox, kCylinder, kPlate, kMesh };
inline constexpr int kNumIkObjects = 4;
inline constexpr std::array<const char*, kNumIkObjects> kIkObjectNames{"box", "cylinder", "plate",
                                                                       "mesh"};

/// A problem that has a solution, made without any solver: a random hand, free and open, closes
/// each finger until its tip touches.
struct SolvableProblem {
  std::vector<Shape> shapes;  ///< the object, the table and, in clutter, a wall and three boxes
  IkProblem problem;
  HandConfiguration truth;

  std::vector<const Shape*> pointers() const {
    std::vector<const Shape*> out;
    for (const Shape& shape : shapes) out.push_back(&shape);
    return out;
  }
};

/// @param fingers  how many touch: always the thumb, the others at random.
SolvableProblem MakeSolvableProblem(IkObject object, int fingers, bool clutter, Rng& rng);

/// A closed star-shaped mesh with bumps and hollows, about `size` across.
TriangleMesh MakeBumpyMesh(double size, Rng& rng);

}  // namespace pregrasp
