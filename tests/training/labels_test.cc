#include "app/training/labels.h"

#include <gtest/gtest.h>

#include "app/training/make_item.h"

namespace pregrasp {
namespace {

TEST(LabelsTest, AfterTwoReliefsWithoutAnyNoSmallerOneHasAny) {
  const GraspGenerator generator =
      GraspGenerator::Load(PREGRASP_SOURCE_DIR "/assets/weights/generator.safetensors");
  LabelConfig config;
  config.tries = 2;
  config.completion.max_solves = 2;
  ItemConfig items;
  int labels = 0, above_zero = 0, cut_short = 0;
  for (std::int64_t index = 0; index < 4; ++index) {
    const SceneObject object = MakeItemObject(items, index);
    const GraspWorld world = MakeTrainingWorld(MakeItemScene(items, object, index, 0).scene);
    const auto X_WB = world.StartPoses();
    const PointCloud cloud = SamplePointCloud(object.object.shape, 128, Rng(1));
    const CloudStructure structure = generator.BuildStructure(cloud.P, X_WB[0].linear());
    const ContactSampler sampler(world, X_WB, {});
    for (int which = 0; which < 3; ++which) {
      Rng rng(3, RngStream::kTest, static_cast<std::uint32_t>(index), 10 + which);
      const PlanningContacts contacts =
          SampleLabelContacts(world, sampler, {}, which, config, X_WB, rng);
      ASSERT_EQ(GeneratorOf(contacts), which);
      for (const auto& contact : contacts) {
        if (!contact) continue;
        EXPECT_NEAR(world.object().Calc(contact->p_OC), 0.0, 1e-4);
        EXPECT_NEAR(contact->nhat_O.norm(), 1.0, 1e-9);
      }
      const LabelRecord label =
          CalcLabel(world, generator, cloud, structure, contacts, config, rng);
      ++labels;
      int without = 0, sum = 0;
      for (int r = kNumReliefs - 1; r >= 0; --r) {
        const bool over = without >= 2 && world.scene().bodies.size() > 1;
        cut_short += over;
        EXPECT_LE(label.feasible[r], over ? 0 : config.tries);
        without = label.feasible[r] == 0 ? without + 1 : 0;
        sum += label.feasible[r];
      }
      EXPECT_NEAR(label.Value(), sum / static_cast<double>(config.tries * kNumReliefs), 1e-12);
      above_zero += sum > 0;
    }
  }
  EXPECT_EQ(labels, 12);
  EXPECT_GT(above_zero, 0);  // else nothing above was asked
  EXPECT_GT(cut_short, 0);
}

}  // namespace
}  // namespace pregrasp
