#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "app/core/rng.h"
#include "app/grasp/contact_places.h"

namespace pregrasp {

struct SamplerConfig {
  /// A "near" set keeps the tip centres of fingers i and j within spacing |i - j| + offset [m], the
  /// thumb free: one to two orders of magnitude more grasps per second on flat objects than any
  /// tips within reach of each other.
  double near_spacing = 0.03;
  double near_offset = 0.01;
  double near_share = 0.8;  ///< of all sets; the others only keep the hand's reach
  /// Share of sets whose thumb lies opposite a finger: where a line from the finger's contact
  /// within its friction cone leaves the object.
  double opposed_share = 0.6;
  /// What a fingertip sphere at a contact may overlap.
  TouchSlack slack;

  void Validate() const;
};

/// Draws plausible contact sets of three to five fingers, always thumb, index and middle finger:
/// contacts where a fingertip can be with the bodies at given poses, tips no nearer and no farther
/// from each other than a hand can bring them. Immutable, safe to share between threads.
class ContactSampler {
 public:
  /// @param world  outlives this.
  ContactSampler(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                 const SamplerConfig& config);
  /// The same with places made already, in place of those of the configuration's slack.
  /// @param places  outlives this.
  ContactSampler(const ContactPlaces& places, const SamplerConfig& config);

  /// A set that holds the contacts in `fixed`, or none if this draw came to nothing. Contacts in
  /// order of their fingers.
  std::optional<std::vector<GraspContact>> Sample(const std::vector<GraspContact>& fixed,
                                                  Rng& rng) const;

  /// Surface points where the finger's tip can be.
  int num_points(Finger finger) const { return places_.count(finger); }

 private:
  struct Draw {
    bool near = false;
    bool opposed = false;
  };

  std::optional<GraspContact> DrawOpposite(const GraspContact& from, Finger finger, Rng& rng) const;
  std::optional<GraspContact> DrawContact(Finger finger, const std::vector<GraspContact>& placed,
                                          const Draw& draw, Rng& rng) const;
  bool Fits(const GraspContact& contact, const std::vector<GraspContact>& placed,
            const Draw& draw) const;

  std::shared_ptr<const ContactPlaces> owned_;  // null for places made already
  const ContactPlaces& places_;
  const GraspWorld& world_;
  SamplerConfig config_;
};

}  // namespace pregrasp
