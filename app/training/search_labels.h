#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "app/dynamics/world.h"
#include "app/geometry/point_cloud.h"
#include "app/grasp/grasp_room.h"
#include "app/grasp/grasp_search.h"
#include "app/grasp/grasp_world.h"
#include "app/grasp/lift_simulation.h"
#include "app/training/dataset.h"
#include "app/training/motion_states.h"

namespace pregrasp {

/// How contacts in one state are labelled by contact searches.
struct SearchLabelConfig {
  GraspSearchConfig
      search;  ///< at each relief; bounded, as most costs arise where nothing is found
  int thumbs = 14, indices = 14, pairs = 20;  ///< contacts labelled in a state without a press
  int held_pairs = 47;                        ///< and beside a finger that has to keep pressing
  double near_found = 0.5;                    ///< share of contacts drawn near those of a found set
  double moved = 0.015;                       ///< by up to so much [m]
  double anywhere = 0.1;  ///< share of contacts that are any points of the surface
  int donors = 3;         ///< found sets that a contact is put into, the nearest ones
  GraspConfig test;       ///< of such sets
  LiftConfig lift;

  SearchLabelConfig();
};

/// What one state costs and gives.
struct SearchLabelStats {
  std::array<int, kNumReliefs> found{};  ///< grasps by relief
  int tests = 0;                         ///< sets put to inverse kinematics beside the searches
  int lifts = 0, lifted = 0;             ///< simulated, and held
};

struct SearchLabels {
  std::vector<TruthRecord> truths;
  std::vector<GraspRecord> grasps;  ///< feasible and lifted, no two within 5 mm in every contact
  SearchLabelStats stats;
};

/// Labels many contacts of one state by one contact search at each relief (kReliefs): a contact, or
/// a pair, is put into the nearest found sets, whose other contacts come along, and the set is put
/// to the test again.
/// - `lifted`: one of these sets is a feasible grasp and the hand picks the object up with it: a
///   free way, stiff forces (ChooseGraspForces), and the lift simulated, once, by the kernel
///   (without surroundings, where nothing holds the object until fingers do: not simulated).
/// - `relief`: the share of reliefs from the least one on at which fingertips have room for such a
///   set and forces hold it. No inverse kinematics of its own: the found set had it.
/// - `room`: GraspRoom::CalcWith.
/// Contacts with context 0; a pure function of its arguments.
/// @param world  null where there are no surroundings.
/// @param cloud  of the object. @param state  contacts in `fixed` are part of every label.
SearchLabels LabelState(const World* world, const GraspWorld& grasp_world, const GraspRoom& room,
                        const PointCloud& cloud, const ReachedState& state,
                        const SearchLabelConfig& config, std::uint64_t seed);

/// The contacts of `truths`, which LabelState gave of this state, labelled again by searches and a
/// room of their own: as far as the labels differ, they are noise.
std::vector<TruthRecord> LabelAgain(const World* world, const GraspWorld& grasp_world,
                                    const GraspRoom& room, const PointCloud& cloud,
                                    const ReachedState& state, const SearchLabelConfig& config,
                                    const std::vector<TruthRecord>& truths, std::uint64_t seed);

}  // namespace pregrasp
