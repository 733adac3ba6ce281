#pragma once

#include "app/training/make_item.h"
#include "app/training/motion_states.h"
#include "app/training/search_labels.h"

namespace pregrasp {

/// What decides the items of a data set labelled by search, beside ItemConfig's objects and seed.
struct StateItemConfig {
  ItemConfig item;
  MotionStatesConfig motion;
  SearchLabelConfig labels;
  GraspRoomConfig room;

  StateItemConfig();

  /// What decides an item: a data set's description.
  std::string ToJson() const;
};

/// Item `index`: an object in `item.scenes` scenes at rest, in each the states of simulated motions
/// (SampleMotionStates), in each state contacts labelled by search (LabelState), and the grasps
/// found. Kinds of contexts are those of SampleRestingScene followed by "moved", "held".
DatasetItem MakeStateItem(const StateItemConfig& config, std::int64_t index);

}  // namespace pregrasp
