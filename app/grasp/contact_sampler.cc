#include "app/grasp/contact_sampler.h"

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr int kContactTries = 8;          // draws of one contact before the set is given up
constexpr double kBesideOpposite = 0.02;  // [m], between tip centres

bool IsThumb(Finger finger) { return finger == Finger::kThumb; }

void RequireShare(const char* field, double value) {
  if (!(value >= 0.0 && value <= 1.0)) {
    throw InputError("sampler", field, "a share from 0 to 1", FormatDouble(value));
  }
}

void RequireLength(const char* field, double value) {
  if (!(std::isfinite(value) && value >= 0.0)) {
    throw InputError("sampler", field, "a length of at least 0 m", FormatDouble(value));
  }
}

}  // namespace

void SamplerConfig::Validate() const {
  RequireLength("near_spacing", near_spacing);
  RequireLength("near_offset", near_offset);
  RequireShare("near_share", near_share);
  RequireShare("opposed_share", opposed_share);
}

ContactSampler::ContactSampler(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                               const SamplerConfig& config)
    : owned_(std::make_shared<const ContactPlaces>(world, X_WB, config.slack)),
      places_(*owned_),
      world_(world),
      config_(config) {
  config_.Validate();
}

ContactSampler::ContactSampler(const ContactPlaces& places, const SamplerConfig& config)
    : places_(places), world_(places.world()), config_(config) {
  config_.Validate();
}

// Where a line into the object, within the friction cone of `from`, comes out again.
std::optional<GraspContact> ContactSampler::DrawOpposite(const GraspContact& from, Finger finger,
                                                         Rng& rng) const {
  const Matrix3 R = FrameFromNormal(from.nhat_O);
  const double lean = world_.scene().fingertips.friction * std::sqrt(rng.Uniform());
  const double angle = rng.Uniform(0.0, 2.0 * kPi);
  const Vector3 along =
      (R * Vector3(lean * std::cos(angle), lean * std::sin(angle), -1.0)).normalized();
  const double longest = world_.object().bounds().diagonal().norm();
  double t = 1e-4;
  for (int step = 0; step < 100 && t < longest; ++step) {
    const double phi = world_.object().Calc(from.p_OC + t * along);
    if (phi > -1e-6) break;
    t += std::max(-phi, 1e-5);
  }
  const Vector3 p_out = from.p_OC + t * along;
  const GraspContact contact = world_.ContactNear(finger, p_out);
  if (places_.Allows(contact)) return contact;
  if (!places_.has_edges()) return std::nullopt;
  // The tip has no room on that face, but perhaps on an edge of it.
  const int place =
      places_.DrawNear(finger, world_.tips().Centre(finger, p_out, along), kBesideOpposite, rng);
  if (place == ContactPlaces::kNone) return std::nullopt;
  return places_.At(finger, place);
}

bool ContactSampler::Fits(const GraspContact& contact, const std::vector<GraspContact>& placed,
                          const Draw& draw) const {
  const int f = static_cast<int>(contact.finger);
  const TipSpheres& tips = world_.tips();
  const Vector3 centre = TipCentre(tips, contact);
  for (const GraspContact& other : placed) {
    const int g = static_cast<int>(other.finger);
    const double distance = (TipCentre(tips, other) - centre).norm();
    double farthest = world_.reach().farthest[f][g];
    if (draw.near && !IsThumb(contact.finger) && !IsThumb(other.finger)) {
      farthest = std::min(farthest, config_.near_spacing * std::abs(f - g) + config_.near_offset);
    }
    const bool fits =
        distance >= world_.reach().nearest[f][g] && distance <= farthest &&
        tips.CalcGap(contact.finger, centre, other.finger, TipCentre(tips, other)) >= 0.0;
    if (!fits) return false;
  }
  return true;
}

std::optional<GraspContact> ContactSampler::DrawContact(Finger finger,
                                                        const std::vector<GraspContact>& placed,
                                                        const Draw& draw, Rng& rng) const {
  // Those on the other side of the hand: the thumb for a finger, the fingers for the thumb.
  std::vector<const GraspContact*> across, beside;
  for (const GraspContact& other : placed) {
    (IsThumb(other.finger) != IsThumb(finger) ? across : beside).push_back(&other);
  }
  for (int attempt = 0; attempt < kContactTries; ++attempt) {
    std::optional<GraspContact> contact;
    if (draw.opposed && !across.empty() && beside.empty()) {
      contact = DrawOpposite(*across[rng.UniformInt(across.size())], finger, rng);
    } else {
      int place = ContactPlaces::kNone;
      if (draw.near && !beside.empty()) {
        const GraspContact& other = *beside[rng.UniformInt(beside.size())];
        const int apart = std::abs(static_cast<int>(finger) - static_cast<int>(other.finger));
        place = places_.DrawNear(finger, TipCentre(world_.tips(), other),
                                 config_.near_spacing * apart + config_.near_offset, rng);
      } else {
        place = places_.DrawAny(finger, rng);
      }
      if (place != ContactPlaces::kNone) contact = places_.At(finger, place);
    }
    if (contact && Fits(*contact, placed, draw)) return contact;
  }
  return std::nullopt;
}

std::optional<std::vector<GraspContact>> ContactSampler::Sample(
    const std::vector<GraspContact>& fixed, Rng& rng) const {
  Draw draw;
  draw.near = rng.Uniform() < config_.near_share;
  draw.opposed = rng.Uniform() < config_.opposed_share;
  // Edges have many directions at each point: without this, hardly a set would keep to faces.
  const bool faces_only = places_.has_edges() && rng.Uniform() < 0.5;
  const std::uint32_t extra = rng.UniformInt(4);  // with ring, with little
  const TipSpheres& tips = world_.tips();
  std::vector<Finger> fingers{Finger::kMiddle, Finger::kIndex};
  if (!tips.has(Finger::kMiddle)) fingers = {Finger::kIndex};
  if ((extra & 1) && tips.has(Finger::kRing)) fingers.push_back(Finger::kRing);
  if ((extra & 2) && tips.has(Finger::kLittle)) fingers.push_back(Finger::kLittle);
  fingers.push_back(Finger::kThumb);

  std::vector<GraspContact> contacts = fixed;
  for (const Finger finger : fingers) {
    if (FindContact(fixed, finger) != nullptr) continue;
    std::optional<GraspContact> contact = DrawContact(finger, contacts, draw, rng);
    for (int attempt = 1; attempt < kContactTries && contact && contact->on_edge && faces_only;
         ++attempt) {
      contact = DrawContact(finger, contacts, draw, rng);
    }
    if (!contact || (contact->on_edge && faces_only)) return std::nullopt;
    contacts.push_back(*contact);
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const GraspContact& a, const GraspContact& b) { return a.finger < b.finger; });
  return contacts;
}

}  // namespace pregrasp
