#include "app/studies/grasp_library.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/grasp/grasp_search.h"
#include "app/studies/free_object.h"

namespace pregrasp {
namespace {

constexpr int kGraspsKept = 24;        // of one object
constexpr double kUnusedFinger = 0.1;  // counts as so far from what is given [m]

// Stretches a point of one box to its place in another.
Vector3 Stretch(const Vector3& p, const AlignedBox& from, const AlignedBox& to) {
  const Vector3 ratio = to.sizes().cwiseQuotient(from.sizes().cwiseMax(1e-6));
  return to.center() + (p - from.center()).cwiseProduct(ratio);
}

double CalcUnlikeness(const AlignedBox& a, const AlignedBox& b) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    sum += std::abs(std::log(std::max(a.sizes()[axis], 1e-6) / std::max(b.sizes()[axis], 1e-6)));
  }
  return sum;
}

}  // namespace

GraspLibrary::GraspLibrary(const std::vector<std::string>& families, int members,
                           std::uint64_t seed, ThreadPool& pool) {
  ItemConfig items;
  items.seed = seed;
  for (const std::string& family : families) {
    for (int member = 0; member < members; ++member) {
      ThrowIfInterrupted();
      const std::int64_t index = ItemOfFamily(family, member);
      const FreeObject object(items, index);
      const GraspWorld world = MakeTrainingWorld(object.scene);
      const auto X_WB = world.StartPoses();
      const ContactPlaces places(world, X_WB);
      GraspSearchConfig search;
      search.max_found = kGraspsKept;
      const GraspSearchResult result = SearchGrasps(
          places, search, {}, Rng(seed, RngStream::kProbedContacts, index).NextU64(), pool);
      if (result.found.empty()) continue;
      KnownObject known{object.box, {}};
      for (const auto& found : result.found) known.grasps.push_back(found.contacts);
      objects_.push_back(std::move(known));
    }
  }
}

int GraspLibrary::num_grasps() const {
  int count = 0;
  for (const KnownObject& object : objects_) count += static_cast<int>(object.grasps.size());
  return count;
}

std::vector<GraspPoints> GraspLibrary::FindNearest(const AlignedBox& box,
                                                   const PlanningContacts& given, int count) const {
  PREGRASP_CHECK(!objects_.empty());
  const KnownObject& like = *std::min_element(
      objects_.begin(), objects_.end(), [&](const KnownObject& a, const KnownObject& b) {
        return CalcUnlikeness(a.box, box) < CalcUnlikeness(b.box, box);
      });
  std::vector<std::pair<double, GraspPoints>> grasps;
  for (const std::vector<GraspContact>& grasp : like.grasps) {
    GraspPoints points;
    points.fill(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    for (const GraspContact& contact : grasp) {
      points[static_cast<int>(contact.finger)] = Stretch(contact.p_OC, like.box, box);
    }
    double way = 0.0;
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (!given[f]) continue;
      way += points[f].allFinite() ? (points[f] - given[f]->p_OC).norm() : kUnusedFinger;
      points[f] = given[f]->p_OC;
    }
    grasps.emplace_back(way, points);
  }
  std::stable_sort(grasps.begin(), grasps.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<GraspPoints> nearest;
  for (int i = 0; i < std::min<int>(count, std::ssize(grasps)); ++i) {
    nearest.push_back(grasps[i].second);
  }
  return nearest;
}

}  // namespace pregrasp
