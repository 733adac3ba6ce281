#include "app/hand/loft.h"

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

constexpr int kSegments = 32;  // around a section
constexpr int kFillet = 5;     // rings of a rounded end
constexpr int kBetween = 4;    // rings from one given section to the next

// Rings of equal size, counter-clockwise about the direction in which they follow each other,
// joined and closed by fans. In millimetres; the mesh is in metres.
TriangleMesh JoinRings(const std::vector<std::vector<Vector3>>& rings) {
  const int count = static_cast<int>(rings.size());
  const int size = static_cast<int>(rings[0].size());
  TriangleMesh mesh;
  mesh.V.resize(count * size + 2, 3);
  mesh.F.resize(2 * count * size, 3);
  for (int r = 0; r < count; ++r) {
    for (int s = 0; s < size; ++s) mesh.V.row(r * size + s) = 1e-3 * rings[r][s];
  }
  const int low = count * size;
  const int high = low + 1;
  mesh.V.row(low) = mesh.V.topRows(size).colwise().mean();
  mesh.V.row(high) = mesh.V.middleRows((count - 1) * size, size).colwise().mean();
  int f = 0;
  for (int s = 0; s < size; ++s) {
    const int next = (s + 1) % size;
    mesh.F.row(f++) << low, next, s;
    for (int r = 0; r + 1 < count; ++r) {
      const int a = r * size + s;
      const int b = r * size + next;
      mesh.F.row(f++) << a, b, b + size;
      mesh.F.row(f++) << a, b + size, a + size;
    }
    mesh.F.row(f++) << high, (count - 1) * size + s, (count - 1) * size + next;
  }
  return mesh;
}

constexpr double kPoint = 0.02;  // half width of a pointed end [mm]: no triangle without area

std::vector<Vector3> Ring(const Section& section, double inset) {
  const double rx = std::max(kPoint, section.rx - inset);
  const double ry = std::max(kPoint, section.ry - inset);
  std::vector<Vector3> ring;
  for (int s = 0; s < kSegments; ++s) {
    const double angle = 2.0 * kPi * (s + 0.5) / kSegments;
    double x = std::cos(angle);
    double y = std::sin(angle);
    if (section.n == 0.0) {
      x = std::copysign(std::max(0.0, rx - ry), x) + ry * x;
      y = ry * y;
    } else {
      x = rx * std::copysign(std::pow(std::abs(x), 2.0 / section.n), x);
      y = ry * std::copysign(std::pow(std::abs(y), 2.0 / section.n), y);
    }
    ring.emplace_back(section.x + x, section.y + y, section.z);
  }
  return ring;
}

// Between b and c of four sections (Catmull and Rom 1974).
Section InterpolateSection(const Section& a, const Section& b, const Section& c, const Section& d,
                           double t) {
  const auto spline = [&](double Section::*field) {
    const double va = a.*field;
    const double vb = b.*field;
    const double vc = c.*field;
    const double vd = d.*field;
    return vb + 0.5 * t *
                    (vc - va +
                     t * (2.0 * va - 5.0 * vb + 4.0 * vc - vd + t * (3.0 * (vb - vc) + vd - va)));
  };
  // z evenly, so that rings never turn back.
  return {b.z + t * (c.z - b.z), spline(&Section::x),  spline(&Section::y),
          spline(&Section::rx),  spline(&Section::ry), spline(&Section::n)};
}

// A profile of (x, radius) turned about the x axis. [mm]
TriangleMesh Turn(const std::vector<Vector2>& profile) {
  std::vector<std::vector<Vector3>> rings;
  for (const Vector2& point : profile) {
    std::vector<Vector3> ring;
    for (int s = 0; s < kSegments; ++s) {
      const double angle = 2.0 * kPi * s / kSegments;
      ring.emplace_back(point.x(), point.y() * std::cos(angle), point.y() * std::sin(angle));
    }
    rings.push_back(std::move(ring));
  }
  return JoinRings(rings);
}

// A flat ear in the y-z plane between x0 and x1: a disc about the joint at z with a neck to z_foot,
// which may lie on either side. [mm]
TriangleMesh Ear(double x0, double x1, double z, double radius, double z_foot) {
  constexpr double kBevel = 0.5;
  const double up = z_foot < z ? 1.0 : -1.0;
  const auto outline = [&](double x, double inset) {
    std::vector<Vector3> ring;
    const double r = radius - inset;
    constexpr int kHalf = kSegments / 2;
    for (int s = 0; s <= kHalf; ++s) {
      const double a = kPi * s / kHalf;
      ring.emplace_back(x, up * r * std::cos(a), z + up * r * std::sin(a));
    }
    ring.emplace_back(x, -up * r, z_foot);
    ring.emplace_back(x, up * r, z_foot);
    return ring;
  };
  return JoinRings({outline(x0, kBevel), outline(x0 + kBevel, 0.0), outline(x1 - kBevel, 0.0),
                    outline(x1, kBevel)});
}

}  // namespace

TriangleMesh Loft(const std::vector<Section>& sections, double low, double high) {
  std::vector<std::vector<Vector3>> rings;
  const auto end_ring = [&](Section section, double radius, int step, double up) {
    const double angle = 0.5 * kPi * step / kFillet;  // 0 at the tip, 90 degrees at full width
    section.z += up * radius * (1.0 - std::cos(angle));
    // The section shrinks towards the tip like a quarter circle.
    rings.push_back(Ring(section, radius * (1.0 - std::sin(angle))));
  };
  // The circle's steep part is at the tip: z grows with 1 - cos, width with sin.
  for (int i = 0; i < kFillet; ++i) end_ring(sections.front(), low, i, 1.0);
  const int count = static_cast<int>(sections.size());
  for (int i = 0; i + 1 < count; ++i) {
    const Section& before = sections[std::max(0, i - 1)];
    const Section& after = sections[std::min(count - 1, i + 2)];
    Section from = sections[i];
    Section to = sections[i + 1];
    if (i == 0) from.z += low;
    if (i + 2 == count) to.z -= high;
    for (int k = 0; k < kBetween; ++k) {
      rings.push_back(Ring(
          InterpolateSection(before, from, to, after, static_cast<double>(k) / kBetween), 0.0));
    }
  }
  for (int i = kFillet; i >= 0; --i) end_ring(sections.back(), high, i, -1.0);
  return JoinRings(rings);
}

TriangleMesh Drum(double half, double radius, double rim) {
  std::vector<Vector2> profile;
  for (int i = 0; i <= kFillet; ++i) {
    const double a = 0.5 * kPi * i / kFillet;
    profile.emplace_back(-half + rim * (1.0 - std::cos(a)), radius - rim * (1.0 - std::sin(a)));
  }
  for (int i = kFillet; i >= 0; --i) {
    const double a = 0.5 * kPi * i / kFillet;
    profile.emplace_back(half - rim * (1.0 - std::cos(a)), radius - rim * (1.0 - std::sin(a)));
  }
  return Turn(profile);
}

TriangleMesh Ball(double radius) {
  std::vector<Vector2> profile;
  constexpr int kRings = 16;
  for (int i = 1; i < kRings; ++i) {
    const double a = kPi * i / kRings;
    profile.emplace_back(-radius * std::cos(a), radius * std::sin(a));
  }
  return Turn(profile);
}

TriangleMesh Fork(double inner, double outer, double z, double radius, double z_foot) {
  return Merge({Ear(-outer, -inner, z, radius, z_foot), Ear(inner, outer, z, radius, z_foot)});
}

TriangleMesh Merge(const std::vector<TriangleMesh>& parts) {
  Eigen::Index vertices = 0;
  Eigen::Index faces = 0;
  for (const TriangleMesh& part : parts) {
    vertices += part.V.rows();
    faces += part.F.rows();
  }
  TriangleMesh whole;
  whole.V.resize(vertices, 3);
  whole.F.resize(faces, 3);
  vertices = faces = 0;
  for (const TriangleMesh& part : parts) {
    whole.V.middleRows(vertices, part.V.rows()) = part.V;
    whole.F.middleRows(faces, part.F.rows()) = part.F.array() + static_cast<int>(vertices);
    vertices += part.V.rows();
    faces += part.F.rows();
  }
  return whole;
}

TriangleMesh Placed(TriangleMesh mesh, const RigidTransform& X) {
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    mesh.V.row(i) = X * Vector3(mesh.V.row(i).transpose());
  }
  return mesh;
}

}  // namespace pregrasp
