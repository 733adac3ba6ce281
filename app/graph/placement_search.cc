#include "app/graph/placement_search.h"

#include <algorithm>
#include <numeric>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/finite.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

// Points spread over the mesh by area, where a fingertip can be.
std::vector<Placement::Contact> SampleContacts(Finger finger, const TriangleMesh& mesh,
                                               const SignedDistance& shape,
                                               const PlacementScorer& scorer, int count, Rng& rng) {
  std::vector<double> area_up_to;
  double total = 0.0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Vector3 a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                  c = mesh.V.row(mesh.F(t, 2));
    total += 0.5 * (b - a).cross(c - a).norm();
    area_up_to.push_back(total);
  }
  std::vector<Placement::Contact> contacts;
  for (int i = 0; i < count; ++i) {
    const double target = total * (i + rng.Uniform()) / count;
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, target);
    const int t = static_cast<int>(found - area_up_to.begin());
    const double u = rng.Uniform(), v = rng.Uniform();
    const Placement::Contact contact =
        ContactOnTriangle(mesh, t, BarycentricFromSquare(u, v), shape);
    const bool free = !scorer.IsOccluded(finger, contact) &&
                      HasRoom(scorer.tips().radius(finger), contact, shape);
    if (free) contacts.push_back(contact);
  }
  return contacts;
}

bool AreNear(const Placement& a, const Placement& b, double spacing) {
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (a.fingers[f].on != b.fingers[f].on) return false;
    if (a.fingers[f].on && (a.fingers[f].p_OC - b.fingers[f].p_OC).norm() > spacing) return false;
  }
  return true;
}

}  // namespace

void PlacementSearchConfig::Validate() const {
  if (!(max_tip_distance > 0.0 && spacing >= 0.0)) {
    throw InputError("", "max_tip_distance", "a length above 0, and no negative spacing",
                     FormatDouble(std::min(max_tip_distance, spacing)));
  }
}

std::vector<Placement> FindPlacements(const TriangleMesh& mesh, const SignedDistance& shape,
                                      const PlacementScorer& scorer, const Placement& fixed,
                                      int count, const PlacementSearchConfig& config, Rng rng) {
  config.Validate();
  PREGRASP_CHECK(config.points >= 1 && config.pairs >= 0, config.points, config.pairs);
  std::array<std::vector<Placement::Contact>, kNumPlanningFingers> contacts;
  std::vector<Placement> candidates;
  const bool any_fixed = fixed.thumb().on || fixed.index().on;
  if (any_fixed) candidates.push_back(fixed);
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (fixed.fingers[f].on) {
      contacts[f] = {fixed.fingers[f]};
      continue;
    }
    contacts[f] = SampleContacts(static_cast<Finger>(f), mesh, shape, scorer, config.points, rng);
    for (const Placement::Contact& contact : contacts[f]) {
      if (any_fixed) break;  // with the fixed one, it is a pair
      Placement placement;
      placement.fingers[f] = contact;
      candidates.push_back(placement);
    }
  }
  const auto draw = [&](int f) -> const Placement::Contact& {
    return contacts[f][rng.UniformInt(static_cast<std::uint32_t>(contacts[f].size()))];
  };
  const bool both_fixed = fixed.thumb().on && fixed.index().on;
  const bool pairs = !both_fixed && !contacts[0].empty() && !contacts[1].empty();
  for (int i = 0; pairs && i < config.pairs; ++i) {
    Placement placement;
    placement.fingers = {draw(0), draw(1)};
    const double span = (placement.thumb().p_OC - placement.index().p_OC).norm();
    if (CalcTipGap(scorer.tips(), placement) >= 0.0 && span <= config.max_tip_distance) {
      candidates.push_back(placement);
    }
  }

  const std::vector<double> scores = scorer.Score(candidates);
  PREGRASP_CHECK(scores.size() == candidates.size(), scores.size(), candidates.size());
  PREGRASP_CHECK(IsFinite(scores));
  std::vector<int> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return scores[a] > scores[b]; });
  std::vector<Placement> best;
  for (const int i : order) {
    if (static_cast<int>(best.size()) == count) break;
    const bool near = std::any_of(best.begin(), best.end(), [&](const Placement& other) {
      return AreNear(candidates[i], other, config.spacing);
    });
    if (!near) best.push_back(candidates[i]);
  }
  return best;
}

}  // namespace pregrasp
