#include "app/job/timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/job/branch_comparison.h"
#include "app/job/facts_json.h"
#include "tests/job/fixture.h"
#include "tests/networks/random_network.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

using Node = Timeline::Node;
using Json = nlohmann::json;

// Short plans with networks whose weights are random.
class TimelineTest : public testing::Test {
 protected:
  TimelineTest() { WriteRandomWeights(folder_.path()); }
  ~TimelineTest() override { ClearInterrupt(); }

  std::unique_ptr<Job> MakeJob(int threads = 1) const {
    JobSetup setup;
    setup.scene = MakeRulerScene();
    setup.weights = folder_.path();
    setup.config.mesh.triangles = 12;
    setup.config.graph.samples = 1;
    setup.config.graph.top_percent = 20.0;
    setup.config.cloud_points = 128;
    setup.config.mppi.samples = 6;
    setup.config.mppi.iterations = 4;
    return std::make_unique<Job>(std::move(setup), threads);
  }

  static const Node& MakePath(Timeline& timeline) {
    const Node* node = &timeline.Do(timeline.root(), Verb::kMesh);
    node = &timeline.Do(*node, Verb::kScore);
    while (!timeline.GetState(*node)->paths) node = &timeline.Do(*node, Verb::kPrune);
    return timeline.Do(*node, Verb::kPath, {{"rank", 1}});
  }

  const TestFolder folder_;
};

TEST_F(TimelineTest, TheSameCommandFromTheSameNodeIsTheSameNode) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node& path = MakePath(timeline);
  const Node& first = timeline.Do(path, Verb::kIterate);
  const std::size_t count = timeline.nodes().size();
  EXPECT_EQ(&timeline.Do(path, Verb::kIterate), &first);
  // Settings that change nothing are no other command.
  EXPECT_EQ(&timeline.Do(path, Verb::kIterate, {{"settings", {{"mppi.samples", 6}}}}), &first);
  EXPECT_EQ(timeline.nodes().size(), count);
}

TEST_F(TimelineTest, AnotherCommandGetsTheNextFreeBranchWhichWhatFollowsCarriesOn) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node& path = MakePath(timeline);
  const Node& first = timeline.Do(path, Verb::kIterate);
  EXPECT_EQ(first.id(), "path.1.mppi.1");
  const Node& second = timeline.Do(first, Verb::kIterate);
  const Node& fork = timeline.Do(first, Verb::kIterate, {{"settings", {{"mppi.sigma", 0.3}}}});
  EXPECT_EQ(second.id(), "path.1.mppi.2");
  EXPECT_EQ(fork.id(), "path.1.mppi.2~2");
  EXPECT_EQ(std::get<IterationFacts>(fork.facts.details).sigma,
            0.3 * std::pow(0.3 / 0.3, 1.0 / 3.0));
  EXPECT_EQ(timeline.Do(fork, Verb::kCertify).id(), "path.1.certify~2");
  EXPECT_EQ(timeline.Do(second, Verb::kCertify).id(), "path.1.certify");
  const Node& third = timeline.Do(first, Verb::kIterate, {{"settings", {{"mppi.sigma", 0.5}}}});
  EXPECT_EQ(third.id(), "path.1.mppi.2~3");
}

TEST_F(TimelineTest, ScreeningAndIterationsShowTheWorldWhereTheBestPlanSoFarEnds) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node* node = &MakePath(timeline);
  const Node& screened = timeline.Do(*node, Verb::kScreen);
  EXPECT_GT(screened.facts.t, 1.0);
  EXPECT_FALSE(screened.facts.contacts.empty());
  double best_cost = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Vector3 p_WO_before = node->facts.object().p_WB;
    node = &timeline.Do(*node, Verb::kIterate);
    EXPECT_GT(node->facts.t, 1.0);
    const auto& facts = std::get<IterationFacts>(node->facts.details);
    const auto best =
        std::min_element(facts.rollouts.begin(), facts.rollouts.end(),
                         [](const auto& a, const auto& b) { return a.cost.total < b.cost.total; });
    const bool is_better = i == 0 || best->cost.total < best_cost;
    best_cost = facts.best_cost;
    EXPECT_EQ(node->facts.object().p_WB, is_better ? best->p_WO_end : p_WO_before) << i;
  }
}

TEST_F(TimelineTest, IdsAreUniqueWhateverIsDoneAndUndone) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  MakePath(timeline);
  Rng rng(11);
  const Verb verbs[] = {Verb::kMesh,    Verb::kScore, Verb::kPrune, Verb::kPath,  Verb::kIterate,
                        Verb::kCertify, Verb::kWait,  Verb::kTouch, Verb::kScreen};
  for (int i = 0; i < 150; ++i) {
    const Node& from = *timeline.nodes()[rng.UniformInt(timeline.nodes().size())];
    const Verb verb = verbs[rng.UniformInt(std::size(verbs))];
    Json options = Json::object();
    if (verb == Verb::kPath) options["rank"] = 1 + rng.UniformInt(3);
    if (verb == Verb::kWait) options["steps"] = 1 + rng.UniformInt(3);
    if (verb == Verb::kTouch) options = {{"finger", "index"}, {"p_OC", {0.1, 0.0, 0.0015}}};
    if (rng.UniformInt(3) == 0) options["settings"] = {{"mppi.sigma", 0.5 + rng.UniformInt(2)}};
    try {
      timeline.Do(from, verb, options);
    } catch (const InputError&) {
      // The command does not fit there; nothing was done.
    }
  }
  std::set<std::string> ids;
  for (const auto& node : timeline.nodes()) {
    EXPECT_TRUE(ids.insert(node->id()).second) << node->id();
    EXPECT_EQ(&timeline.Find(node->id()), node.get());
  }
  EXPECT_GT(ids.size(), 40U);
}

TEST_F(TimelineTest, TheJournalAloneGivesTheSameFactsOnAnyNumberOfThreads) {
  const auto job = MakeJob(1), again = MakeJob(2);
  Timeline timeline(*job), replayed(*again);
  const Node* node = &MakePath(timeline);
  for (int i = 0; i < 2; ++i) node = &timeline.Do(*node, Verb::kIterate);
  timeline.Do(*node->parent, Verb::kIterate, {{"settings", {{"mppi.sigma", 0.2}}}});
  timeline.Do(*node, Verb::kCertify);
  timeline.Do(timeline.root(), Verb::kWait, {{"steps", 5}});
  for (const auto& done : timeline.nodes()) {
    if (done->parent == nullptr) continue;
    const Command command = CommandFromJson(CommandToJson(done->command), "journal");
    const Node& redone = replayed.Do(replayed.Find(command.node), command.verb, command.options);
    const auto difference = CompareFacts(done->facts, redone.facts);
    EXPECT_FALSE(difference.has_value()) << done->id() << ": " << difference->field;
  }
}

TEST_F(TimelineTest, AStateThatWasDroppedIsComputedAgainTheSame) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node& path = MakePath(timeline);
  const Node& iteration = timeline.Do(path, Verb::kIterate);
  const std::vector<double> mean = timeline.GetState(iteration)->optimization->mean;
  const Node* sim = &timeline.root();
  for (int i = 0; i < 1600; ++i) sim = &timeline.Do(*sim, Verb::kWait, {{"steps", 0}});
  EXPECT_EQ(timeline.GetState(iteration)->optimization->mean, mean);
}

TEST_F(TimelineTest, WhatDoesNotFitIsRefusedAndLeavesNoNode) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const auto refused = [&](const Node& from, Verb verb, const Json& options) {
    const std::size_t count = timeline.nodes().size();
    EXPECT_THROW(timeline.Do(from, verb, options), InputError) << VerbName(verb);
    EXPECT_EQ(timeline.nodes().size(), count);
  };
  for (const Verb verb : {Verb::kScore, Verb::kPrune, Verb::kIterate, Verb::kCertify, Verb::kGrasp,
                          Verb::kFill, Verb::kSmooth}) {
    refused(timeline.root(), verb, Json::object());
  }
  refused(timeline.root(), Verb::kPath, {{"rank", 1}});
  refused(timeline.root(), Verb::kLift, {{"grasp", 1}});
  refused(timeline.root(), Verb::kKeyframe, {{"grasp", 1}});
  refused(timeline.root(), Verb::kFrame, {{"frame", 1}});
  refused(timeline.root(), Verb::kSettle, {{"seconds", -1.0}});
  refused(timeline.root(), Verb::kWait, {{"steps", -1}});
  refused(timeline.root(), Verb::kTouch, {{"finger", "toe"}, {"p_OC", {0, 0, 0}}});
  refused(timeline.root(), Verb::kMesh, {{"settings", {{"mesh.triangels", 12}}}});
  EXPECT_THROW(timeline.Find("scene.strat"), InputError);
}

TEST_F(TimelineTest, AnInterruptedActionIsAStepThatRedoesToTheSame) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  RequestInterrupt();
  EXPECT_THROW(timeline.Do(timeline.root(), Verb::kWait, {{"steps", 50}}), Interrupted);
  ClearInterrupt();
  const Node& node = timeline.last();
  EXPECT_EQ(node.id(), "sim.1");
  EXPECT_TRUE(std::get<SimulationFacts>(node.facts.details).stopped);
  const Applied again = timeline.Try(timeline.root(), node.command.verb, node.command.options);
  StepFacts facts = again.facts;
  EXPECT_FALSE(CompareFacts(facts, node.facts).has_value());
}

TEST_F(TimelineTest, AnActionThatIsStoppedIsTakenFromTheWholeOfItTheSame) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node& touched = timeline.Do(timeline.root(), Verb::kTouch,
                                    {{"finger", "index"}, {"p_OC", {0.11, 0, 0.0015}}});
  const nlohmann::json move = {
      {"finger", "index"}, {"p_WTarget", {0.05, 0, -0.01}}, {"seconds", 0.3}};
  const Node& whole = timeline.Do(touched, Verb::kMove, move);
  const int steps = std::get<SimulationFacts>(whole.facts.details).physics_steps;
  for (const int stopped_after : {0, 1, steps / 2, steps}) {
    nlohmann::json options = move;
    options["stopped_after"] = stopped_after;
    const Node& part = timeline.Do(touched, Verb::kMove, options);
    const auto state = timeline.GetState(part), of_whole = timeline.GetState(whole);
    // The moments themselves: nothing was simulated.
    EXPECT_EQ(&state->simulation->state(),
              &of_whole->simulation->state_at(state->simulation->num_states() - 1));
    const Applied again = timeline.Try(touched, Verb::kMove, options);
    StepFacts facts = again.facts;
    facts.id = part.id();
    EXPECT_FALSE(CompareFacts(facts, part.facts).has_value()) << stopped_after;
    EXPECT_EQ(again.state->simulation->num_states(), state->simulation->num_states());
  }
}

TEST_F(TimelineTest, WhatPartsOfAnActionShareWithItCountsOnceAndStaysShared) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  constexpr int kSteps = 500;
  const Node& whole = timeline.Do(timeline.root(), Verb::kWait, {{"steps", kSteps}});
  const std::size_t before = timeline.held_bytes();
  const Node* part = nullptr;
  for (int stopped_after = 1; stopped_after <= 100; ++stopped_after) {
    part = &timeline.Do(timeline.root(), Verb::kWait,
                        {{"steps", kSteps}, {"stopped_after", stopped_after}});
  }
  EXPECT_LT(timeline.held_bytes() - before, 100U * 10000U);  // 16 MB if none were shared
  // Of so many that the states of the first ones are dropped, a part is taken from the whole again.
  const WorldState* const first = &timeline.GetState(*part)->simulation->state();
  const Node* node = &timeline.root();
  for (int i = 0; i < 1600; ++i) node = &timeline.Do(*node, Verb::kLetGo, {{"finger", "index"}});
  EXPECT_NE(&timeline.GetState(*part)->simulation->state(), first);
  EXPECT_EQ(&timeline.GetState(*part)->simulation->state(),
            &timeline.GetState(whole)->simulation->state_at(100));
}

TEST_F(TimelineTest, RestoredStepsAreDoneWhenTheirStateIsAskedForAndGoOnAsTheFirstDid) {
  const auto job = MakeJob(), other_job = MakeJob();
  Timeline first(*job), second(*other_job);
  const Node& done = first.Do(first.Do(MakePath(first), Verb::kIterate), Verb::kIterate);
  for (const auto& node : first.nodes()) second.Restore(node->facts, 0.0);
  EXPECT_EQ(second.nodes().size(), first.nodes().size());
  const Node& restored = second.Find(done.id());
  EXPECT_EQ(CompareFacts(restored.facts, done.facts), std::nullopt);
  EXPECT_EQ(&second.Do(*restored.parent, Verb::kIterate), &restored);  // known without its state
  const Node &next = first.Do(done, Verb::kIterate), &again = second.Do(restored, Verb::kIterate);
  EXPECT_EQ(CompareFacts(again.facts, next.facts), std::nullopt);
}

TEST_F(TimelineTest, ARecordThatDiffersIsRefusedWhereItDoes) {
  const auto job = MakeJob(), other_job = MakeJob();
  Timeline first(*job), second(*other_job);
  const Node& done = first.Do(MakePath(first), Verb::kIterate);
  for (const auto& node : first.nodes()) {
    StepFacts facts = node->facts;
    if (auto* iteration = std::get_if<IterationFacts>(&facts.details)) iteration->best_cost += 1e-9;
    second.Restore(facts, 0.0);
  }
  try {
    second.GetState(second.Find(done.id()));
    ADD_FAILURE() << "it was believed";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "path.1.mppi.1");
    EXPECT_EQ(error.field(), "details.best_cost");
  }
  StepFacts twice = done.facts;
  EXPECT_THROW(second.Restore(twice, 0.0), InputError);
  twice.id = "path.1.mppi.9";
  twice.command.node = "path.1.mppi.8";
  EXPECT_THROW(second.Restore(twice, 0.0), InputError);
}

TEST_F(TimelineTest, AGateIsAskedOfEachStepAndStopsBeforeTheNext) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node& path = MakePath(timeline);
  int asked = 0;
  timeline.SetGate([&](const Node&) { return ++asked < 2; });
  const Node& first = timeline.Do(path, Verb::kIterate);
  EXPECT_EQ(&timeline.Do(path, Verb::kIterate), &first);
  EXPECT_THROW(timeline.Do(first, Verb::kIterate), Paused);
  EXPECT_EQ(asked, 2);
  timeline.SetGate({});
  timeline.Do(first, Verb::kIterate);
}

TEST_F(TimelineTest, TwoBranchesDifferFirstInWhatWasAskedFor) {
  const auto job = MakeJob();
  Timeline timeline(*job);
  const Node& first = timeline.Do(MakePath(timeline), Verb::kIterate);
  const Node& one = timeline.Do(timeline.Do(first, Verb::kIterate), Verb::kIterate);
  const Node& other = timeline.Do(first, Verb::kIterate, {{"settings", {{"mppi.sigma", 0.3}}}});
  const BranchComparison comparison = CompareBranches(timeline, one, timeline, other);
  EXPECT_EQ(comparison.common, &first);
  EXPECT_EQ(comparison.left, one.parent);
  EXPECT_EQ(comparison.right, &other);
  ASSERT_TRUE(comparison.command && comparison.facts);
  EXPECT_EQ(comparison.command->field, "mppi.sigma");
  EXPECT_EQ(comparison.command->left, "1.2");
  EXPECT_EQ(comparison.same_noise, true);
  ASSERT_EQ(comparison.settings.size(), 1U);
  EXPECT_TRUE(CompareBranches(timeline, one, timeline, one).same());
}

}  // namespace
}  // namespace pregrasp
