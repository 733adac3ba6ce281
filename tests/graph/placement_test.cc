#include "app/graph/placement.h"

#include <gtest/gtest.h>

#include "tests/graph/graph_fixture.h"

namespace pregrasp {
namespace {

// Two blocks with a gap along y between them, on a plate.
SignedDistance MakeGroove(double gap) {
  Union shape;
  const auto add = [&](const Vector3& size, const Vector3& p) {
    RigidTransform X = RigidTransform::Identity();
    X.translation() = p;
    shape.parts.push_back({Box{size}, X});
  };
  add(Vector3(0.10, 0.06, 0.01), Vector3(0.0, 0.0, -0.005));
  for (const double side : {-1.0, 1.0}) {
    add(Vector3(0.03, 0.06, 0.04), Vector3(side * 0.5 * (gap + 0.03), 0.0, 0.02));
  }
  return SignedDistance(shape);
}

bool HasRoomAt(double gap, const Vector3& p_OC, const Vector3& nhat_O, Finger finger) {
  return HasRoom(TipSpheres{}.radius(finger), {true, p_OC, nhat_O}, MakeGroove(gap));
}

TEST(HasRoomTest, InAGrooveThereIsRoomForATipThatIsNarrowerThanIt) {
  // Tips are 18 and 19.9 mm thick; the middle of the groove's wall is far from its ends.
  for (const double gap : {0.010, 0.0175, 0.0185, 0.025}) {
    const Vector3 wall(-0.5 * gap, 0.0, 0.025);
    EXPECT_EQ(HasRoomAt(gap, wall, Vector3::UnitX(), Finger::kIndex),
              gap > 2.0 * TipSpheres{}.radius(Finger::kIndex) - kOwnOverlapAllowed)
        << gap;
  }
  for (const double gap : {0.010, 0.025}) {  // on top and outside there always is
    const double far = 0.5 * gap + 0.03;
    EXPECT_TRUE(HasRoomAt(gap, Vector3(far, 0.0, 0.03), Vector3::UnitX(), Finger::kThumb));
    EXPECT_TRUE(HasRoomAt(gap, Vector3(far - 0.015, 0, 0.04), Vector3::UnitZ(), Finger::kThumb));
  }
}

TEST(HasRoomTest, APlacementInAHoleIsWorthNothingInAnySurroundings) {
  // All of a flat box's faces, taken for those of a groove too narrow for a tip.
  const SignedDistance groove = MakeGroove(0.012);
  TriangleMesh walls = MakeBoxMesh(Vector3(0.012, 0.04, 0.02));
  walls.V.rowwise() += Eigen::RowVector3d(0.0, 0.0, 0.018);
  ContactGraph graph(walls, ContactGraphConfig());
  graph.Score(groove, AnalyticScorer(3.0), AnalyticScorer(3.0), 1);
  for (const ContactNode& node : graph.nodes()) {
    EXPECT_EQ(node.s_c, 0.0) << node.id;
    EXPECT_EQ(node.s_n, 0.0) << node.id;
    EXPECT_FALSE(node.thumb_fits || node.index_fits) << node.id;
  }
}

}  // namespace
}  // namespace pregrasp
