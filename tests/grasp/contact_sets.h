#pragma once

#include <vector>

#include "app/core/rng.h"
#include "app/grasp/wrench.h"

namespace pregrasp {

/// A random contact set of 2 to 6 contacts: on a box, a sphere, a cylinder (side and caps), or with
/// points and normals that have nothing to do with each other.
inline std::vector<WrenchContact> SampleContactSet(Rng& rng) {
  const int count = 2 + static_cast<int>(rng.UniformInt(5));
  const int kind = static_cast<int>(rng.UniformInt(4));
  const Vector3 half(rng.Uniform(0.01, 0.15), rng.Uniform(0.01, 0.15), rng.Uniform(0.002, 0.1));
  std::vector<WrenchContact> contacts;
  for (int i = 0; i < count; ++i) {
    WrenchContact contact;
    if (kind == 0) {
      const int axis = static_cast<int>(rng.UniformInt(3));
      const double side = rng.Uniform() < 0.5 ? -1.0 : 1.0;
      for (int k = 0; k < 3; ++k) contact.p[k] = rng.Uniform(-half[k], half[k]);
      contact.p[axis] = side * half[axis];
      contact.n = -side * Vector3::Unit(axis);
    } else if (kind == 1) {
      contact.n = -rng.Direction();
      contact.p = -half.x() * contact.n;
    } else if (kind == 2) {
      const double angle = rng.Uniform(0.0, 2.0 * kPi);
      const Vector3 radial(std::cos(angle), std::sin(angle), 0.0);
      if (rng.Uniform() < 0.3) {
        const double side = rng.Uniform() < 0.5 ? -1.0 : 1.0;
        contact.p = half.x() * std::sqrt(rng.Uniform()) * radial;
        contact.p.z() = side * half.z();
        contact.n = Vector3(0.0, 0.0, -side);
      } else {
        contact.p = half.x() * radial;
        contact.p.z() = rng.Uniform(-half.z(), half.z());
        contact.n = -radial;
      }
    } else {
      for (int k = 0; k < 3; ++k) contact.p[k] = rng.Uniform(-half[k], half[k]);
      contact.n = rng.Direction();
    }
    contacts.push_back(contact);
  }
  return contacts;
}

/// Random physical conditions for a contact set.
inline WrenchConfig SampleWrenchConfig(Rng& rng) {
  WrenchConfig config;
  config.mu = rng.Uniform(0.2, 1.2);
  config.mass = rng.Uniform(0.01, 1.0);
  config.gravity = 9.81 * rng.Direction();
  config.f_min = rng.Uniform(0.0, 1.0);
  config.f_max = rng.Uniform(5.0, 15.0);
  config.torque_scale = rng.Uniform(0.05, 0.2);
  return config;
}

}  // namespace pregrasp
