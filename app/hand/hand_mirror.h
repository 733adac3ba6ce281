#pragma once

#include "app/hand/hand_model.h"

namespace pregrasp {

/// Makes a left hand of a right one and the other way round: x becomes -x in every frame. Angles
/// and limits of joints stay as they are.
void MirrorHand(HandModel* hand);

}  // namespace pregrasp
