#pragma once

#include <memory>

#include "app/hand/ik.h"

namespace pregrasp {

/// The peer of collision-free inverse kinematics: Simbody's Assembler with a Markers goal that
/// draws fingertip centres to their targets, joint limits as restrictions.
class SimbodyAssembler {
 public:
  explicit SimbodyAssembler(const HandModel& hand);
  ~SimbodyAssembler();

  /// From `start`, to tips within `accuracy` [m]. Ends at the nearest assembly it finds.
  HandConfiguration Solve(const std::vector<IkContact>& contacts, const HandConfiguration& start,
                          double accuracy);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pregrasp
