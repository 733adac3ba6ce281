#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "app/grasp/min_norm_point.h"
#include "app/grasp/wrench.h"

namespace pregrasp::internal {

/// A checked contact with a unit normal, and p already divided by the torque scale.
struct ScaledContact {
  Vector3 p;
  Vector3 n;
};

/// @throws InputError as CalcWrenchStatus.
void ValidateContacts(std::span<const WrenchContact> contacts);

inline ScaledContact MakeScaledContact(const WrenchContact& contact, double torque_scale) {
  return {contact.p / torque_scale, contact.n.normalized()};
}

/// The net wrench of a force at a contact: force, then torque over the torque scale.
inline Vector6 CalcWrenchOf(const ScaledContact& contact, const Vector3& f) {
  Vector6 w;
  w.head<3>() = f;
  w.tail<3>() = contact.p.cross(f);
  return w;
}

/// The transpose of the above: how much a force at the contact counts along y.
inline Vector3 CalcForceDirection(const ScaledContact& contact, const Vector6& y) {
  return y.head<3>() + y.tail<3>().cross(contact.p);
}

/// The force of unit normal component in the cone that is farthest along y; its value in *value.
inline Vector3 CalcConeSupport(const ScaledContact& contact, double mu, const Vector6& y,
                               double* value) {
  const Vector3 a = CalcForceDirection(contact, y);
  const double normal = a.dot(contact.n);
  const Vector3 tangential = a - normal * contact.n;
  const double length = tangential.norm();
  *value = normal + mu * length;
  return length > 0.0 ? Vector3(contact.n + (mu / length) * tangential) : contact.n;
}

/// Nearest admissible force to z: in the cone, normal component between f_min and f_max. With
/// `jacobian`, an element of the projection's generalised Jacobian.
Vector3 ProjectForce(const Vector3& z, const Vector3& n, double mu, double f_min, double f_max,
                     Matrix3* jacobian);

/// The admissible forces of least effort with net wrench -load, to working precision where such
/// forces exist well inside the bounds. Starts from and never ends worse than `forces`.
/// @return the norm of the net wrench left over.
double SolveLeastEffort(const std::vector<ScaledContact>& contacts, const Vector6& load,
                        const WrenchConfig& config, MatrixX3& forces);

}  // namespace pregrasp::internal
