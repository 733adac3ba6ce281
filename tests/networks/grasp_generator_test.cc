#include "app/networks/grasp_generator.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

class GraspGeneratorTest : public testing::Test {
 protected:
  GraspGeneratorTest() {
    Rng rng(31);
    state_ = MakeRandomState(rng, structure_.size());
    encoded_ = generator_.Encode(structure_, state_);
    const PlanningContact thumb = MakeRandomContact(rng, P_), index = MakeRandomContact(rng, P_);
    choices_[0][0] = thumb;
    choices_[1][1] = index;
    choices_[2] = {thumb, index};
  }

  const GraspGenerator generator_ = GraspGenerator::FromTensors(MakeRandomGenerator(30));
  const MatrixX3 P_ = MakeBoxCloud(3);
  const CloudStructure structure_ = generator_.BuildStructure(P_, Matrix3::Identity());
  ObjectState state_;
  EncodedState encoded_;
  std::array<PlanningContacts, 3> choices_;
};

TEST_F(GraspGeneratorTest, GivenContactsAreKept) {
  for (const PlanningContacts& given : choices_) {
    for (const GraspPoints& grasp : generator_.Sample(structure_, encoded_, given, 5, Rng(1))) {
      for (int f = 0; f < kNumPlanningFingers; ++f) {
        if (!given[f]) continue;
        EXPECT_EQ(grasp[f], given[f]->p_OC);
      }
    }
  }
}

TEST_F(GraspGeneratorTest, EachOfTheThreeGeneratorsPredictsTheOtherFingers) {
  EXPECT_EQ(PredictedFingers(0).front(), Finger::kIndex);
  EXPECT_EQ(PredictedFingers(1).front(), Finger::kThumb);
  EXPECT_EQ(PredictedFingers(2).front(), Finger::kMiddle);
  for (int which = 0; which < 3; ++which) EXPECT_EQ(GeneratorOf(choices_[which]), which);
  EXPECT_THROW(GeneratorOf({}), InternalError);
}

TEST_F(GraspGeneratorTest, SamplesDifferAndAreReproducible) {
  const auto a = generator_.Sample(structure_, encoded_, choices_[2], 20, Rng(1, RngStream::kTest));
  const auto b = generator_.Sample(structure_, encoded_, choices_[2], 20, Rng(1, RngStream::kTest));
  EXPECT_EQ(a, b);
  EXPECT_NE(a[0], a[1]);
}

TEST_F(GraspGeneratorTest, ASampleDoesNotDependOnTheOthers) {
  Rng rng(2);
  std::vector<float> latent(20 * generator_.latent_size());
  for (float& z : latent) z = static_cast<float>(rng.Normal());
  const auto all = generator_.Decode(structure_, encoded_, choices_[0], latent);
  for (int i = 0; i < 20; ++i) {
    const auto row = latent.begin() + static_cast<std::ptrdiff_t>(i) * generator_.latent_size();
    EXPECT_EQ(generator_.Decode(structure_, encoded_, choices_[0],
                                {row, row + generator_.latent_size()})[0],
              all[i]);
  }
}

TEST_F(GraspGeneratorTest, GraspsTurnWithTheObjectsFrame) {
  Rng rng(4);
  const Matrix3 R_BO = rng.Rotation().toRotationMatrix();
  const Vector3 p_BO(0.1, 0.2, -0.3);
  MatrixX3 P_B = P_ * R_BO.transpose();
  P_B.rowwise() += p_BO.transpose();
  CloudStructure other = generator_.BuildStructure(P_B, R_BO.transpose());
  other.levels = structure_.levels;  // rounding may choose other centroids
  other.p_OC = R_BO * structure_.p_OC + p_BO;
  ObjectState turned = state_;
  turned.up_O = R_BO * state_.up_O;
  const EncodedState encoded = generator_.Encode(other, turned);
  for (const PlanningContacts& given : choices_) {
    PlanningContacts moved = given;
    for (auto& contact : moved) {
      if (!contact) continue;
      contact->p_OC = R_BO * contact->p_OC + p_BO;
      contact->nhat_O = R_BO * contact->nhat_O;
    }
    const GraspPoints a = generator_.Sample(structure_, encoded_, given, 1, Rng(5))[0];
    const GraspPoints b = generator_.Sample(other, encoded, moved, 1, Rng(5))[0];
    for (int f = 0; f < kNumFingers; ++f) {
      EXPECT_LT((b[f] - (R_BO * a[f] + p_BO)).norm(), 1e-5) << f;
    }
  }
}

class FlowTest : public GraspGeneratorTest {
 protected:
  static FlowConfig Config() {
    FlowConfig config;
    config.finger_sets = {0.4, 0.3, 0.2, 0.1};
    return config;
  }
  static GraspGenerator Make(const FlowConfig& config) {
    return GraspGenerator::FromTensors(MakeRandomGenerator(30, 0, &config));
  }
};

TEST_F(FlowTest, LeavesOutRingAndLittleAsOftenAsItIsTold) {
  const GraspGenerator flow = Make(Config());
  for (const PlanningContacts& given : choices_) {
    std::array<double, 4> share{};  // all, no little, no ring, neither
    constexpr int kSamples = 4000;
    for (const GraspPoints& grasp : flow.Sample(structure_, encoded_, given, kSamples, Rng(1))) {
      for (int f = 0; f < 3; ++f) EXPECT_TRUE(grasp[f].allFinite());
      share[(grasp[4].allFinite() ? 0 : 1) + (grasp[3].allFinite() ? 0 : 2)] += 1.0 / kSamples;
    }
    for (int set = 0; set < 4; ++set) EXPECT_NEAR(share[set], Config().finger_sets[set], 0.03);
  }
}

TEST_F(FlowTest, ASampleDoesNotDependOnTheOthers) {
  const GraspGenerator flow = Make(Config());
  ASSERT_EQ(flow.latent_size(), kFlowLatentSize);
  Rng rng(2);
  std::vector<float> latent(20 * kFlowLatentSize);
  for (float& z : latent) z = static_cast<float>(rng.Normal());
  const auto all = flow.Decode(structure_, encoded_, choices_[1], latent);
  for (int i = 0; i < 20; ++i) {
    const auto row = latent.begin() + static_cast<std::ptrdiff_t>(i) * kFlowLatentSize;
    const auto alone = flow.Decode(structure_, encoded_, choices_[1], {row, row + kFlowLatentSize});
    for (int f = 0; f < 3; ++f) EXPECT_EQ(alone[0][f], all[i][f]);
  }
}

TEST_F(FlowTest, FiguresThatCannotBeAreRefused) {
  const FlowConfig config = Config();
  for (const char* text : {"{}", "[]", R"({"steps":0,"noise":0.5,"finger_sets":[1,0,0,0]})",
                           R"({"steps":10,"noise":-1,"finger_sets":[1,0,0,0]})",
                           R"({"steps":10,"noise":0.5,"finger_sets":[1,1,0,0]})",
                           R"({"steps":10,"noise":0.5,"finger_sets":[1,0]})"}) {
    TensorFile file = MakeRandomGenerator(1, 0, &config);
    file.metadata["flow"] = text;
    EXPECT_THROW(GraspGenerator::FromTensors(file), InputError) << text;
  }
}

TEST_F(GraspGeneratorTest, OtherFilesAreRefused) {
  EXPECT_THROW(GraspGenerator::FromTensors(MakeRandomScore(1)), InputError);
  TensorFile file = MakeRandomGenerator(1);
  file.metadata["latent_size"] = "0";
  EXPECT_THROW(GraspGenerator::FromTensors(file), InputError);
  file = MakeRandomGenerator(1);
  file.metadata["both"] = "[256,12]";
  EXPECT_THROW(GraspGenerator::FromTensors(file), InputError);
}

}  // namespace
}  // namespace pregrasp
