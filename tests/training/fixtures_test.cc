// Inference against the trainer's own answers, which write_network_fixtures.cc
// stored.
#include <gtest/gtest.h>

#include <filesystem>

#include "app/networks/grasp_generator.h"
#include "app/networks/score_function.h"
#include "app/training/dataset.h"

namespace pregrasp {
namespace {

class FixturesTest : public testing::Test {
 protected:
  const std::filesystem::path folder_ =
      std::filesystem::path(PREGRASP_SOURCE_DIR) / "tests/training/fixtures";
  const TensorFile questions_ = ReadTensors(folder_ / "questions.safetensors");
  const std::vector<DatasetItem> items_ = ItemsFromTensors(questions_);

  static ObjectState StateOf(const ContextRecord& context) {
    return {context.phi, context.occluded, context.X_WO.linear().row(2).transpose()};
  }
  // Calls visit(item, context, labels) for every context, in the order of the answers.
  template <typename Visit>
  void ForEachContext(Visit visit) const {
    for (const DatasetItem& item : items_) {
      for (std::size_t c = 0; c < item.contexts.size(); ++c) {
        std::vector<PlanningContacts> contacts;
        for (const LabelRecord& label : item.labels) {
          if (label.context == static_cast<int>(c)) contacts.push_back(label.contacts);
        }
        visit(item, item.contexts[c], contacts);
      }
    }
  }
};

TEST_F(FixturesTest, ScoresAreTheTrainers) {
  const ScoreFunction score = ScoreFunction::Load(folder_ / "score.safetensors");
  const auto answers = questions_.Get<double>("answer.score", {-1});
  ThreadPool pool(1);
  std::size_t k = 0;
  ForEachContext([&](const DatasetItem& item, const ContextRecord& context,
                     const std::vector<PlanningContacts>& contacts) {
    const CloudStructure structure = score.BuildStructure(item.P_O, context.X_WO.linear());
    const VectorX scores =
        score.ScoreContacts(structure, StateOf(context), contacts, ScoreOutput::kProgress, pool);
    for (int i = 0; i < scores.size(); ++i) EXPECT_NEAR(scores[i], answers.at(k++), 1e-5);
  });
  EXPECT_EQ(k, answers.size());
  EXPECT_GT(k, 40U);
}

TEST_F(FixturesTest, GraspsAreTheTrainers) {
  const GraspGenerator generator = GraspGenerator::Load(folder_ / "generator.safetensors");
  const auto latent = questions_.Get<float>("answer.latent", {3, generator.latent_size()});
  const auto answers = questions_.Get<double>("answer.points", {-1, 3, kNumFingers, 3});
  std::size_t k = 0;
  ForEachContext([&](const DatasetItem& item, const ContextRecord& context,
                     const std::vector<PlanningContacts>& contacts) {
    const CloudStructure structure = generator.BuildStructure(item.P_O, context.X_WO.linear());
    const EncodedState encoded = generator.Encode(structure, StateOf(context));
    for (const PlanningContacts& given : contacts) {
      for (const GraspPoints& grasp : generator.Decode(structure, encoded, given, latent)) {
        for (const Vector3& p : grasp) {
          const Vector3 expected(answers.at(k), answers.at(k + 1), answers.at(k + 2));
          EXPECT_LT((p - expected).norm(), 1e-6);  // 1e-5 of the network's unit of 10 cm
          k += 3;
        }
      }
    }
  });
  EXPECT_EQ(k, answers.size());
}

}  // namespace
}  // namespace pregrasp
