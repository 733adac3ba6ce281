#include "app/networks/score_function.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

class ScoreFunctionTest : public testing::Test {
 protected:
  void SetUp() override {
    for (std::uint32_t i = 0; i < 40; ++i) {
      Rng rng(21, RngStream::kTest, i);
      states_.push_back(MakeRandomState(rng, structure_.size()));
      contacts_.push_back(MakeRandomContacts(rng, P_));
    }
  }

  const ScoreFunction score_ = ScoreFunction::FromTensors(MakeRandomScore(20));
  const MatrixX3 P_ = MakeBoxCloud(2);
  const CloudStructure structure_ = score_.BuildStructure(P_, Matrix3::Identity());
  std::vector<ObjectState> states_;
  std::vector<PlanningContacts> contacts_;
  ThreadPool pool_{2};
};

TEST_F(ScoreFunctionTest, ScoresAreBetweenZeroAndOne) {
  const VectorX scores = score_.ScoreStates(structure_, states_, contacts_, pool_);
  EXPECT_GT(scores.minCoeff(), 0.0);
  EXPECT_LT(scores.maxCoeff(), 1.0);
  EXPECT_GT(scores.maxCoeff() - scores.minCoeff(), 1e-3);
}

TEST_F(ScoreFunctionTest, OneOutputAnswersBothQuestions) {
  EXPECT_EQ(score_.ScoreContacts(structure_, states_[0], contacts_, ScoreOutput::kLifted, pool_),
            score_.ScoreContacts(structure_, states_[0], contacts_, ScoreOutput::kProgress, pool_));
}

TEST_F(ScoreFunctionTest, WithoutContactTheScoreIsZero) {
  const VectorX scores = score_.ScoreStates(structure_, {states_[0]}, {PlanningContacts{}}, pool_);
  EXPECT_EQ(scores[0], 0.0);
}

TEST_F(ScoreFunctionTest, BothWaysOfAskingGiveTheSameBits) {
  const VectorX by_state = score_.ScoreStates(structure_, states_, contacts_, pool_);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    EXPECT_EQ(
        score_.ScoreContacts(structure_, states_[i], contacts_, ScoreOutput::kProgress, pool_)[i],
        by_state[i]);
  }
}

TEST_F(ScoreFunctionTest, TheNumberOfThreadsDoesNotMatter) {
  ThreadPool one(1), four(4);
  std::vector<PlanningContacts> many;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Rng rng(22, RngStream::kTest, i);
    many.push_back(MakeRandomContacts(rng, P_));
  }
  EXPECT_EQ(score_.ScoreContacts(structure_, states_[0], many, ScoreOutput::kProgress, one),
            score_.ScoreContacts(structure_, states_[0], many, ScoreOutput::kProgress, four));
  EXPECT_EQ(score_.ScoreStates(structure_, states_, contacts_, one),
            score_.ScoreStates(structure_, states_, contacts_, four));
}

TEST_F(ScoreFunctionTest, EveryInputMatters) {
  PlanningContacts contacts;
  contacts[0] = PlanningContact{{0.05, 0.05, 0.0}, {0.0, 1.0, 0.0}, 0.02};
  contacts[1] = PlanningContact{{0.05, -0.05, 0.0}, {0.0, -1.0, 0.0}, 0.02};
  const auto score = [&](const ObjectState& state, const PlanningContacts& c) {
    return score_.ScoreContacts(structure_, state, {c}, ScoreOutput::kProgress, pool_)[0];
  };
  const double base = score(states_[0], contacts);
  std::vector<PlanningContacts> changed(6, contacts);
  changed[0][0].reset();
  changed[1][1].reset();
  changed[2][0]->p_OC.x() += 0.02;
  changed[3][1]->nhat_O = Vector3::UnitX();
  changed[4][1]->phi = 0.0;
  std::swap(changed[5][0], changed[5][1]);
  for (const PlanningContacts& other : changed) EXPECT_NE(score(states_[0], other), base);
  ObjectState tilted = states_[0];
  tilted.up_O = Vector3::UnitX();
  EXPECT_NE(score(tilted, contacts), base);
}

TEST_F(ScoreFunctionTest, OtherFilesAreRefused) {
  EXPECT_THROW(ScoreFunction::FromTensors(MakeRandomGenerator(1)), InputError);
  TensorFile file = MakeRandomScore(1);
  file.metadata["score"] = "[256,256,2]";
  EXPECT_THROW(ScoreFunction::FromTensors(file), InputError);
  file.metadata["score"] = "256";
  EXPECT_THROW(ScoreFunction::FromTensors(file), InputError);
  file = MakeRandomScore(1);
  file.tensors.erase("encoder.code.1.bias");
  EXPECT_THROW(ScoreFunction::FromTensors(file), InputError);
}

}  // namespace
}  // namespace pregrasp
