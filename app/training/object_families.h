#pragma once

#include <string>
#include <vector>

#include "app/core/rng.h"
#include "app/scene/shape.h"

namespace pregrasp {

/// An object to learn from: a loaded shape, in its own frame centred on its bounding box, with z up
/// where the object has a way it stands.
struct TrainingObject {
  std::string family;  ///< one of ObjectFamilies()
  std::string name;    ///< the family with the object's main measures, for people
  Shape shape;
  double mass = 0.0;  ///< [kg]
};

/// The kinds of household objects that training shapes are drawn from, in a fixed order. Families
/// are what a split into training and validation keeps whole.
const std::vector<std::string>& ObjectFamilies();

/// A random member with life-size dimensions and the mass of what such a thing is made of or
/// filled with (0.01 to 2.5 kg; 4 to 50 cm long). A pure function of `family` and the stream.
/// @throws InputError if there is no such family.
TrainingObject SampleObject(const std::string& family, Rng rng);

}  // namespace pregrasp
