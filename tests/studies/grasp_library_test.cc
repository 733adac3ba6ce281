#include "app/studies/grasp_library.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

constexpr std::uint64_t kSeed = 5;

TEST(GraspLibraryTest, FindsTheGraspsNearestToWhatIsGivenAndKeepsThat) {
  ThreadPool pool(2);
  const GraspLibrary library({"can"}, 1, kSeed, pool);
  ASSERT_GT(library.num_grasps(), 4);
  const AlignedBox box(Vector3(-0.03, -0.03, -0.06), Vector3(0.03, 0.03, 0.06));
  PlanningContacts given;
  given[0] = PlanningContact{Vector3(0.03, 0.0, 0.01), Vector3::UnitX()};
  const std::vector<GraspPoints> four = library.FindNearest(box, given, 4);
  ASSERT_EQ(four.size(), 4U);
  for (const GraspPoints& points : four) {
    EXPECT_EQ(points[0], given[0]->p_OC);
    EXPECT_TRUE(box.exteriorDistance(points[1]) < 1e-2) << points[1].transpose();
  }
  EXPECT_EQ(library.FindNearest(box, given, 1).front()[1], four.front()[1]);
  EXPECT_EQ(library.FindNearest(box, given, 1'000'000).size(),
            static_cast<std::size_t>(library.num_grasps()));
}

TEST(GraspLibraryTest, IsTheSameForAnyNumberOfThreads) {
  ThreadPool one(1), two(2);
  const AlignedBox box(Vector3(-0.03, -0.03, -0.06), Vector3(0.03, 0.03, 0.06));
  EXPECT_EQ(GraspLibrary({"can"}, 1, kSeed, one).FindNearest(box, {}, 3).front()[0],
            GraspLibrary({"can"}, 1, kSeed, two).FindNearest(box, {}, 3).front()[0]);
  EXPECT_THROW(GraspLibrary({"unicorn"}, 1, kSeed, one), InputError);
}

}  // namespace
}  // namespace pregrasp
