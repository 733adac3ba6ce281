#include "app/grasp/edge_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/core/rng.h"
#include "app/geometry/tessellate.h"
#include "tests/grasp/grasp_scenes.h"

namespace pregrasp {
namespace {

constexpr double kRadius = 0.009;
constexpr double kSlack = 5e-4;

std::vector<EdgePoint> EdgesOf(const Scene& scene) {
  return FindEdgePoints(scene.object().shape, 2e-3, kLeastFan);
}

std::vector<GraspContact> Outer(const Scene& scene) {
  const GraspWorld world(scene, ShadowHand());
  ThreadPool pool(2);
  return FindOuterEdgeContacts(world, EdgesOf(scene), kRadius, kSlack, world.StartPoses(), pool);
}

double LowestSine(const std::vector<GraspContact>& contacts) {
  double lowest = 1.0;
  for (const GraspContact& contact : contacts) lowest = std::min(lowest, contact.nhat_O.z());
  return lowest;
}

TEST(EdgeContactsTest, ASphereAtTheTopEdgeOfASlabGoesDownUntilItTouchesTheTable) {
  for (const double thickness : {0.003, 0.006, 0.0085}) {
    const Scene scene = FlatScene({0.10, 0.05, thickness}, 0.05, -0.1);
    // The centre is at least the radius above the table; the edge at the thickness.
    const double lowest = (kRadius - thickness) / kRadius;
    const double angle = std::asin(lowest);
    const std::vector<GraspContact> outer = Outer(scene);
    EXPECT_LE(LowestSine(outer), lowest + 1e-9);
    EXPECT_GE(LowestSine(outer), std::sin(angle - DegToRad(0.15)));
    const GraspWorld world(scene, ShadowHand());
    const std::vector<GraspContact> inner =
        FindFreeEdgeContacts(world, EdgesOf(scene), kRadius, kSlack, world.StartPoses());
    EXPECT_GE(LowestSine(inner), lowest - 1e-6);
    EXPECT_LE(LowestSine(inner), std::sin(angle + DegToRad(0.05)));
    for (const GraspContact& contact : inner) {
      EXPECT_TRUE(contact.on_edge);
      EXPECT_NEAR(contact.p_OC.z(), 0.5 * thickness, 1e-12);  // never the lower edges
    }
  }
}

TEST(EdgeContactsTest, EveryFreeDirectionLiesInTheConesOfThoseThatStandForIt) {
  // A box before a ball: the free part of the fans has a round border.
  Scene scene = MakeScene("box", Box{{0.04, 0.03, 0.02}}, 0.1, Shift(0, 0, 0.01));
  Body ball;
  ball.name = "ball";
  ball.shape = Sphere{0.01};
  ball.X_WB = Shift(0.036, 0.026, 0.034);
  scene.bodies.push_back(ball);
  const GraspWorld world(scene, ShadowHand());
  const std::vector<RigidTransform> X_WB = world.StartPoses();
  const std::vector<EdgePoint> points = EdgesOf(scene);
  ThreadPool pool(1);
  const std::vector<GraspContact> outer =
      FindOuterEdgeContacts(world, points, kRadius, kSlack, X_WB, pool);
  Rng rng(1, RngStream::kTest);
  int free = 0, blocked = 0;
  for (const EdgePoint& point : points) {
    std::vector<Vector3> standing;
    for (const GraspContact& contact : outer) {
      if (contact.p_OC == point.p_B) standing.push_back(contact.nhat_O);
    }
    for (int k = 0; k < 20; ++k) {
      Vector3 nhat = Vector3::Zero();
      for (const Vector3& face : point.nhats_B) nhat += rng.Uniform() * face;
      nhat.normalize();
      const Vector3 centre = X_WB[0] * Vector3(point.p_B + kRadius * nhat);
      if (world.environment().Calc(centre, X_WB).phi < kRadius) {
        ++blocked;
        continue;
      }
      ++free;
      // What separates the standing directions from y separates this one too, for random y.
      for (int j = 0; j < 20; ++j) {
        const Vector3 y = rng.Direction();
        double least = 1e9;
        for (const Vector3& stand : standing) least = std::min(least, y.dot(stand));
        if (least > 0.0) {
          ASSERT_GE(y.dot(nhat), 0.0);
        }
      }
    }
  }
  EXPECT_GT(free, 1000);
  EXPECT_GT(blocked, 20);
}

TEST(EdgeContactsTest, AnEdgeThatLiesOnAFaceOfAnotherPartIsNone) {
  // Two boxes side by side are one slab: the seam on its top is no edge.
  Union slab;
  slab.parts.push_back({Box{{0.04, 0.04, 0.02}}, Shift(-0.02, 0, 0)});
  slab.parts.push_back({Box{{0.04, 0.04, 0.02}}, Shift(0.02, 0, 0)});
  Scene scene = MakeScene("slab", slab, 0.1, Shift(0, 0, 0.5));
  scene.bodies.push_back(FixedBox("far", {0.1, 0.1, 0.1}, {0, 0, -1}));
  int on_seam = 0;
  for (const GraspContact& contact : Outer(scene)) {
    const bool seam = std::abs(contact.p_OC.x()) < 1e-9 && std::abs(contact.p_OC.y()) < 0.0199;
    if (!seam) continue;
    ++on_seam;
    EXPECT_GT(std::abs(contact.nhat_O.z()), std::cos(DegToRad(3.0)));
  }
  EXPECT_GT(on_seam, 0);
}

// A box whose top is a fan to a point beside the triangle that it stands for: three layers there,
// the middle one upside down, as reconstructed surfaces have them.
TEST(EdgeContactsTest, AFoldedMeshGivesContactsAsAnyOther) {
  Mesh folded;
  folded.file = "folded.obj";
  TriangleMesh& mesh = folded.mesh;
  mesh = Tessellate(Box{{0.08, 0.06, 0.04}});
  const auto rows = mesh.V.rows();
  mesh.V.conservativeResize(rows + 1, 3);
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Eigen::RowVector3i corners = mesh.F.row(f);
    double lowest = 1.0;
    for (const int v : corners) lowest = std::min(lowest, mesh.V(v, 2));
    if (lowest < 0.02) continue;
    mesh.V.row(rows) = Vector3(0.011, 0.013, 0.02);  // beyond the diagonal of one of the two
    const auto sign = [&](const Vector3& a, const Vector3& b) {
      return (b - a).cross(mesh.V.row(rows).transpose() - a).z();
    };
    bool outside = false;
    for (int i = 0; i < 3; ++i) {
      outside |= sign(mesh.V.row(corners[i]), mesh.V.row(corners[(i + 1) % 3])) < 0.0;
    }
    if (!outside) continue;
    const int at = static_cast<int>(rows);
    mesh.F.conservativeResize(mesh.F.rows() + 2, 3);
    mesh.F.row(f) << corners[0], corners[1], at;
    mesh.F.row(mesh.F.rows() - 2) << corners[1], corners[2], at;
    mesh.F.row(mesh.F.rows() - 1) << corners[2], corners[0], at;
    break;
  }
  ASSERT_EQ(mesh.F.rows(), 14);
  Scene scene = MakeScene("folded", Box{{0.08, 0.06, 0.04}}, 0.1, Shift(0, 0, 0.5));
  scene.bodies[0].shape = folded;
  scene.bodies.push_back(FixedBox("far", {0.1, 0.1, 0.1}, {0, 0, -1}));
  int at_corners = 0;
  const auto look = [&](const std::vector<GraspContact>& contacts) {
    for (const GraspContact& contact : contacts) {
      ASSERT_NEAR(contact.nhat_O.norm(), 1.0, 1e-9);
      at_corners += std::abs(contact.p_OC.x()) > 0.0399 && std::abs(contact.p_OC.y()) > 0.0299;
    }
  };
  look(Outer(scene));
  const GraspWorld world(scene, ShadowHand());
  look(FindFreeEdgeContacts(world, EdgesOf(scene), kRadius, kSlack, world.StartPoses()));
  EXPECT_GT(at_corners, 8);
}

TEST(EdgeContactsTest, MoreRoomGivesAWiderFan) {
  const auto lowest = [](double gap) {
    Scene scene = FlatScene({0.10, 0.05, 0.02}, 0.05, -0.1);
    scene.bodies.push_back(FixedBox("beside", {0.3, 0.05, 0.02}, {0, 0.05 + gap, 0.01}));
    double least = 1.0;
    for (const GraspContact& contact : Outer(scene)) {
      const bool upper =
          contact.p_OC.y() > 0.0249 && contact.p_OC.z() > 0.0 && std::abs(contact.p_OC.x()) < 0.03;
      if (upper) least = std::min(least, contact.nhat_O.z());
    }
    return least;
  };
  // Beside a gap the sphere sinks until it touches the neighbour's edge too: half the gap over the
  // radius is the sine of its lean.
  for (const double gap : {0.002, 0.006, 0.012}) {
    EXPECT_NEAR(lowest(gap), std::sqrt(1.0 - std::pow(0.5 * gap / kRadius, 2)), 1e-3) << gap;
  }
}

}  // namespace
}  // namespace pregrasp
