// Needs libtorch; built with -DPREGRASP_TRAINER=ON.
#include <gtest/gtest.h>

#include <filesystem>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/networks/score_function.h"
#include "app/training/generator_task.h"
#include "app/training/metrics.h"
#include "app/training/score_task.h"
#include "tests/training/toy_dataset.h"

namespace pregrasp {
namespace {

using torch::Tensor;

constexpr int kPoints = 96;

Tensor Leaf(std::vector<std::int64_t> shape) { return torch::randn(shape).set_requires_grad(true); }

void ExpectSameGradients(const Tensor& ours, const Tensor& theirs,
                         const std::vector<Tensor>& leaves) {
  EXPECT_TRUE(torch::allclose(ours, theirs, 1e-4, 1e-5));
  const Tensor weight = torch::randn_like(ours);
  const auto a = torch::autograd::grad({(ours * weight).sum()}, leaves);
  const auto b = torch::autograd::grad({(theirs * weight).sum()}, leaves);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    EXPECT_TRUE(torch::allclose(a[i], b[i], 1e-4, 1e-4)) << i;
  }
}

TEST(TorchOpsTest, TheLinearLayerIsTorchs) {
  torch::manual_seed(1);
  const Tensor x = Leaf({37, 19}), weight = Leaf({21, 19}), bias = Leaf({21});
  ExpectSameGradients(ApplyLinear(x, weight, bias), torch::linear(x, weight, bias),
                      {x, weight, bias});
}

TEST(TorchOpsTest, EdgeDifferencesAreGatheredRows) {
  torch::manual_seed(2);
  const Tensor point = Leaf({10, 6}), center = Leaf({4, 6});
  const Edges edges{torch::tensor({3, 9, 3, 0, 1, 2, 8}, torch::kInt),
                    torch::tensor({0, 2, 2, 5, 7}, torch::kInt)};
  const Tensor target = torch::tensor({0, 0, 2, 2, 2, 3, 3}, torch::kLong);
  ExpectSameGradients(
      EdgeDifference(point, center, edges),
      point.index_select(0, edges.source.to(torch::kLong)) - center.index_select(0, target),
      {point, center});
}

TEST(TorchOpsTest, SegmentMaxIsTheMaximumOfEachSlice) {
  torch::manual_seed(3);
  const Tensor values = Leaf({7, 5});
  const Tensor begin = torch::tensor({0, 2, 2, 5, 7}, torch::kInt);
  ExpectSameGradients(SegmentMax(values, begin),
                      torch::stack({values.slice(0, 0, 2).amax(0), torch::zeros({5}),
                                    values.slice(0, 2, 5).amax(0), values.slice(0, 5, 7).amax(0)}),
                      {values});
}

TEST(TrainingRunTest, TheLearningRateWarmsUpAndFallsAsACosine) {
  TrainingConfig config;
  config.steps = 1101;
  config.warm_up = 100;
  config.learning_rate = 2.0;
  config.final_share = 0.1;
  EXPECT_DOUBLE_EQ(CalcLearningRate(config, 0), 0.02);
  EXPECT_DOUBLE_EQ(CalcLearningRate(config, 99), 2.0);
  EXPECT_DOUBLE_EQ(CalcLearningRate(config, 100), 2.0);
  EXPECT_NEAR(CalcLearningRate(config, 600), 2.0 * 0.55, 1e-12);
  EXPECT_NEAR(CalcLearningRate(config, 1100), 0.2, 1e-12);
}

class TrainerTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { PrepareTorch(); }

  TrainerTest() {
    config_.encoder = generator_.encoder = MakeToyEncoder();
    config_.hidden_widths = {32};
    config_.source = LabelSource::kCompletions;
    generator_.hidden_widths = {32};
    generator_.latent_size = 4;
    training_.steps = 20;
    training_.warm_up = 5;
    training_.evaluate_every = 10;
  }
  ScoreTask MakeTask() const { return {dataset_, {"family3"}, config_}; }
  static void Ignore(const TrainingProgress&) {}

  const std::shared_ptr<const Dataset> dataset_ =
      std::make_shared<Dataset>(MakeToyDataset(1, 24, kPoints));
  ScoreTaskConfig config_;
  GeneratorTaskConfig generator_;
  TrainingConfig training_;
};

TEST_F(TrainerTest, ExportedScoresAreThoseOfTheTrainer) {
  ScoreTask task = MakeTask();
  RunTraining(task, training_, Ignore);
  const torch::NoGradGuard guard;
  const ScoreTask::Predictions expected = task.Predict(task.data().validation);
  const ScoreFunction score = ScoreFunction::FromTensors(task.Export());
  ThreadPool pool(1);
  std::size_t k = 0;
  for (const TrainingContext& context : task.data().validation) {
    const CloudStructure structure =
        score.BuildStructure(context.item->P_O, context.context->X_WO.linear());
    ObjectState state{context.context->phi, context.context->occluded,
                      context.context->X_WO.linear().row(2).transpose()};
    std::vector<PlanningContacts> contacts;
    for (const LabelRecord* label : context.labels) contacts.push_back(label->contacts);
    const VectorX scores =
        score.ScoreContacts(structure, state, contacts, ScoreOutput::kProgress, pool);
    for (int i = 0; i < scores.size(); ++i) EXPECT_NEAR(scores[i], expected.prediction[k++], 1e-5);
  }
  EXPECT_EQ(k, expected.prediction.size());
  EXPECT_GT(k, 100U);
}

TEST_F(TrainerTest, ARunThatWasCutOffEndsWithTheSameWeights) {
  ScoreTask whole = MakeTask();
  const auto history = RunTraining(whole, training_, Ignore);

  training_.checkpoint = std::filesystem::path(testing::TempDir()) / "trainer_test.checkpoint";
  training_.checkpoint_every = 4;
  std::filesystem::remove(training_.checkpoint);
  ScoreTask first = MakeTask();
  EXPECT_THROW(RunTraining(first, training_,
                           [](const TrainingProgress& progress) {
                             if (progress.step == 13) RequestInterrupt();
                           }),
               Interrupted);
  ClearInterrupt();
  ScoreTask second = MakeTask();
  EXPECT_EQ(RunTraining(second, training_, Ignore), history);
  EXPECT_EQ(SerializeTensors(second.Export()), SerializeTensors(whole.Export()));

  ScoreTask other = MakeTask();
  training_.learning_rate *= 2.0;
  EXPECT_THROW(RunTraining(other, training_, Ignore), InputError);
  std::filesystem::remove(training_.checkpoint);
}

TEST_F(TrainerTest, TheScoreLearnsAKnownAnswerOnFamiliesNeverSeen) {
  ScoreTask task = MakeTask();
  training_.steps = 400;
  training_.evaluate_every = 400;
  const auto history = RunTraining(task, training_, Ignore);
  EXPECT_GT(history.back()["metrics"]["r2"].get<double>(), 0.6) << history.dump(1);
  EXPECT_GT(history.back()["metrics"]["rank_correlation"].get<double>(), 0.6);
}

TEST_F(TrainerTest, BothOutputsLearnTheirOwnLabels) {
  training_.steps = training_.evaluate_every = 400;
  config_.source = LabelSource::kSearch;
  config_.progress = ProgressKind::kRoom;  // of the toys, the other one reversed
  ScoreTask task = MakeTask();
  const auto metrics = RunTraining(task, training_, Ignore).back()["metrics"];
  EXPECT_GT(metrics["r2"].get<double>(), 0.6) << metrics.dump(1);
  EXPECT_GT(metrics["auc"].get<double>(), 0.9);
  EXPECT_LT(metrics["calibration_error"].get<double>(), 0.15);
  const torch::NoGradGuard guard;
  const ScoreTask::Predictions all = task.Predict(task.data().validation);
  EXPECT_LT(CalcRankCorrelation(all.prediction, all.lifted_prediction), -0.5);
  EXPECT_NO_THROW(ScoreFunction::FromTensors(task.Export()));
  EXPECT_THROW(ParseProgressKind("speed"), InputError);
  EXPECT_THROW(ParseLabelSource("guess"), InputError);
}

TEST_F(TrainerTest, AblationsHideWhatTheySay) {
  for (const char* name : {"no-sdf", "no-shape", "frozen-encoder"}) {
    config_.variant = ParseScoreVariant(name);
    ScoreTask task = MakeTask();
    const TensorFile before = task.Export();
    RunTraining(task, training_, Ignore);
    const TensorFile after = task.Export();
    const auto encoder = SetEncoderConfig::FromJson(after.metadata.at("encoder"), "test");
    EXPECT_EQ(encoder.phi_scale == 0.0, config_.variant == ScoreVariant::kNoSdf);
    EXPECT_EQ(encoder.position_scale == 0.0, config_.variant == ScoreVariant::kNoShape);
    EXPECT_EQ(before.tensors.at("encoder.code.0.weight").bytes ==
                  after.tensors.at("encoder.code.0.weight").bytes,
              config_.variant == ScoreVariant::kFrozenEncoder);
  }
  EXPECT_THROW(ParseScoreVariant("none"), InputError);
}

class GeneratorTrainerTest : public TrainerTest,
                             public testing::WithParamInterface<GeneratorDecoder> {};

TEST_P(GeneratorTrainerTest, GeneratorsTrainResumeAndExport) {
  generator_.decoder = GetParam();
  GeneratorTask task(dataset_, {"family3"}, generator_);
  training_.steps = 60;
  const auto history = RunTraining(task, training_, Ignore);
  EXPECT_LT(history.back()["loss"].get<double>(), history.front()["loss"].get<double>());
  const GraspGenerator generator = GraspGenerator::FromTensors(task.Export());
  const bool flow = GetParam() == GeneratorDecoder::kFlow;
  EXPECT_EQ(generator.latent_size(), flow ? kFlowLatentSize : 4);

  const TrainingContext& context = task.data().validation.front();
  const CloudStructure structure =
      generator.BuildStructure(context.item->P_O, context.context->X_WO.linear());
  const ObjectState state{context.context->phi, context.context->occluded,
                          context.context->X_WO.linear().row(2).transpose()};
  const EncodedState encoded = generator.Encode(structure, state);
  const torch::NoGradGuard guard;
  for (int which = 0; which < 3; ++which) {
    PlanningContacts given;
    if (which != 1) given[0] = PlanningContact{context.item->P_O.row(0), {1.0, 0.0, 0.0}, 0.01};
    if (which != 0) given[1] = PlanningContact{context.item->P_O.row(1), {0.0, 1.0, 0.0}, 0.02};
    std::vector<float> latent(2 * generator.latent_size());
    for (std::size_t i = 0; i < latent.size(); ++i) latent[i] = std::sin(7.0F * i);
    const auto ours = generator.Decode(structure, encoded, given, latent);
    const auto theirs = task.Decode(context, given, latent);
    ASSERT_EQ(ours.size(), 2U);
    for (int i = 0; i < 2; ++i) {
      for (int f = 0; f < kNumFingers; ++f) {
        ASSERT_EQ(ours[i][f].allFinite(), theirs[i][f].allFinite());
        if (!ours[i][f].allFinite()) continue;
        EXPECT_LT((ours[i][f] - theirs[i][f]).norm(), 1e-6);  // 1e-5 of the network's unit
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Decoders, GeneratorTrainerTest,
                         testing::Values(GeneratorDecoder::kFlow, GeneratorDecoder::kAutoencoder),
                         [](const auto& info) { return GeneratorDecoderName(info.param); });

}  // namespace
}  // namespace pregrasp
