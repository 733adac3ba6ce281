#include "app/grasp/contact_sampler.h"

#include <algorithm>
#include <cmath>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr double kCell = 0.02;  // [m]
constexpr int kTries = 8;       // draws of one contact before the set is given up
constexpr int kNone = -1;

// A direction's octant, face or edge of a cube: 26 buckets, so that a thin side counts like a wide
// one.
int BucketOf(const Vector3& nhat) {
  int bucket = 0;
  for (int i = 0; i < 3; ++i) {
    bucket = 3 * bucket + (nhat[i] < -0.38 ? 0 : nhat[i] > 0.38 ? 2 : 1);
  }
  return bucket;
}

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
  RequireLength("min_tip_distance", min_tip_distance);
  RequireShare("near_share", near_share);
  RequireShare("opposed_share", opposed_share);
}

ContactSampler::ContactSampler(const GraspWorld& world, const std::vector<RigidTransform>& X_WB,
                               const SamplerConfig& config)
    : world_(world), X_WB_(X_WB), config_(config) {
  config_.Validate();
  pools_ = {MakePool(FingertipRadius(Finger::kThumb)), MakePool(FingertipRadius(Finger::kIndex))};
}

ContactSampler::Pool ContactSampler::MakePool(double radius) const {
  Pool pool;
  pool.radius = radius;
  const SurfacePoints& surface = world_.surface();
  std::vector<std::vector<int>> buckets(27);
  Eigen::AlignedBox3d box;
  for (int i = 0; i < surface.P.rows(); ++i) {
    const Vector3 p = surface.P.row(i);
    const Vector3 nhat = surface.N.row(i);
    if (!CanTouch(p, nhat, radius, config_.slack, world_.object(), world_.environment(), X_WB_)) {
      continue;
    }
    buckets[BucketOf(nhat)].push_back(static_cast<int>(pool.point.size()));
    pool.point.push_back(i);
    pool.centre.emplace_back(p + radius * nhat);
    box.extend(pool.centre.back());
  }
  for (std::vector<int>& bucket : buckets) {
    if (!bucket.empty()) pool.buckets.push_back(std::move(bucket));
  }
  if (pool.point.empty()) return pool;

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
  return pool;
}

// Half of the draws by area, half by direction.
int ContactSampler::DrawAny(const Pool& pool, Rng& rng) const {
  if (pool.point.empty()) return kNone;
  if (rng.Uniform() < 0.5) return static_cast<int>(rng.UniformInt(pool.point.size()));
  const std::vector<int>& bucket = pool.buckets[rng.UniformInt(pool.buckets.size())];
  return bucket[rng.UniformInt(bucket.size())];
}

int ContactSampler::DrawNear(const Pool& pool, const Vector3& centre, double distance,
                             Rng& rng) const {
  if (pool.point.empty()) return kNone;
  std::array<int, 3> low{}, high{};
  for (int k = 0; k < 3; ++k) {
    low[k] = static_cast<int>(std::floor((centre[k] - distance - pool.corner[k]) / kCell));
    high[k] = static_cast<int>(std::floor((centre[k] + distance - pool.corner[k]) / kCell));
    low[k] = std::max(low[k], 0);
    high[k] = std::min(high[k], pool.cells[k] - 1);
  }
  // Cells of one row along the last axis are contiguous: count, then pick by number.
  const auto row_of = [&](int i, int j) {
    const int row = (i * pool.cells[1] + j) * pool.cells[2];
    return std::pair(pool.cell_start[row + low[2]], pool.cell_start[row + high[2] + 1]);
  };
  if (low[2] > high[2]) return kNone;
  int count = 0;
  for (int i = low[0]; i <= high[0]; ++i) {
    for (int j = low[1]; j <= high[1]; ++j) count += row_of(i, j).second - row_of(i, j).first;
  }
  if (count == 0) return kNone;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    int number = static_cast<int>(rng.UniformInt(count));
    for (int i = low[0]; i <= high[0] && number >= 0; ++i) {
      for (int j = low[1]; j <= high[1] && number >= 0; ++j) {
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
  const GraspContact contact = world_.ContactNear(finger, from.p_OC + t * along);
  if (!CanTouch(contact.p_OC, contact.nhat_O, FingertipRadius(finger), config_.slack,
                world_.object(), world_.environment(), X_WB_)) {
    return std::nullopt;
  }
  return contact;
}

bool ContactSampler::Fits(const GraspContact& contact, const std::vector<GraspContact>& placed,
                          const Draw& draw) const {
  const int f = static_cast<int>(contact.finger);
  const Vector3 centre = TipCentre(contact);
  for (const GraspContact& other : placed) {
    const int g = static_cast<int>(other.finger);
    const double distance = (TipCentre(other) - centre).norm();
    double farthest = world_.reach().farthest[f][g];
    if (draw.near && !IsThumb(contact.finger) && !IsThumb(other.finger)) {
      farthest = std::min(farthest, config_.near_spacing * std::abs(f - g) + config_.near_offset);
    }
    const double nearest = std::max(world_.reach().nearest[f][g], config_.min_tip_distance);
    if (distance < nearest || distance > farthest) return false;
  }
  return true;
}

std::optional<GraspContact> ContactSampler::DrawContact(Finger finger,
                                                        const std::vector<GraspContact>& placed,
                                                        const Draw& draw, Rng& rng) const {
  const Pool& pool = PoolOf(finger);
  // Those on the other side of the hand: the thumb for a finger, the fingers for the thumb.
  std::vector<const GraspContact*> across, beside;
  for (const GraspContact& other : placed) {
    (IsThumb(other.finger) != IsThumb(finger) ? across : beside).push_back(&other);
  }
  for (int attempt = 0; attempt < kTries; ++attempt) {
    std::optional<GraspContact> contact;
    if (draw.opposed && !across.empty() && beside.empty()) {
      contact = DrawOpposite(*across[rng.UniformInt(across.size())], finger, rng);
    } else {
      int index = kNone;
      if (draw.near && !beside.empty()) {
        const GraspContact& other = *beside[rng.UniformInt(beside.size())];
        const int apart = std::abs(static_cast<int>(finger) - static_cast<int>(other.finger));
        index = DrawNear(pool, TipCentre(other), config_.near_spacing * apart + config_.near_offset,
                         rng);
      } else {
        index = DrawAny(pool, rng);
      }
      if (index != kNone) {
        const int point = pool.point[index];
        contact =
            GraspContact{finger, world_.surface().P.row(point), world_.surface().N.row(point)};
      }
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
  const std::uint32_t extra = rng.UniformInt(4);  // with ring, with little
  std::vector<Finger> fingers{Finger::kMiddle, Finger::kIndex};
  if (extra & 1) fingers.push_back(Finger::kRing);
  if (extra & 2) fingers.push_back(Finger::kLittle);
  fingers.push_back(Finger::kThumb);

  std::vector<GraspContact> contacts = fixed;
  for (const Finger finger : fingers) {
    const bool given = std::any_of(fixed.begin(), fixed.end(), [&](const GraspContact& contact) {
      return contact.finger == finger;
    });
    if (given) continue;
    const std::optional<GraspContact> contact = DrawContact(finger, contacts, draw, rng);
    if (!contact) return std::nullopt;
    contacts.push_back(*contact);
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const GraspContact& a, const GraspContact& b) { return a.finger < b.finger; });
  return contacts;
}

}  // namespace pregrasp
