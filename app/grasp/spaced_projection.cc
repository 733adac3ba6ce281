#include "app/grasp/spaced_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pregrasp {
namespace {

constexpr int kSweeps = 60;          // over all pairs; five tips on one spot need about 20
constexpr double kOvershoot = 5e-5;  // [m], so that pushing apart ends
constexpr int kPulledSweeps = 30;    // the first of them
constexpr double kPull = 0.3;        // of the way back, in the first; less and less in the others
constexpr double kSteepest = 0.2;    // least share of a push that must lie along the surface

struct Tip {
  GraspContact contact;
  Vector3 wish = Vector3::Zero();       // the generated point
  Vector3 projected = Vector3::Zero();  // the place nearest to it
  bool fixed = false;
};

double GapOf(const TipSpheres& spheres, const Tip& a, const Tip& b) {
  return CalcTipGap(spheres, a.contact, b.contact);
}

bool HasRoom(const TipSpheres& spheres, const Tip& a, const Tip& b) {
  return (a.fixed && b.fixed) || GapOf(spheres, a, b) >= kTipRoom;
}

bool AllHaveRoom(const TipSpheres& spheres, const std::vector<Tip>& tips) {
  for (std::size_t i = 0; i < tips.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!HasRoom(spheres, tips[i], tips[k])) return false;
    }
  }
  return true;
}

// From b's tip to a's, unit; where they are one, the way their points differ, else one of five
// directions along the surface.
Vector3 CalcDirection(const TipSpheres& spheres, const Tip& a, const Tip& b) {
  constexpr double kSame = 1e-6;  // [m]
  const Vector3 between = TipCentre(spheres, a.contact) - TipCentre(spheres, b.contact);
  if (between.norm() > kSame) return between.normalized();
  const Vector3& nhat = a.contact.nhat_O;
  Vector3 wished = a.wish - b.wish;
  wished -= wished.dot(nhat) * nhat;
  if (wished.norm() > kSame) return wished.normalized();
  const double angle = 2.0 * kPi * static_cast<int>(a.contact.finger) / kNumFingers;
  return FrameFromNormal(nhat) * Vector3(std::cos(angle), std::sin(angle), 0.0);
}

// Moves the tip so far along the surface that it gets on by `way` in a direction.
void Push(const ContactPlaces& places, const Vector3& direction, double way, Tip* tip) {
  const Vector3& nhat = tip->contact.nhat_O;
  const Vector3 along = direction - direction.dot(nhat) * nhat;
  const double share = along.norm();
  if (!(share > kSteepest)) return;
  const Vector3 p_O = tip->contact.p_OC + way / (share * share) * along;
  if (const auto contact = places.Project(tip->contact.finger, p_O)) tip->contact = *contact;
}

// Moves tips that were pushed by a share of the way back.
void PullBack(const ContactPlaces& places, double share, std::vector<Tip>& tips) {
  for (Tip& tip : tips) {
    const Vector3 back = tip.projected - tip.contact.p_OC;
    if (tip.fixed || !(back.norm() > kOvershoot)) continue;
    const auto contact = places.Project(tip.contact.finger, tip.contact.p_OC + share * back);
    if (contact) tip.contact = *contact;
  }
}

// Pushes overlapping pairs apart in turn, each tip by half, and at first pulls them back between,
// so that they end close together.
bool PushApart(const ContactPlaces& places, std::vector<Tip>& tips) {
  const TipSpheres& spheres = places.world().tips();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool all = true;
    const double pull = kPull * (1.0 - static_cast<double>(sweep) / kPulledSweeps);
    if (pull > 0.0) PullBack(places, pull, tips);
    for (std::size_t i = 0; i < tips.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (HasRoom(spheres, tips[i], tips[k])) continue;
        all = false;
        const double way = kTipRoom + kOvershoot - GapOf(spheres, tips[i], tips[k]);
        const Vector3 direction = CalcDirection(spheres, tips[i], tips[k]);
        const double half = tips[i].fixed || tips[k].fixed ? 1.0 : 0.5;
        if (!tips[i].fixed) Push(places, direction, half * way, &tips[i]);
        if (!tips[k].fixed) Push(places, -direction, half * way, &tips[k]);
      }
    }
    if (all && (pull <= 0.0 || sweep == 0)) return true;
  }
  return AllHaveRoom(spheres, tips);
}

// The place nearest to the tip's wish with room beside `placed`; the tip as it is if there is none.
Tip PlaceBeside(const ContactPlaces& places, const Tip& tip, const std::vector<Tip>& placed) {
  const TipSpheres& spheres = places.world().tips();
  const auto has_room = [&](const Tip& trial) {
    return std::all_of(placed.begin(), placed.end(),
                       [&](const Tip& other) { return HasRoom(spheres, trial, other); });
  };
  if (has_room(tip)) return tip;
  Tip best = tip;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < places.count(tip.contact.finger); ++i) {
    Tip trial = tip;
    trial.contact = places.At(tip.contact.finger, i);
    const double distance = (trial.contact.p_OC - tip.wish).squaredNorm();
    if (!(distance < least) || !has_room(trial)) continue;
    least = distance;
    best = trial;
  }
  return best;
}

std::vector<Tip> PlaceInTurn(const ContactPlaces& places, const std::vector<Tip>& projected) {
  std::vector<Tip> placed;
  for (const Tip& tip : projected) {
    if (tip.fixed) placed.push_back(tip);
  }
  for (const Tip& tip : projected) {
    if (!tip.fixed) placed.push_back(PlaceBeside(places, tip, placed));
  }
  return placed;
}

std::vector<Tip> ProjectEach(const ContactPlaces& places, const GraspPoints& generated,
                             const std::vector<GraspContact>& fixed, bool may_drop) {
  std::vector<Tip> tips;
  for (int f = 0; f < places.world().tips().count; ++f) {
    const Finger finger = static_cast<Finger>(f);
    if (const GraspContact* given = FindContact(fixed, finger)) {
      tips.push_back({*given, given->p_OC, given->p_OC, true});
      continue;
    }
    const bool known = generated[f].allFinite();
    if (!known && may_drop && IsDroppable(finger)) continue;
    const Vector3 wish = known ? generated[f] : places.world().object().bounds().center();
    if (const auto contact = places.Project(finger, wish)) {
      tips.push_back({*contact, wish, contact->p_OC, false});
    }
  }
  return tips;
}

}  // namespace

std::vector<GraspContact> ProjectSpaced(const ContactPlaces& places, const GraspPoints& generated,
                                        const std::vector<GraspContact>& fixed, bool may_drop) {
  const std::vector<Tip> projected = ProjectEach(places, generated, fixed, may_drop);
  std::vector<Tip> tips = projected;
  if (!PushApart(places, tips)) tips = PlaceInTurn(places, projected);
  std::vector<GraspContact> contacts;
  for (const Tip& tip : tips) contacts.push_back(tip.contact);
  std::sort(contacts.begin(), contacts.end(),
            [](const GraspContact& a, const GraspContact& b) { return a.finger < b.finger; });
  return contacts;
}

}  // namespace pregrasp
