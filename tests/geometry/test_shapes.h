#pragma once

// Shapes of the tests, made by formula.

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/core/rng.h"
#include "app/geometry/mesh_topology.h"
#include "app/geometry/tessellate.h"
#include "app/scene/shape.h"

namespace pregrasp::testing {

inline Shape MakeMesh(TriangleMesh mesh) {
  Mesh shape;
  shape.file = "test";
  shape.mesh = std::move(mesh);
  return shape;
}

inline RigidTransform At(double x, double y, double z) {
  return MakeTransform(Matrix3::Identity(), Vector3(x, y, z));
}

/// A surface of revolution about z; `profile` runs (r, z) from the axis to the axis, counter-
/// clockwise seen with r to the right and z up: outward at the bottom first.
inline TriangleMesh Revolve(const std::vector<Vector2>& profile, int segments) {
  const int rings = static_cast<int>(profile.size()) - 2;
  TriangleMesh mesh;
  mesh.V.resize(rings * segments + 2, 3);
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const double angle = 2.0 * kPi * s / segments;
      const Vector2& p = profile[r + 1];
      mesh.V.row(r * segments + s) << p.x() * std::cos(angle), p.x() * std::sin(angle), p.y();
    }
  }
  const int bottom = rings * segments, top = bottom + 1;
  mesh.V.row(bottom) << 0, 0, profile.front().y();
  mesh.V.row(top) << 0, 0, profile.back().y();
  mesh.F.resize(2 * segments * rings, 3);
  int f = 0;
  for (int s = 0; s < segments; ++s) {
    const int t = (s + 1) % segments;
    mesh.F.row(f++) << bottom, t, s;
    for (int r = 0; r + 1 < rings; ++r) {
      const int a = r * segments, b = (r + 1) * segments;
      mesh.F.row(f++) << a + s, a + t, b + t;
      mesh.F.row(f++) << a + s, b + t, b + s;
    }
    const int last = (rings - 1) * segments;
    mesh.F.row(f++) << top, last + s, last + t;
  }
  return mesh;
}

/// A bowl of outer radius `radius`, half a ball in shape, with walls `wall` thick.
inline TriangleMesh MakeBowl(double radius, double wall, int rings, int segments) {
  std::vector<Vector2> profile;
  for (int i = 0; i <= rings; ++i) {
    const double angle = 0.5 * kPi * i / rings;
    profile.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
  }
  for (int i = rings; i >= 0; --i) {
    const double angle = 0.5 * kPi * i / rings;
    profile.emplace_back((radius - wall) * std::sin(angle), -(radius - wall) * std::cos(angle));
  }
  return Revolve(profile, segments);
}

/// A straight cup: outer radius, height, wall and floor thickness; centred on its base.
inline TriangleMesh MakeCup(double radius, double height, double wall, int segments) {
  return Revolve({{0, 0},
                  {radius, 0},
                  {radius, height},
                  {radius - wall, height},
                  {radius - wall, wall},
                  {0, wall}},
                 segments);
}

/// A dinner plate with raised rim and foot ring (units of the scenes: R 130 mm, foot 75 mm).
inline TriangleMesh MakePlate(int segments) {
  return Revolve({{0, 0.004},
                  {0.068, 0.004},
                  {0.068, 0},
                  {0.075, 0},
                  {0.075, 0.004},
                  {0.085, 0.008},
                  {0.130, 0.018},
                  {0.130, 0.025},
                  {0.082, 0.015},
                  {0.070, 0.012},
                  {0, 0.012}},
                 segments);
}

/// A torus about z.
inline TriangleMesh MakeTorus(double major, double minor, int around, int across) {
  TriangleMesh mesh;
  mesh.V.resize(around * across, 3);
  mesh.F.resize(2 * around * across, 3);
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2.0 * kPi * i / around, v = 2.0 * kPi * j / across;
      const double r = major + minor * std::cos(v);
      mesh.V.row(i * across + j) << r * std::cos(u), r * std::sin(u), minor * std::sin(v);
      const int i1 = (i + 1) % around, j1 = (j + 1) % across;
      mesh.F.row(2 * (i * across + j)) << i * across + j, i1 * across + j, i1 * across + j1;
      mesh.F.row(2 * (i * across + j) + 1) << i * across + j, i1 * across + j1, i * across + j1;
    }
  }
  return mesh;
}

/// A polygon (counter-clockwise, in x and y; star-shaped about its first corner is not needed:
/// `triangles` are its triangulation) extruded in z from -height / 2 to height / 2.
inline TriangleMesh Extrude(const std::vector<Vector2>& polygon,
                            const std::vector<Eigen::Vector3i>& triangles, double height) {
  const int n = static_cast<int>(polygon.size());
  TriangleMesh mesh;
  mesh.V.resize(2 * n, 3);
  for (int i = 0; i < n; ++i) {
    mesh.V.row(i) << polygon[i].x(), polygon[i].y(), -0.5 * height;
    mesh.V.row(n + i) << polygon[i].x(), polygon[i].y(), 0.5 * height;
  }
  mesh.F.resize(2 * static_cast<int>(triangles.size()) + 2 * n, 3);
  int f = 0;
  for (const Eigen::Vector3i& t : triangles) {
    mesh.F.row(f++) << t[0], t[2], t[1];
    mesh.F.row(f++) << n + t[0], n + t[1], n + t[2];
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    mesh.F.row(f++) << i, j, n + j;
    mesh.F.row(f++) << i, n + j, n + i;
  }
  return mesh;
}

/// A "C" of a square 2a with a slot of width a open to +x, `height` thick.
inline TriangleMesh MakeC(double a, double height) {
  const std::vector<Vector2> polygon{{-a, -a},        {a, -a},    {a, -a / 2}, {-a / 2, -a / 2},
                                     {-a / 2, a / 2}, {a, a / 2}, {a, a},      {-a, a}};
  return Extrude(polygon, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 7}, {4, 5, 6}, {4, 6, 7}},
                 height);
}

/// |x/a|^e + |y/b|^e + |z/c|^e = 1 as points, evenly spread in direction.
inline MatrixX3 SuperellipsoidPoints(const Vector3& half, double exponent, int count) {
  MatrixX3 P(count, 3);
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double angle = i * kPi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const Vector3 d(r * std::cos(angle), r * std::sin(angle), z);
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) sum += std::pow(std::abs(d[k]), exponent);
    P.row(i) = (d * std::pow(sum, -1.0 / exponent)).cwiseProduct(half).transpose();
  }
  return P;
}

/// Each triangle split in four, `times` times.
inline TriangleMesh Subdivide(TriangleMesh mesh, int times) {
  for (; times > 0; --times) {
    TriangleMesh fine;
    fine.V.resize(6 * mesh.F.rows(), 3);
    fine.F.resize(4 * mesh.F.rows(), 3);
    for (int f = 0; f < mesh.F.rows(); ++f) {
      for (int i = 0; i < 3; ++i) {
        fine.V.row(6 * f + i) = mesh.V.row(mesh.F(f, i));
        fine.V.row(6 * f + 3 + i) =
            0.5 * (mesh.V.row(mesh.F(f, i)) + mesh.V.row(mesh.F(f, (i + 1) % 3)));
      }
      const int v = 6 * f;
      fine.F.row(4 * f) << v, v + 3, v + 5;
      fine.F.row(4 * f + 1) << v + 3, v + 1, v + 4;
      fine.F.row(4 * f + 2) << v + 5, v + 4, v + 2;
      fine.F.row(4 * f + 3) << v + 3, v + 4, v + 5;
    }
    mesh = WeldVertices(fine, 0.0);
  }
  return mesh;
}

/// One loaded shape of every kind, with its name for messages.
struct NamedShape {
  std::string name;
  Shape shape;
};

inline std::vector<NamedShape> ShapesOfEveryKind() {
  const Box box{Vector3(0.06, 0.04, 0.02)};
  Union whole;
  whole.parts.push_back({Cylinder{0.03, 0.01}, At(0, 0, 0.005)});
  whole.parts.push_back({box, MakeTransform(RotationFromRpy({0.3, -0.2, 0.7}), {0.05, 0, 0.01})});
  whole.parts.push_back({MakeMesh(MakeTorus(0.03, 0.01, 24, 12)), At(-0.06, 0, 0.01)});
  Cloud cloud;
  cloud.mesh = Tessellate(Capsule{0.02, 0.05}, 24);
  cloud.points = cloud.mesh.V;
  return {{"box", box},
          {"cylinder", Cylinder{0.03, 0.05}},
          {"capsule", Capsule{0.02, 0.06}},
          {"sphere", Sphere{0.035}},
          {"mesh", MakeMesh(MakeTorus(0.04, 0.015, 32, 16))},
          {"cloud", cloud},
          {"union", whole}};
}

}  // namespace pregrasp::testing
