#pragma once

#include "app/training/dataset.h"

namespace pregrasp {

/// A data set's objects, states and truths in few bytes, so that what searches of many hours found
/// can be kept with the sources: places to 1/65535 of the object's box, normals to a degree, signed
/// distances to half a millimetre between -20 and 100 mm (beyond which networks do not look),
/// progress to 1/255. Grasps and labels of completions are left out. The same content gives the
/// same bytes.
TensorFile PackStates(const Dataset& dataset);

/// What PackStates kept. @throws InputError for a file that is not its work.
Dataset UnpackStates(const TensorFile& file);

}  // namespace pregrasp
