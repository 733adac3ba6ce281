#include "app/job/facts_json.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/core/rng.h"

namespace pregrasp {
namespace {

Vector3 RandomVector(Rng& rng) { return {rng.Normal(), rng.Normal(), rng.Normal()}; }

StepFacts SampleFacts(Verb verb, int i) {
  Rng rng(7, RngStream::kTest, static_cast<std::uint32_t>(i));
  StepFacts facts;
  facts.id = "path.1.mppi.3~2";
  facts.command = {verb, "path.1.mppi.2", {{"nodes", i}}};
  facts.t = rng.Uniform();
  facts.bodies = {
      {"object", RandomVector(rng), rng.Rotation(), RandomVector(rng), RandomVector(rng)}};
  facts.fingers = {{Finger::kIndex, true, i % 2 == 0, false, RandomVector(rng), RandomVector(rng),
                    RandomVector(rng), RandomVector(rng), RandomVector(rng), rng.Uniform()}};
  facts.contacts = {{0, 1, RandomVector(rng), RandomVector(rng), RandomVector(rng), rng.Normal(),
                     RandomVector(rng)}};
  facts.details = MakeDetails(verb);
  return facts;
}

nlohmann::json ToText(const StepFacts& facts) {
  return ParseJson(FormatJson(FactsToJson(facts, 3)), "step");
}

TEST(FactsJsonTest, EveryKindOfStepReadsBackToTheLastBit) {
  for (int verb = 0; verb <= static_cast<int>(Verb::kWait); ++verb) {
    const StepFacts facts = SampleFacts(static_cast<Verb>(verb), verb);
    const StepFacts back = FactsFromJson(ToText(facts), "step");
    EXPECT_FALSE(CompareFacts(facts, back).has_value()) << VerbName(facts.command.verb);
    EXPECT_EQ(back.details.index(), facts.details.index());
    EXPECT_EQ(back.object().q_WB.coeffs(), facts.object().q_WB.coeffs());
    EXPECT_EQ(back.command, facts.command);
  }
}

TEST(FactsJsonTest, ValuesWithinTheDetailsReadBack) {
  StepFacts facts = SampleFacts(Verb::kIterate, 1);
  IterationFacts iteration;
  iteration.path = 3;
  iteration.end = "patience";
  RolloutFacts rollout;
  rollout.cost = {1.0 / 3.0, {0.1, 0.7}, 0.2, 0.3, 0.4, {{"slip", 1e-17}}};
  rollout.stages = {{{Finger::kThumb, true, false, 12, {1, 2, 3}, {0, 0, 1}, {{4, 5, 6}}}}};
  iteration.rollouts = {rollout, rollout};
  facts.details = iteration;
  const StepFacts back = FactsFromJson(ToText(facts), "step");
  EXPECT_FALSE(CompareFacts(facts, back).has_value());
  const auto& read = std::get<IterationFacts>(back.details);
  EXPECT_EQ(read.rollouts[1].cost.terms[0].value, 1e-17);
  EXPECT_EQ(read.rollouts[0].stages[0][0].p_WTargets[0], Vector3(4, 5, 6));
}

TEST(FactsJsonTest, ADifferenceIsNamedByItsField) {
  const StepFacts facts = SampleFacts(Verb::kCertify, 2);
  StepFacts other = facts;
  std::get<CertifyFacts>(other.details).pressing.push_back({Finger::kThumb, {0, 0, 0}, {0, 0, 1}});
  EXPECT_EQ(CompareFacts(facts, other)->field, "details.pressing");
  other = facts;
  other.fingers[0].f_W.y() += 1e-15;
  EXPECT_EQ(CompareFacts(facts, other)->field, "fingers[0].f_W[1]");
  other = facts;
  other.command.options["nodes"] = 7;
  EXPECT_EQ(CompareFacts(facts, other)->field, "command.options.nodes");
}

TEST(FactsJsonTest, AFactThatIsNotFiniteIsOurBug) {
  StepFacts facts = SampleFacts(Verb::kCertify, 2);
  std::get<CertifyFacts>(facts.details).hold_turn_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FactsToJson(facts, 1), InternalError);
  facts = SampleFacts(Verb::kCertify, 2);
  facts.bodies[0].v_WB.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(FactsToJson(facts, 1), InternalError);
}

TEST(FactsJsonTest, ADamagedStepIsReportedWithItsPlaceAndField) {
  const auto error_of = [](const nlohmann::json& json) -> std::string {
    try {
      FactsFromJson(json, "steps.jsonl:7");
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  const nlohmann::json good = ToText(SampleFacts(Verb::kWait, 1));
  EXPECT_EQ(error_of(good), "none");
  nlohmann::json json = good;
  json.erase("t");
  EXPECT_EQ(error_of(json), "steps.jsonl:7: t: expected a value, got none");
  json = good;
  json["bodies"][0]["p_WB"] = {1, 2};
  EXPECT_EQ(error_of(json), "steps.jsonl:7: bodies[0].p_WB: expected three numbers, got [1,2]");
  json = good;
  json["fingers"][0]["finger"] = "toe";
  EXPECT_NE(error_of(json).find("fingers[0].finger"), std::string::npos);
  json = good;
  json["details"]["physics_steps"] = 1.5;
  EXPECT_NE(error_of(json).find("physics_steps: expected a whole number"), std::string::npos);
}

}  // namespace
}  // namespace pregrasp
