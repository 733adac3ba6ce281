#include "app/pipeline/plan_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/core/check.h"
#include "app/hand/hand_shapes.h"
#include "app/pipeline/describe_plan.h"
#include "app/pipeline/planner_settings.h"
#include "app/recording/motion_table.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

using Json = nlohmann::json;

constexpr int kGhostsShown = 6;  // of an iteration's rollouts: the best

Json ToJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

Json FingerNames(const std::vector<GraspContact>& contacts) {
  Json names = Json::array();
  for (const GraspContact& contact : contacts) names.push_back(FingerName(contact.finger));
  return names;
}

// A scale of scores from 0 to the largest one, in three numbers.
RenderLegend ScoreLegend(const std::string& title, double low, double high) {
  RenderLegend legend;
  legend.title = title;
  constexpr int kSteps = 9;
  for (int i = 0; i < kSteps; ++i) legend.scale.push_back(ScoreColor(i / (kSteps - 1.0)));
  for (const double s : {0.0, 0.5, 1.0}) {
    legend.ticks.emplace_back(s, fmt::format("{:.2f}", low + s * (high - low)));
  }
  return legend;
}

// Shows the contact mesh with a colour for each triangle.
std::shared_ptr<PictureOverlay> ShowMesh(const ContactGraph& graph, const Rgba& color) {
  auto overlay = std::make_shared<PictureOverlay>();
  overlay->forces = false;
  overlay->contact_mesh = std::make_shared<const TriangleMesh>(graph.mesh());
  overlay->face_colors.assign(graph.num_triangles(), color);
  return overlay;
}

// Colours triangles by the best s_c of the nodes that use them and that `shown` holds for.
template <typename Shown>
std::shared_ptr<PictureOverlay> ShowScores(const ContactGraph& graph, Shown shown) {
  std::vector<double> best(graph.num_triangles(), -1.0);
  double highest = 0.0;
  for (const ContactNode& node : graph.nodes()) {
    highest = std::max(highest, node.s_c);
    if (!shown(node)) continue;
    for (const int t : {node.thumb, node.index}) best[t] = std::max(best[t], node.s_c);
  }
  auto overlay = ShowMesh(graph, WithAlpha(NeutralColor(), 1.0F));
  for (int t = 0; t < graph.num_triangles(); ++t) {
    if (best[t] >= 0.0 && highest > 0.0) overlay->face_colors[t] = ScoreColor(best[t] / highest);
  }
  overlay->legend = ScoreLegend("best score here", 0.0, highest);
  return overlay;
}

// Colours the triangles of one contact state by finger.
std::shared_ptr<PictureOverlay> ShowPath(const ContactGraph& graph, const ContactPath& path) {
  auto overlay = ShowMesh(graph, WithAlpha(ObjectColor(), 1.0F));
  for (const int id : path.nodes) {
    const ContactNode& node = graph.nodes().at(id);
    overlay->face_colors[node.thumb] = FingerColor(Finger::kThumb);
    overlay->face_colors[node.index] = FingerColor(Finger::kIndex);
  }
  overlay->legend.swatches = {{FingerColor(Finger::kThumb), "thumb may touch"},
                              {FingerColor(Finger::kIndex), "index may touch"}};
  return overlay;
}

std::shared_ptr<PictureOverlay> ShowRollouts(const MppiState& state) {
  std::vector<const MppiSample*> best;
  for (const MppiSample& sample : state.samples) best.push_back(&sample);
  std::stable_sort(best.begin(), best.end(), [](const MppiSample* a, const MppiSample* b) {
    return a->cost.total < b->cost.total;
  });
  if (best.size() > kGhostsShown) best.resize(kGhostsShown);
  auto overlay = std::make_shared<PictureOverlay>();
  overlay->forces = false;
  const double low = best.front()->cost.total, high = best.back()->cost.total;
  for (const MppiSample* sample : best) {
    const double s = high > low ? (high - sample->cost.total) / (high - low) : 1.0;
    overlay->ghosts.push_back({sample->X_WO_end, WithAlpha(ScoreColor(s), 0.45F)});
  }
  overlay->legend = ScoreLegend("cost", high, low);
  return overlay;
}

void ShowContacts(PictureOverlay& overlay, const std::vector<GraspContact>& contacts) {
  for (const GraspContact& contact : contacts) {
    overlay.touching[static_cast<int>(contact.finger)] = true;
    overlay.legend.swatches.emplace_back(FingerColor(contact.finger), FingerName(contact.finger));
  }
}

void AppendHand(MatrixX3& points, const HandConfiguration& hand) {
  const auto X_WL = CalcLinkPoses(ShadowHand(), hand);
  const Eigen::Index at = points.rows();
  points.conservativeResize(at + kNumHandLinks, 3);
  for (int link = 0; link < kNumHandLinks; ++link) {
    points.row(at + link) = X_WL[link].translation().transpose();
  }
}

// What every picture of a motion shows, so that they have one camera: the hand and the object at
// all keyframes.
MatrixX3 FocusOnMotion(const HandMotion& motion, const MotionState& state) {
  constexpr double kHeadroom = 0.06;  // [m], for the card of text
  MatrixX3 focus_W(0, 3);
  for (const int key : motion.task().keyframes) {
    if (state.frames[key].solved) AppendHand(focus_W, state.frames[key].configuration);
  }
  const Eigen::Index count = focus_W.rows();
  focus_W.conservativeResize(2 * count, 3);
  focus_W.bottomRows(count) =
      focus_W.topRows(count).rowwise() + Vector3(0.0, 0.0, kHeadroom).transpose();
  return focus_W;
}

Json GraspJson(const CompletedGrasp& grasp) {
  Json contacts = Json::array();
  for (const GraspContact& contact : grasp.result.contacts) {
    contacts.push_back({{"finger", FingerName(contact.finger)},
                        {"p_OC", ToJson(contact.p_OC)},
                        {"nhat_O", ToJson(contact.nhat_O)}});
  }
  return {{"status", GraspStatusName(grasp.result.status)},
          {"raw_status", GraspStatusName(grasp.raw.status)},
          {"moved_mm", 1e3 * grasp.moved},
          {"contacts", contacts}};
}

// What the plan does with the fingers: per stage those that are on, with their triangles.
Json StagesJson(const Mppi& mppi, const WorldPlan& plan) {
  Json stages = Json::array();
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    const ContactNode& node = mppi.problem().graph->nodes().at(mppi.problem().path.nodes[i]);
    Json fingers = Json::array(), triangles = Json::array();
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (!plan.stages[i][f].on) continue;
      fingers.push_back(FingerName(static_cast<Finger>(f)));
      triangles.push_back(f == 0 ? node.thumb : node.index);
    }
    stages.push_back({{"fingers", fingers}, {"triangles", triangles}});
  }
  return stages;
}

// Contacts made, lost or moved between stages.
int CountSwitches(const WorldPlan& plan) {
  int switches = 0;
  for (std::size_t i = 1; i < plan.stages.size(); ++i) {
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const bool before = plan.stages[i - 1][f].on, now = plan.stages[i][f].on;
      switches += before != now || (now && !plan.stages[i][f].kept);
    }
  }
  return switches;
}

}  // namespace

PlanRecord::PlanRecord(Session& session, const Planner& planner)
    : session_(session), planner_(planner) {
  SetConfig(planner.config());
}

void PlanRecord::SetStart(const StartCertificate& start) {
  const bool graspable = start.verdict == StartVerdict::kGraspable;
  outcome_.summary["start_grasps"] = {{"tried", start.search.tried},
                                      {"feasible", graspable ? 1 : 0},
                                      {"certified", start.verdict == StartVerdict::kCertified}};
}

void PlanRecord::SetConfig(const PlannerConfig& config) {
  outcome_.configuration = PlannerConfigJson(config);
}

void PlanRecord::AddMesh(const ContactGraph& graph) {
  JournalStep step = session_.MakeStep("graph.mesh", "graph", planner_.start(), {});
  step.record.details = {{"triangles", graph.num_triangles()}, {"nodes", graph.nodes().size()}};
  step.lines = DescribeMesh(graph);
  step.overlay = ShowMesh(graph, WithAlpha(ObjectColor(), 1.0F));
  session_.AddStep(std::move(step));
}

void PlanRecord::AddScores(const ContactGraph& graph) {
  JournalStep step = session_.MakeStep("graph.score", "graph", planner_.start(), {});
  Json s_c = Json::array(), s_n = Json::array();
  for (const ContactNode& node : graph.nodes()) {
    s_c.push_back(node.s_c);
    s_n.push_back(node.s_n);
  }
  step.record.details = {{"s_c", s_c}, {"s_n", s_n}};
  step.lines = DescribeScores(graph);
  step.overlay = ShowScores(graph, [](const ContactNode&) { return true; });
  step.key = true;
  session_.AddStep(std::move(step));
}

void PlanRecord::AddPruning(const ContactGraph& graph) {
  const int number = graph.num_prune_steps();
  PREGRASP_CHECK(number >= 1, number);
  JournalStep step =
      session_.MakeStep(fmt::format("graph.prune.{}", number), "graph", planner_.start(), {});
  Json initial = Json::array(), kept = Json::array();
  for (const ContactNode& node : graph.nodes()) {
    if (node.initial) initial.push_back(node.id);
    if (node.kept) kept.push_back(node.id);
  }
  step.record.details = {{"initial", initial}, {"kept", kept}};
  step.lines = DescribePruning(graph);
  step.overlay = ShowScores(graph, [](const ContactNode& node) { return node.kept; });
  step.key = graph.stage() == GraphStage::kConnected;
  outcome_.summary["counts"]["nodes"] = graph.nodes().size();
  outcome_.summary["counts"]["kept"] = kept.size();
  session_.AddStep(std::move(step));
}

void PlanRecord::AddPath(const ContactGraph& graph, const ContactPath& path) {
  JournalStep step =
      session_.MakeStep(fmt::format("paths.rank.{}", path.rank), "paths", planner_.start(), {});
  step.record.details = {{"nodes", path.nodes}, {"score", path.score}, {"terms", path.terms}};
  step.lines = DescribePath(graph, path);
  step.overlay = ShowPath(graph, path);
  step.key = true;
  session_.AddStep(std::move(step));
  outcome_.summary["counts"]["paths"] = ++num_paths_;
}

void PlanRecord::AddIteration(const Mppi& mppi, const MppiState& state) {
  constexpr int kEvery = 5;
  JournalStep step =
      session_.MakeStep(fmt::format("path.{}.mppi.{}", mppi.problem().path.rank, state.iteration),
                        "path", mppi.problem().start, {});
  Json costs = Json::array();
  for (const MppiSample& sample : state.samples) costs.push_back(sample.cost.total);
  step.record.details = {{"best_cost", state.best_cost},
                         {"mean_cost", state.mean_history.back()},
                         {"converged", state.converged},
                         {"costs", costs}};
  step.lines = DescribeIteration(state);
  step.overlay = ShowRollouts(state);
  step.key = state.iteration == 1 || state.iteration % kEvery == 0 || state.converged;
  session_.AddStep(std::move(step));
  num_rollouts_ += static_cast<long>(state.samples.size());
  outcome_.summary["counts"]["iterations"] = ++num_iterations_;
  outcome_.summary["counts"]["rollouts"] = num_rollouts_;
}

void PlanRecord::AddCertificate(const Mppi& mppi, const Certificate& certificate,
                                const ReleaseResult& release) {
  const TraceRow& last = certificate.trace.back();
  JournalStep step = session_.MakeStep(fmt::format("path.{}.certify", mppi.problem().path.rank),
                                       "path", last.state, last.contacts);
  Json reasons = Json::array();
  for (const CertifyReason reason : certificate.reasons) {
    reasons.push_back(CertifyReasonText(reason));
  }
  step.record.details = {{"certified", certificate.certified},
                         {"reasons", reasons},
                         {"hold_shift_mm", 1e3 * certificate.hold_shift},
                         {"hold_turn_deg", certificate.hold_turn_deg},
                         {"released_shift_mm", 1e3 * release.shift},
                         {"released_turn_deg", release.turn_deg},
                         {"stages", StagesJson(mppi, certificate.full.plan)}};
  step.lines = DescribeCertificate(planner_.scene(), certificate, release);
  step.key = true;
  session_.AddStep(std::move(step));
}

void PlanRecord::AddGrasp(const Certificate& certificate, int path_rank, int sample,
                          const CompletedGrasp& grasp) {
  const TraceRow& last = certificate.trace.back();
  JournalStep step = session_.MakeStep(fmt::format("path.{}.grasp.{}", path_rank, sample + 1),
                                       "path", last.state, last.contacts);
  step.record.details = GraspJson(grasp);
  step.lines = DescribeGrasp(planner_.grasp_world(), grasp);
  auto overlay = std::make_shared<PictureOverlay>();
  ShowContacts(*overlay, grasp.result.contacts);
  if (grasp.result.kinematics) {
    overlay->hand = grasp.result.kinematics->ik.configuration();
    AppendHand(overlay->focus_W, *overlay->hand);
  }
  // In few pictures: one grasp of each path that can be, and one that cannot.
  step.key = grasps_shown_.insert({path_rank, grasp.feasible()}).second;
  step.overlay = overlay;
  session_.AddStep(std::move(step));
}

JournalStep PlanRecord::MakeFrameStep(const std::string& id, const HandMotion& motion,
                                      const MotionState& state, int frame) {
  const MotionFrameTask& task = motion.task().frames.at(frame);
  const MotionFrame& solved = state.frames.at(frame);
  WorldState world_state = planner_.start();
  world_state.t = task.t;
  for (std::size_t i = 0; i < world_state.bodies.size(); ++i) {
    const MovableIndex movable{static_cast<int>(i)};
    const RigidTransform& X_WB = task.X_WB[planner_.world().body_index(movable).value];
    world_state.bodies[i].q_WB = Quaternion(X_WB.linear());
    world_state.bodies[i].p_WB = X_WB.translation();
  }
  JournalStep step = session_.MakeStep(id, "motion", world_state, {});
  step.record.details = {{"phase", MotionPhaseName(task.phase)},
                         {"loosened", LooseningRungName(solved.rung)},
                         {"tip_error_mm", 1e3 * solved.tip_error},
                         {"clearance_mm", 1e3 * solved.clearance}};
  step.lines = DescribeFrame(task, solved);
  auto overlay = std::make_shared<PictureOverlay>();
  overlay->hand = solved.configuration;
  overlay->focus_W = FocusOnMotion(motion, state);
  overlay->forces = false;
  for (int f = 0; f < kNumFingers; ++f) {
    if (!task.contacts[f].on) continue;
    ShowContacts(*overlay,
                 {{static_cast<Finger>(f), task.contacts[f].p_OC, task.contacts[f].nhat_O}});
  }
  step.overlay = overlay;
  return step;
}

void PlanRecord::AddKeyframe(const HandMotion& motion, const MotionState& state, int number) {
  const int frame = motion.task().keyframes.at(number - 1);
  JournalStep step = MakeFrameStep(fmt::format("motion.key.{}", number), motion, state, frame);
  step.key = true;
  session_.AddStep(std::move(step));
}

void PlanRecord::AddFrame(const HandMotion& motion, const MotionState& state, int frame) {
  session_.AddStep(MakeFrameStep(fmt::format("motion.frame.{}", frame + 1), motion, state, frame));
}

void PlanRecord::ChoosePath(const Mppi& mppi, const Certificate& certificate,
                            const ReleaseResult& release, const GraspSet& grasps) {
  outcome_.rollout.clear();
  for (const TraceRow& row : certificate.trace) outcome_.rollout.push_back(row.state);
  Json& summary = outcome_.summary;
  summary["contacts"] = StagesJson(mppi, certificate.full.plan);
  summary["switches"] = CountSwitches(certificate.full.plan);
  summary["physics"]["max_penetration_mm"] = 1e3 * certificate.full.max_penetration;
  if (grasps.grasps.empty()) return;
  summary["r_suc"] = grasps.r_suc();
  summary["r_suc_raw"] = grasps.r_suc_raw();
  summary["grasps"]["tried"] = grasps.grasps.size();
  summary["grasps"]["feasible"] = grasps.feasible.size();
  summary["grasps"]["kept"] =
      FingerNames(release.stays ? std::vector<GraspContact>{} : release.pressing);
}

void PlanRecord::ChooseGrasp(const Certificate& certificate, const CompletedGrasp& grasp,
                             const LiftResult& lift) {
  PREGRASP_CHECK(grasp.feasible());
  const RigidTransform X_WO = certificate.full.end.bodies.front().X_WB();
  const WrenchResult& wrench = *grasp.result.wrench;
  Json forces = Json::array();
  for (std::size_t i = 0; i < grasp.result.contacts.size(); ++i) {
    const GraspContact& contact = grasp.result.contacts[i];
    const Vector3 f_O = wrench.forces.row(static_cast<Eigen::Index>(i)).transpose();
    forces.push_back({{"finger", FingerName(contact.finger)},
                      {"p_WC", ToJson(X_WO * contact.p_OC)},
                      {"nhat_W", ToJson(X_WO.linear() * contact.nhat_O)},
                      {"f_W", ToJson(X_WO.linear() * f_O)}});
  }
  outcome_.summary["grasps"]["fingers"] = FingerNames(grasp.result.contacts);
  outcome_.summary["wrench"] = {{"mu", planner_.scene().fingertips.friction},
                                {"margin", wrench.margin},
                                {"min_normal_N", wrench.min_normal},
                                {"forces", forces}};
  outcome_.summary["lift"] = {
      {"held", lift.held}, {"height_m", lift.height}, {"slip_mm", 1e3 * lift.slip}};
}

void PlanRecord::ChooseMotion(const HandMotion& motion, const MotionState& state) {
  const MotionSummary facts = motion.Summarize(state);
  outcome_.summary["motion"] = {{"frames", facts.frames},
                                {"failed", facts.failed},
                                {"loosened", facts.loosened},
                                {"max_tip_error_mm", 1e3 * facts.max_tip_error},
                                {"min_clearance_mm", 1e3 * facts.min_clearance},
                                {"max_joint_speed", facts.max_joint_speed},
                                {"order", KeyframeOrderName(motion.config().order)}};
  outcome_.motion_table = MotionHeader();
  for (std::size_t i = 0; i < state.frames.size(); ++i) {
    outcome_.motion_table += MotionRow(motion.task().frames[i], state.frames[i]);
  }
}

void PlanRecord::SetNumPaths(int n) {
  outcome_.summary["n_paths"] = n;
  outcome_.summary["n_screened"] = 0;
}

void PlanRecord::Publish() {
  outcome_.summary["seconds"] = seconds_;
  session_.SetOutcome(outcome_);
}

}  // namespace pregrasp
