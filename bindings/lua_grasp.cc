#include "bindings/lua_grasp.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "app/grasp/wrench.h"
#include "app/hand/ik.h"
#include "app/job/planner_settings.h"
#include "bindings/lua_session.h"
#include "bindings/machine.h"

namespace pregrasp {
namespace {

const Schema kWrenchOptions{"WrenchOptions",
                            {"p", "n", "mu", "mass", "gravity", "f_min", "f_max", "torque_scale"}};
const Schema kWrenchResult{
    "WrenchResult", {"feasible", "closed", "margin", "min_normal", "forces", "status", "residual"}};
const Schema kIkOptions{"IkOptions", {"contacts", "scene", "hand", "seed", "max_starts", "near"}};
const Schema kIkContacts{"IkContacts", {"thumb", "index", "middle", "ring", "little"}};
const Schema kIkContact{"IkContact", {"p", "n"}};
const Schema kTransform{"Transform", {"p", "q"}};
const Schema kGraspContact{"GraspContact", {"finger", "p_OC", "nhat_O"}};
const Schema kIkResult{
    "IkResult",
    {"status", "solved", "X_WH", "q", "tip_error", "cone_angle", "clearance", "starts", "method"}};

// A hand's joints by name; of hands that FindHand keeps.
const Schema& JointSchema(const HandModel& hand) {
  static std::mutex mutex;
  static std::map<const HandModel*, Schema> schemas;
  const std::lock_guard lock(mutex);
  const auto known = schemas.find(&hand);
  if (known != schemas.end()) return known->second;
  std::vector<std::string> names;
  for (int j = 0; j < hand.num_joints; ++j) names.push_back(hand.joints[j].name);
  return schemas.emplace(&hand, Schema{"HandJoints", std::move(names)}).first->second;
}

MatrixX3 ToMatrix(const std::vector<Vector3>& rows) {
  MatrixX3 matrix(static_cast<Eigen::Index>(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) matrix.row(static_cast<Eigen::Index>(i)) = rows[i];
  return matrix;
}

}  // namespace

// What wrench{..} takes.
struct WrenchOptions {
  std::vector<WrenchContact> contacts;
  WrenchConfig config;
};
template <>
struct LuaValue<WrenchOptions> {
  static WrenchOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kWrenchOptions);
    WrenchOptions options;
    options.contacts = MakeWrenchContacts(ToMatrix(fields.Required<std::vector<Vector3>>("p")),
                                          ToMatrix(fields.Required<std::vector<Vector3>>("n")));
    WrenchConfig& config = options.config;
    config.mu = fields.Optional("mu", config.mu);
    config.mass = fields.Optional("mass", config.mass);
    config.gravity = fields.Optional("gravity", config.gravity);
    config.f_min = fields.Optional("f_min", config.f_min);
    config.f_max = fields.Optional("f_max", config.f_max);
    config.torque_scale = fields.Optional("torque_scale", config.torque_scale);
    return options;
  }
};

// What ik{..} takes.
struct IkOptions {
  std::vector<IkContact> contacts;  // nhat_W as given
  std::shared_ptr<Session> session;
  std::int64_t seed = 1;
  int max_starts = IkConfig{}.max_starts;
  const HandModel* hand = nullptr;
  std::optional<HandConfiguration> near;
};
template <>
struct LuaValue<RigidTransform> {
  static RigidTransform Read(lua_State* L, int index, const std::string& path) {
    const Fields fields(L, index, kTransform, path + ".");
    const auto wxyz = fields.Required<std::vector<double>>("q");
    if (wxyz.size() != 4) fields.Refuse("q", "a quaternion {w, x, y, z}");
    const Quaternion q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    if (!(std::abs(q.norm() - 1.0) < 1e-6)) fields.Refuse("q", "a quaternion of length 1");
    return MakeTransform(q.normalized(), fields.Required<Vector3>("p"));
  }
};
template <>
struct LuaValue<IkContact> {
  static IkContact Read(lua_State* L, int index, const std::string& path) {
    const Fields fields(L, index, kIkContact, path + ".");
    IkContact contact;
    contact.p_WC = fields.Required<Vector3>("p");
    contact.nhat_W = fields.Required<Vector3>("n");
    if (!(contact.nhat_W.norm() > 1e-9)) fields.Refuse("n", "a direction of length above 0");
    contact.nhat_W.normalize();
    return contact;
  }
};
// Of an IkResult, or of another table with the same X_WH and q.
static HandConfiguration ReadConfiguration(lua_State* L, const Fields& of, const char* key,
                                           const HandModel& hand) {
  of.Push(key);
  const std::string path = key;
  if (!lua_istable(L, -1)) of.Refuse(key, "a table with X_WH and q, as ik gives");
  const Fields fields(L, lua_gettop(L), kIkResult, path + ".");
  HandConfiguration configuration;
  configuration.X_WH = fields.Required<RigidTransform>("X_WH");
  fields.Push("q");
  if (!lua_istable(L, -1)) fields.Refuse("q", "a table of joint angles by name");
  const Fields joints(L, lua_gettop(L), JointSchema(hand), path + ".q.");
  for (int j = 0; j < hand.num_joints; ++j) {
    configuration.q[j] = joints.Required<double>(hand.joints[j].name);
  }
  lua_pop(L, 2);
  return configuration;
}
template <>
struct LuaValue<IkOptions> {
  static IkOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kIkOptions);
    IkOptions options;
    if (fields.Has("scene")) options.session = fields.Required<std::shared_ptr<Session>>("scene");
    if (fields.Has("hand")) {
      if (options.session) fields.Refuse("hand", "no hand beside a scene, which has its own");
      auto hand = fields.Required<std::string>("hand");
      if (IsHandFile(hand)) hand = Machine::Of(L).files().FindForReading(hand).string();
      options.hand = &FindHand(hand);
    } else {
      options.hand = options.session ? &options.session->job().hand() : &FindHand(kDefaultHand);
    }
    fields.Push("contacts");
    if (!lua_istable(L, -1)) fields.Refuse("contacts", "a table of contacts by finger");
    const Fields by_finger(L, lua_gettop(L), kIkContacts, "contacts.");
    for (int f = 0; f < kNumFingers; ++f) {
      if (!by_finger.Has(kFingerNames[f])) continue;
      if (f >= options.hand->num_fingers) {
        fields.Refuse("contacts", fmt::format("fingers of the hand, of which it has {}",
                                              options.hand->num_fingers));
      }
      options.contacts.push_back(by_finger.Required<IkContact>(kFingerNames[f]));
      options.contacts.back().finger = static_cast<Finger>(f);
    }
    lua_pop(L, 1);
    if (options.contacts.empty()) fields.Refuse("contacts", "at least one contact");
    options.seed = fields.Optional<std::int64_t>("seed", options.seed);
    options.max_starts = fields.Optional("max_starts", options.max_starts);
    if (fields.Has("near")) options.near = ReadConfiguration(L, fields, "near", *options.hand);
    return options;
  }
};

namespace {

Pushed Wrench(lua_State* L, const WrenchOptions& options) {
  PushWrench(L, CalcWrench(options.contacts, options.config));
  return {1};
}

// The scene's object says which side of a contact is outside; without a scene, normals point into
// the object, as in wrench{..}.
void TurnNormalsOutward(const Session* session, std::vector<IkContact>& contacts) {
  if (session == nullptr) {
    for (IkContact& contact : contacts) contact.nhat_W = -contact.nhat_W;
    return;
  }
  const RigidTransform X_WO = session->GetStart().bodies.front().X_WB();
  const SignedDistance object(session->scene().object().shape);
  for (IkContact& contact : contacts) {
    Vector3 nhat_O;
    object.Project(X_WO.inverse() * contact.p_WC, &nhat_O);
    if (contact.nhat_W.dot(X_WO.linear() * nhat_O) < 0.0) contact.nhat_W = -contact.nhat_W;
  }
}

Pushed Ik(lua_State* L, IkOptions& options) {
  IkConfig config;
  RequireWithin("", "max_starts", FindPlannerSetting("grasps.starts").range, options.max_starts);
  config.max_starts = options.max_starts;
  config.Validate();
  TurnNormalsOutward(options.session.get(), options.contacts);
  IkProblem problem;
  problem.contacts = options.contacts;
  problem.warm_start = problem.reference = options.near;
  const Rng rng(static_cast<std::uint64_t>(options.seed), RngStream::kScriptIk);
  IkResult result;
  if (options.session) {
    Session& session = *options.session;
    problem.X_WB = session.world().GetPoses(session.GetStart());
    result = IkSolver(*options.hand, session.scene()).Solve(config, problem, rng);
  } else {
    result = IkSolver(*options.hand).Solve(config, problem, rng);
  }
  PushIk(L, *options.hand, result);
  return {1};
}

}  // namespace

void PushWrench(lua_State* L, const WrenchResult& result) {
  RecordWriter(L, kWrenchResult)
      .Set("feasible", result.feasible())
      .Set("closed", result.closed)
      .Set("margin", result.margin)
      .Set("min_normal", result.min_normal)
      .Set("forces", result.forces)
      .Set("status", WrenchStatusName(result.status))
      .Set("residual", result.residual);
}

void PushTransform(lua_State* L, const RigidTransform& X) {
  RecordWriter(L, kTransform).Set("p", Vector3(X.translation())).Set("q", Quaternion(X.linear()));
}

void PushJoints(lua_State* L, const HandModel& hand, const HandJoints& q) {
  RecordWriter joints(L, JointSchema(hand));
  for (int j = 0; j < hand.num_joints; ++j) joints.Set(hand.joints[j].name, double(q[j]));
}

void PushIk(lua_State* L, const HandModel& hand, const IkResult& result) {
  RecordWriter record(L, kIkResult);
  record.Set("status", IkStatusName(result.status))
      .Set("solved", result.solved())
      .Set("tip_error", result.tip_error)
      .Set("cone_angle", result.cone_angle)
      .Set("clearance", result.clearance)
      .Set("starts", result.starts)
      .Set("method", IkMethodName(result.method));
  PushJoints(L, hand, result.q);
  record.SetTop("q");
  PushTransform(L, result.X_WH);
  record.SetTop("X_WH");
}

void PushGraspContacts(lua_State* L, const std::vector<GraspContact>& contacts) {
  lua_createtable(L, static_cast<int>(contacts.size()), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    RecordWriter(L, kGraspContact)
        .Set("finger", contacts[i].finger)
        .Set("p_OC", contacts[i].p_OC)
        .Set("nhat_O", contacts[i].nhat_O);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
}

const std::vector<FunctionInfo>& GraspFunctions() {
  static const std::vector<FunctionInfo> functions = {Function<&Wrench>("wrench", "options"),
                                                      Function<&Ik>("ik", "options")};
  return functions;
}

std::vector<const Schema*> GraspSchemas() {
  return {&kWrenchOptions, &kWrenchResult, &kIkOptions, &kIkContacts,
          &kIkContact,     &kTransform,    &kIkResult,  &JointSchema(ShadowHand()),
          &kGraspContact};
}

}  // namespace pregrasp
