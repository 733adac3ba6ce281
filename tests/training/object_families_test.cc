#include "app/training/object_families.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "app/core/error.h"
#include "app/geometry/mass_properties.h"
#include "app/training/procedural_mesh.h"

namespace pregrasp {
namespace {

void ExpectClosed(const TriangleMesh& mesh, const std::string& name) {
  std::map<std::pair<int, int>, int> edges;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) ++edges[{mesh.F(f, k), mesh.F(f, (k + 1) % 3)}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << name;
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << name;
  }
}

// Corners of the bounding boxes of all parts, in the shape's frame.
void CollectBounds(const Shape& shape, const RigidTransform& X_BP, Vector3& low, Vector3& high) {
  const auto add = [&](const Vector3& p) {
    low = low.cwiseMin(X_BP * p);
    high = high.cwiseMax(X_BP * p);
  };
  const auto add_box = [&](const Vector3& half) {
    for (int i = 0; i < 8; ++i) {
      add(Vector3(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                  i & 4 ? half.z() : -half.z()));
    }
  };
  if (const auto* box = std::get_if<Box>(&shape)) add_box(0.5 * box->size);
  if (const auto* c = std::get_if<Cylinder>(&shape)) add_box({c->radius, c->radius, c->height / 2});
  if (const auto* c = std::get_if<Capsule>(&shape)) {
    add_box({c->radius, c->radius, c->height / 2 + c->radius});
  }
  if (const auto* s = std::get_if<Sphere>(&shape)) add_box(Vector3::Constant(s->radius));
  if (const auto* m = std::get_if<Mesh>(&shape)) {
    ExpectClosed(m->mesh, "mesh");
    EXPECT_GT(CalcVolume(shape), 0.0);
    for (int i = 0; i < m->mesh.V.rows(); ++i) add(Vector3(m->mesh.V.row(i)));
  }
  if (const auto* u = std::get_if<Union>(&shape)) {
    for (const PlacedShape& part : u->parts) CollectBounds(part.shape, X_BP * part.X_BP, low, high);
  }
}

TEST(ObjectFamiliesTest, EveryMemberIsALifeSizeObjectCentredInItsFrame) {
  for (const std::string& family : ObjectFamilies()) {
    for (std::uint32_t i = 0; i < 40; ++i) {
      const TrainingObject object = SampleObject(family, Rng(1, RngStream::kTest, i));
      Vector3 low = Vector3::Constant(1.0), high = Vector3::Constant(-1.0);
      CollectBounds(object.shape, RigidTransform::Identity(), low, high);
      const Vector3 size = high - low;
      EXPECT_GE(size.minCoeff(), 0.002 - 1e-9) << object.name;
      EXPECT_GE(size.maxCoeff(), 0.04) << object.name;
      EXPECT_LE(size.maxCoeff(), 0.50) << object.name;
      EXPECT_LT((low + high).norm(), 0.016) << object.name;
      EXPECT_GE(object.mass, 0.01) << object.name;
      EXPECT_LE(object.mass, 2.5) << object.name;
      EXPECT_EQ(object.family, family);
    }
  }
}

TEST(ObjectFamiliesTest, MembersAreReproducibleAndDiffer) {
  EXPECT_GE(ObjectFamilies().size(), 16U);
  for (const std::string& family : ObjectFamilies()) {
    std::set<std::string> names;
    for (std::uint32_t i = 0; i < 10; ++i) {
      const TrainingObject a = SampleObject(family, Rng(1, RngStream::kTest, i));
      const TrainingObject b = SampleObject(family, Rng(1, RngStream::kTest, i));
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.mass, b.mass);
      names.insert(a.name);
    }
    EXPECT_GE(names.size(), 5U) << family;
  }
  EXPECT_THROW(SampleObject("unicorn", Rng(1)), InputError);
}

TEST(ProceduralMeshTest, ALatheOfAStraightProfileIsAPrism) {
  const int n = 16;
  const double r = 0.03, h = 0.1;
  const TriangleMesh mesh = Lathe({{r, 0.0}, {r, h}}, n);
  ExpectClosed(mesh, "prism");
  EXPECT_NEAR(CalcVolume(MakeMeshShape(mesh)), 0.5 * n * r * r * std::sin(2.0 * kPi / n) * h,
              1e-12);
}

TEST(ProceduralMeshTest, GoingBackDownInsideHollowsAVessel) {
  const int n = 64;
  const double area = 0.5 * n * std::sin(2.0 * kPi / n);
  const TriangleMesh mesh = Lathe({{0.04, 0.0}, {0.04, 0.1}, {0.03, 0.1}, {0.03, 0.02}}, n);
  ExpectClosed(mesh, "vessel");
  EXPECT_NEAR(CalcVolume(MakeMeshShape(mesh)), area * (0.04 * 0.04 * 0.1 - 0.03 * 0.03 * 0.08),
              1e-12);
}

TEST(ProceduralMeshTest, ARoundedRectangleHasItsSize) {
  const Ring ring = RoundedRectangle(0.2, 0.1, 0.02, 0.5);
  double area = 0.0;
  Vector3 high = Vector3::Zero();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector3 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
    high = high.cwiseMax(a);
  }
  EXPECT_NEAR(high.x(), 0.1, 1e-12);
  EXPECT_NEAR(high.y(), 0.05, 1e-12);
  EXPECT_NEAR(area, 0.2 * 0.1 - (4.0 - kPi) * 0.02 * 0.02, 5e-5);  // counter-clockwise, so positive
}

}  // namespace
}  // namespace pregrasp
