#include "app/job/state_store.h"

#include <gtest/gtest.h>

#include "app/job/facts_bytes.h"

namespace pregrasp {
namespace {

std::shared_ptr<const Certificate> MakeCertificate(int rows) {
  auto certificate = std::make_shared<Certificate>();
  certificate->trace.resize(rows);
  return certificate;
}

std::shared_ptr<const JobState> StateWith(std::shared_ptr<const Certificate> certificate) {
  auto state = std::make_shared<JobState>();
  state->certificate = std::move(certificate);
  return state;
}

TEST(StateStoreTest, WhatStatesShareCountsOnceAndUntilTheLastOfThemIsGone) {
  constexpr int kRows = 1000;
  StateStore store(3, 1'000'000'000);
  store.Keep(1, StateWith(nullptr));
  const auto shared = MakeCertificate(kRows);
  store.Keep(2, StateWith(shared));
  const std::size_t one = store.bytes();
  EXPECT_GE(one, kRows * sizeof(TraceRow));
  store.Keep(3, StateWith(shared));
  EXPECT_LT(store.bytes(), one + one / 10);
  store.Keep(4, StateWith(nullptr));
  EXPECT_EQ(store.Find(2), nullptr);
  EXPECT_GE(store.bytes(), one);
  store.Keep(5, StateWith(nullptr));
  EXPECT_LT(store.bytes(), one / 10);
}

TEST(StateStoreTest, TheOneUsedLongestAgoGoesButNotTheFirst) {
  StateStore store(4, 1'000'000'000);
  for (int number = 1; number <= 4; ++number) store.Keep(number, StateWith(nullptr));
  EXPECT_NE(store.Find(2), nullptr);
  store.Keep(5, StateWith(nullptr));
  EXPECT_EQ(store.num_states(), 4U);
  EXPECT_EQ(store.Find(3), nullptr);
  EXPECT_NE(store.Find(1), nullptr);
  EXPECT_NE(store.Find(2), nullptr);
  EXPECT_NE(store.Find(4), nullptr);
}

TEST(StateStoreTest, BytesAreBoundedButTheFirstAndTheNewestStay) {
  const std::size_t most = 3000 * sizeof(TraceRow);
  StateStore store(1000, most);
  store.Keep(1, StateWith(nullptr));
  for (int number = 2; number <= 20; ++number) {
    store.Keep(number, StateWith(MakeCertificate(1000)));
    EXPECT_LE(store.bytes(), most);
  }
  EXPECT_EQ(store.num_states(), 3U);
  store.Keep(21, StateWith(MakeCertificate(9000)));
  EXPECT_EQ(store.num_states(), 2U);
  EXPECT_NE(store.Find(1), nullptr);
  EXPECT_NE(store.Find(21), nullptr);
}

TEST(FactsBytesTest, ListsTextsAndPhysicsStepsCount) {
  StepFacts scored;
  ScoreFacts scores;
  const std::size_t empty = CalcBytes(scored);
  scores.s_c.assign(1000, 0.5);
  scored.details = scores;
  EXPECT_GE(CalcBytes(scored), empty + 8000);
  EXPECT_LE(CalcBytes(scored), empty + 9000);
  StepFacts grasp;
  GraspFacts facts;
  facts.colliding = {std::string(5000, 'x')};
  grasp.details = facts;
  EXPECT_GE(CalcBytes(grasp), empty + 5000);
  StepFacts simulated;
  SimulationFacts steps;
  steps.physics_steps = 1000;
  simulated.details = steps;
  EXPECT_GE(CalcPastBytes(simulated), 1'000'000U);
  EXPECT_EQ(CalcPastBytes(grasp), 0U);
}

}  // namespace
}  // namespace pregrasp
