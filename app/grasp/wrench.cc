#include "app/grasp/wrench.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "app/core/error.h"
#include "app/core/text.h"
#include "app/grasp/contact_wrenches.h"

namespace pregrasp {
namespace internal {

void ValidateContacts(std::span<const WrenchContact> contacts) {
  if (contacts.empty()) throw InputError("wrench", "p", "at least one contact", "none");
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const WrenchContact& contact = contacts[i];
    if (!contact.p.allFinite()) {
      throw InputError("wrench", fmt::format("p[{}]", i + 1), "three finite numbers", "nan or inf");
    }
    const double length = contact.n.norm();
    if (!(std::isfinite(length) && length > 1e-9)) {
      throw InputError("wrench", fmt::format("n[{}]", i + 1), "a direction",
                       "no finite length above 0");
    }
  }
}

}  // namespace internal

namespace {

using internal::ScaledContact;

// What counts as zero, for a set whose forces are at most `cap` and that has `carried` to balance
// [N]: far below both, and above rounding.
double ZeroDistance(double cap, double carried) {
  return std::max(1e-14 * cap, std::min(1e-10 * cap, 1e-6 * carried));
}

// The same where iterations stall because the origin lies on the set's curved boundary.
double StalledZeroDistance(double cap, double carried) {
  return std::min(1e-7 * cap, 1e-4 * carried);
}

// Force caps to try before f_max, as multiples of what has to be carried: a cap far beyond need
// costs digits.
constexpr std::array kCaps{1e2, 1e4, std::numeric_limits<double>::infinity()};

// The net wrenches of all admissible forces and one fixed load, by their support function.
// `forces`, when given, keeps the forces behind each slot's point: slot by slot, contact by
// contact.
struct AdmissibleWrenches {
  std::span<const ScaledContact> contacts;
  const WrenchConfig& config;
  Vector6 load = Vector6::Zero();
  std::vector<Vector3>* forces = nullptr;
  double cap = 0.0;          // in place of f_max
  bool cap_matters = false;  // in the latest direction

  Vector6 Start() const {
    Vector6 point = load;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Vector3 f = config.f_min * contacts[i].n;
      point += CalcWrenchOf(contacts[i], f);
      if (forces) (*forces)[i] = f;
    }
    return point;
  }

  void operator()(const Vector6& direction, int slot, Vector6& point) {
    point = load;
    cap_matters = false;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      double value = 0.0;
      const Vector3 unit = CalcConeSupport(contacts[i], config.mu, direction, &value);
      cap_matters = cap_matters || value > 0.0;
      const Vector3 f = (value > 0.0 ? cap : config.f_min) * unit;
      point += CalcWrenchOf(contacts[i], f);
      if (forces) (*forces)[slot * contacts.size() + i] = f;
    }
  }
};

// Eight contacts fit on the stack: more than a hand has.
class ScaledContacts {
 public:
  ScaledContacts(std::span<const WrenchContact> contacts, double torque_scale) {
    internal::ValidateContacts(contacts);
    ScaledContact* out = few_.data();
    if (contacts.size() > few_.size()) {
      many_.resize(contacts.size());
      out = many_.data();
    }
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      out[i] = internal::MakeScaledContact(contacts[i], torque_scale);
    }
    span_ = {out, contacts.size()};
  }
  ScaledContacts(const ScaledContacts&) = delete;
  ScaledContacts& operator=(const ScaledContacts&) = delete;

  std::span<const ScaledContact> span() const { return span_; }

 private:
  std::array<ScaledContact, 8> few_;
  std::vector<ScaledContact> many_;
  std::span<const ScaledContact> span_;
};

Vector6 WeightLoad(const WrenchConfig& config) {
  Vector6 load = Vector6::Zero();
  load.head<3>() = config.mass * config.gravity;
  return load;
}

// Whether the set holds the origin; `point` says how.
bool FindBalance(AdmissibleWrenches& wrenches, MinNormPoint& point) {
  using Status = MinNormPoint::Status;
  const WrenchConfig& config = wrenches.config;
  const double carried = std::max(config.f_min, wrenches.load.norm());
  for (const double multiple : kCaps) {
    wrenches.cap = carried > 0.0 ? std::min(config.f_max, multiple * carried) : config.f_max;
    MinNormConfig solver;
    solver.tolerance = ZeroDistance(wrenches.cap, carried);
    solver.separation = std::max(1e-15 * wrenches.cap, 1e-2 * solver.tolerance);
    point = FindMinNormPoint(wrenches.Start(), wrenches, solver);
    if (point.status == Status::kContainsOrigin) return true;
    if (point.status == Status::kStalled &&
        point.v.norm() <= StalledZeroDistance(wrenches.cap, carried)) {
      return true;
    }
    if (!wrenches.cap_matters || wrenches.cap == config.f_max) return false;
  }
  return false;
}

void RequireFinite(const char* field, double value, double low, const char* expected) {
  if (!(std::isfinite(value) && value >= low)) {
    throw InputError("wrench", field, expected, FormatDouble(value));
  }
}

}  // namespace

void WrenchConfig::Validate() const {
  RequireFinite("mu", mu, 0.0, "a coefficient of at least 0");
  RequireFinite("mass", mass, 0.0, "a mass of at least 0 kg");
  RequireFinite("f_min", f_min, 0.0, "a force of at least 0 N");
  RequireFinite("f_max", f_max, f_min, "a finite force of at least f_min");
  if (!(f_max > 0.0)) throw InputError("wrench", "f_max", "a force above 0 N", FormatDouble(f_max));
  if (!(std::isfinite(torque_scale) && torque_scale > 0.0)) {
    throw InputError("wrench", "torque_scale", "a length above 0 m", FormatDouble(torque_scale));
  }
  if (!gravity.allFinite()) {
    throw InputError("wrench", "gravity", "three finite numbers", "nan or inf");
  }
}

const char* WrenchStatusName(WrenchStatus status) {
  switch (status) {
    case WrenchStatus::kFeasible:
      return "feasible";
    case WrenchStatus::kNoInternalForces:
      return "no internal forces";
    case WrenchStatus::kWeightNotBalanced:
      return "weight not balanced";
  }
  return "?";
}

WrenchStatus CalcWrenchStatus(std::span<const WrenchContact> contacts, const WrenchConfig& config,
                              Vector6* missing) {
  config.Validate();
  const ScaledContacts scaled(contacts, config.torque_scale);
  AdmissibleWrenches wrenches{scaled.span(), config};
  MinNormPoint point;
  WrenchStatus status = WrenchStatus::kNoInternalForces;
  if (FindBalance(wrenches, point)) {
    wrenches.load = WeightLoad(config);
    if (wrenches.load.isZero(0.0) || FindBalance(wrenches, point)) return WrenchStatus::kFeasible;
    status = WrenchStatus::kWeightNotBalanced;
  }
  *missing = -point.v.normalized();
  return status;
}

WrenchStatus CalcWrenchStatus(std::span<const WrenchContact> contacts, const WrenchConfig& config) {
  Vector6 missing;
  return CalcWrenchStatus(contacts, config, &missing);
}

WrenchResult CalcWrench(std::span<const WrenchContact> contacts, const WrenchConfig& config) {
  config.Validate();
  const ScaledContacts scaled(contacts, config.torque_scale);
  const std::size_t count = contacts.size();
  std::vector<Vector3> slot_forces(8 * count);
  AdmissibleWrenches wrenches{scaled.span(), config};
  wrenches.forces = &slot_forces;

  WrenchResult result;
  MinNormPoint point;
  result.status = WrenchStatus::kNoInternalForces;
  if (FindBalance(wrenches, point)) {
    wrenches.load = WeightLoad(config);
    result.status =
        FindBalance(wrenches, point) ? WrenchStatus::kFeasible : WrenchStatus::kWeightNotBalanced;
  }

  result.forces = MatrixX3::Zero(static_cast<int>(count), 3);
  for (int k = 0; k < point.size; ++k) {
    for (std::size_t i = 0; i < count; ++i) {
      result.forces.row(static_cast<int>(i)) +=
          point.weight[k] * slot_forces[point.slot[k] * count + i].transpose();
    }
  }
  result.residual = point.v.norm();
  if (result.feasible()) {
    result.residual = internal::SolveLeastEffort({scaled.span().begin(), scaled.span().end()},
                                                 wrenches.load, config, result.forces);
  } else {
    result.separating = point.v / result.residual;
  }
  result.min_normal = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const double normal = result.forces.row(static_cast<int>(i)).dot(scaled.span()[i].n);
    result.min_normal = std::min(result.min_normal, normal);
  }
  result.margin = CalcMargin(contacts, config.mu, config.torque_scale);
  result.closed = result.margin > 0.0;
  return result;
}

std::vector<WrenchContact> MakeWrenchContacts(const MatrixX3& P, const MatrixX3& N) {
  if (P.rows() != N.rows()) {
    throw InputError("wrench", "n", fmt::format("as many normals as points ({})", P.rows()),
                     std::to_string(N.rows()));
  }
  std::vector<WrenchContact> contacts(P.rows());
  for (int i = 0; i < P.rows(); ++i) contacts[i] = {P.row(i), N.row(i)};
  internal::ValidateContacts(contacts);
  return contacts;
}

}  // namespace pregrasp
