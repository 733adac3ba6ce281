#include "app/grasp/contact_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/core/interrupt.h"
#include "app/grasp/edge_contacts.h"

namespace pregrasp {
namespace {

constexpr double kCell = 0.02;  // [m]
constexpr int kPlaceTries = 8;  // draws before a neighbourhood is given up

// A direction's octant, face or edge of a cube: 26 buckets.
int BucketOf(const Vector3& nhat) {
  int bucket = 0;
  for (int i = 0; i < 3; ++i) {
    bucket = 3 * bucket + (nhat[i] < -0.38 ? 0 : nhat[i] > 0.38 ? 2 : 1);
  }
  return bucket;
}

}  // namespace

bool ContactPlaces::CellRange::empty() const {
  return low[0] > high[0] || low[1] > high[1] || low[2] > high[2];
}

ContactPlaces::ContactPlaces(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                             const TouchSlack& slack)
    : ContactPlaces(world, X_WB, slack, {}, 0.0) {}

ContactPlaces::ContactPlaces(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                             const TouchSlack& slack, const std::vector<EdgePoint>& edges,
                             double edge_slack)
    : world_(world), X_WB_(X_WB), slack_(slack) {
  const TipSpheres& tips = world_.tips();
  for (int f = 0; f < tips.count; ++f) {
    int same = 0;
    while (tips.radii[same] != tips.radii[f]) ++same;
    if (same == f) {
      pool_of_[f] = static_cast<int>(pools_.size());
      pools_.push_back(MakePool(static_cast<Finger>(f), edges, edge_slack));
    } else {
      pool_of_[f] = pool_of_[same];
    }
  }
  for (const Pool& pool : pools_) {
    has_edges_ = has_edges_ || (!pool.contact.empty() && pool.contact.back().on_edge);
  }
}

ContactPlaces::Pool ContactPlaces::MakePool(Finger finger, const std::vector<EdgePoint>& edges,
                                            double edge_slack) const {
  Pool pool;
  const double radius = world_.tips().radius(finger);
  std::vector<std::vector<int>> buckets(27);
  const auto add = [&](const GraspContact& contact) {
    buckets[BucketOf(contact.nhat_O)].push_back(static_cast<int>(pool.contact.size()));
    pool.contact.push_back(contact);
    pool.centre.emplace_back(contact.p_OC + radius * contact.nhat_O);
  };
  const SurfacePoints& surface = world_.surface();
  for (int i = 0; i < surface.P.rows(); ++i) {
    ThrowIfInterrupted();
    const Vector3 p = surface.P.row(i);
    const Vector3 nhat = surface.N.row(i);
    if (!CanTouch(p, nhat, radius, slack_, world_.object(), world_.environment(), X_WB_)) continue;
    add({finger, p, nhat});
  }
  for (const GraspContact& contact :
       FindFreeEdgeContacts(world_, edges, radius, edge_slack, X_WB_)) {
    add(contact);
  }
  for (std::vector<int>& bucket : buckets) {
    if (!bucket.empty()) pool.buckets.push_back(std::move(bucket));
  }
  if (!pool.contact.empty()) MakeGrid(pool);
  return pool;
}

void ContactPlaces::MakeGrid(Pool& pool) {
  Eigen::AlignedBox3d box;
  for (const Vector3& centre : pool.centre) box.extend(centre);
  pool.corner = box.min();
  for (int k = 0; k < 3; ++k) pool.cells[k] = 1 + static_cast<int>(box.sizes()[k] / kCell);
  const auto cell_of = [&](const Vector3& p) {
    int cell = 0;
    for (int k = 0; k < 3; ++k) {
      const int index = static_cast<int>((p[k] - pool.corner[k]) / kCell);
      cell = cell * pool.cells[k] + std::min(index, pool.cells[k] - 1);
    }
    return cell;
  };
  pool.cell_start.assign(pool.cells[0] * pool.cells[1] * pool.cells[2] + 1, 0);
  for (const Vector3& centre : pool.centre) ++pool.cell_start[cell_of(centre) + 1];
  for (std::size_t i = 1; i < pool.cell_start.size(); ++i) {
    pool.cell_start[i] += pool.cell_start[i - 1];
  }
  std::vector<int> next(pool.cell_start.begin(), pool.cell_start.end() - 1);
  pool.cell_points.resize(pool.centre.size());
  for (std::size_t i = 0; i < pool.centre.size(); ++i) {
    pool.cell_points[next[cell_of(pool.centre[i])]++] = static_cast<int>(i);
  }
}

ContactPlaces::CellRange ContactPlaces::CellsAround(const Pool& pool, const Vector3& centre,
                                                    double distance) {
  CellRange range;
  for (int k = 0; k < 3; ++k) {
    const double low = std::floor((centre[k] - distance - pool.corner[k]) / kCell);
    const double high = std::floor((centre[k] + distance - pool.corner[k]) / kCell);
    range.low[k] = static_cast<int>(std::clamp(low, 0.0, static_cast<double>(pool.cells[k])));
    range.high[k] = static_cast<int>(std::clamp(high, -1.0, pool.cells[k] - 1.0));
  }
  return range;
}

GraspContact ContactPlaces::At(Finger finger, int place) const {
  GraspContact contact = PoolOf(finger).contact.at(place);
  contact.finger = finger;
  return contact;
}

bool ContactPlaces::Allows(const GraspContact& contact) const {
  return CanTouch(contact.p_OC, contact.nhat_O, world_.tips().radius(contact.finger), slack_,
                  world_.object(), world_.environment(), X_WB_);
}

std::optional<GraspContact> ContactPlaces::Project(Finger finger, const Vector3& p_O) const {
  if (!p_O.allFinite()) return std::nullopt;
  const GraspContact contact = world_.ContactNear(finger, p_O);
  if (Allows(contact)) return contact;
  int nearest = kNone;
  double least = std::numeric_limits<double>::infinity();
  const Pool& pool = PoolOf(finger);
  for (std::size_t i = 0; i < pool.contact.size(); ++i) {
    const double distance = (pool.contact[i].p_OC - p_O).squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    nearest = static_cast<int>(i);
  }
  if (nearest == kNone) return std::nullopt;
  return At(finger, nearest);
}

std::vector<int> ContactPlaces::FindWithin(Finger finger, const Vector3& p_O,
                                           double distance) const {
  const Pool& pool = PoolOf(finger);
  std::vector<int> found;
  if (pool.contact.empty() || !p_O.allFinite()) return found;
  const CellRange range = CellsAround(pool, p_O, distance + world_.tips().radius(finger));
  if (range.empty()) return found;
  for (int i = range.low[0]; i <= range.high[0]; ++i) {
    for (int j = range.low[1]; j <= range.high[1]; ++j) {
      const int row = (i * pool.cells[1] + j) * pool.cells[2];
      for (int c = pool.cell_start[row + range.low[2]];
           c < pool.cell_start[row + range.high[2] + 1]; ++c) {
        const int place = pool.cell_points[c];
        if ((pool.contact[place].p_OC - p_O).norm() <= distance) found.push_back(place);
      }
    }
  }
  return found;
}

int ContactPlaces::DrawAny(Finger finger, Rng& rng) const {
  const Pool& pool = PoolOf(finger);
  if (pool.contact.empty()) return kNone;
  if (rng.Uniform() < 0.5) return static_cast<int>(rng.UniformInt(pool.contact.size()));
  const std::vector<int>& bucket = pool.buckets[rng.UniformInt(pool.buckets.size())];
  return bucket[rng.UniformInt(bucket.size())];
}

int ContactPlaces::DrawNear(Finger finger, const Vector3& centre, double distance, Rng& rng) const {
  const Pool& pool = PoolOf(finger);
  if (pool.contact.empty()) return kNone;
  const CellRange range = CellsAround(pool, centre, distance);
  if (range.empty()) return kNone;
  // Cells of one row along the last axis are contiguous: count, then pick by number.
  const auto row_of = [&](int i, int j) {
    const int row = (i * pool.cells[1] + j) * pool.cells[2];
    return std::pair(pool.cell_start[row + range.low[2]], pool.cell_start[row + range.high[2] + 1]);
  };
  int count = 0;
  for (int i = range.low[0]; i <= range.high[0]; ++i) {
    for (int j = range.low[1]; j <= range.high[1]; ++j) {
      count += row_of(i, j).second - row_of(i, j).first;
    }
  }
  if (count == 0) return kNone;
  for (int attempt = 0; attempt < kPlaceTries; ++attempt) {
    int number = static_cast<int>(rng.UniformInt(count));
    for (int i = range.low[0]; i <= range.high[0] && number >= 0; ++i) {
      for (int j = range.low[1]; j <= range.high[1] && number >= 0; ++j) {
        const auto [begin, end] = row_of(i, j);
        if (number < end - begin) {
          const int found = pool.cell_points[begin + number];
          if ((pool.centre[found] - centre).norm() <= distance) return found;
          number = kNone;
        } else {
          number -= end - begin;
        }
      }
    }
  }
  return kNone;
}

}  // namespace pregrasp
