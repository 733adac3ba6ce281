#include "bindings/lua_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/core/text.h"
#include "app/geometry/contact_mesh.h"
#include "app/job/check.h"
#include "app/page/pair.h"
#include "app/page/strip.h"
#include "app/recording/partial_directory.h"
#include "bindings/lua_planner.h"
#include "bindings/lua_scene.h"
#include "bindings/machine.h"
#include "bindings/script.h"

namespace pregrasp {
namespace {

const Schema kSettleOptions{"SettleOptions", {"seconds"}};
const Schema kSettleResult{
    "SettleResult",
    {"moved_mm", "rotated_deg", "at_rest", "body", "not_converged", "unresolved_mm"}};
const Schema kVerdict{"Verdict", {"verdict", "mu", "mu_star", "thin", "sentence", "step_id"}};
const Schema kSimulateOptions{"SimulateOptions", {"trace"}};
const Schema kRecordOptions{"RecordOptions", {"dir", "pictures"}};
const Schema kShotOptions{"ShotOptions",
                          {"caption", "camera", "size", "quality", "overlay", "file", "card",
                           "legend", "footer", "font_scale"}};
const Schema kStripOptions{
    "StripOptions",
    {"against", "file", "camera", "size", "quality", "overlay", "legend", "font_scale"}};
const Schema kBody{"Body", {"name", "movable", "p", "q", "rpy_deg", "v", "w"}};
const Schema kCloudOptions{"CloudOptions", {"points"}};
const Schema kMeshOptions{"MeshOptions", {"triangles"}};

const Schema kCheck{"Check", {"text", "clean", "findings"}};
const Schema kFinding{"Finding", {"severity", "where", "text"}};

const char* SeverityOf(const CheckFinding& finding) {
  constexpr const char* kNames[] = {"note", "warning", "error"};
  return kNames[static_cast<int>(finding.severity)];
}

// Roll, pitch and yaw about the fixed axes, the inverse of RotationFromRpy [deg].
Vector3 CalcRpyDeg(const Matrix3& R) {
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  return Vector3(std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))) * (180.0 / kPi);
}

void RequirePng(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".png") return;
  throw InputError("", "file", "the name of a picture, \"out/NAME.png\"",
                   '"' + OneLine(file) + '"');
}

}  // namespace

std::filesystem::path PictureFile(lua_State* L, const std::string& file) {
  RequirePng(file);
  const std::filesystem::path path = Machine::Of(L).files().ResolveForWriting(file);
  RequireOutsideRuns(path);
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  return path;
}

void ReadPicture(lua_State* L, const Fields& fields, PictureConfig& picture) {
  if (fields.Has("camera")) picture.camera = ReadCamera(L, fields, "camera");
  if (const auto size = fields.Find<std::vector<int>>("size")) {
    if (size->size() != 2) fields.Refuse("size", "{width, height} in pixels");
    picture.width = (*size)[0];
    picture.height = (*size)[1];
  }
  if (const auto quality = fields.Find<std::string>("quality")) {
    picture.quality = ParseQuality(*quality);
  }
  if (const auto overlays = fields.Find<std::vector<std::string>>("overlay")) {
    SetOverlays(picture, *overlays);
  }
  picture.legend = fields.Optional<bool>("legend", true);
  picture.font_scale = fields.Optional<double>("font_scale", 1.0);
  RequireWithin("", "font_scale", PictureConfig::kFontScale, picture.font_scale);
}

void ReadStrip(lua_State* L, const Fields& fields, Shot& shot, std::string& file) {
  shot.config.width = 1920;
  shot.config.height = 1440;
  ReadPicture(L, fields, shot.config);
  shot.config.Validate();
  const auto name = fields.Find<std::string>("file");
  if (!name) fields.Refuse("file", kWhereTo);
  file = *name;
}

ShotOptions LuaValue<ShotOptions>::Read(lua_State* L, int index, const std::string& /*path*/) {
  const Fields fields(L, index, kShotOptions, "", "", 1);
  ShotOptions options;
  options.shot.config.trace = true;
  ReadPicture(L, fields, options.shot.config);
  options.shot.title = fields.Positional<std::optional<std::string>>(1, "title").value_or("");
  options.shot.caption = fields.Optional<std::string>("caption", "");
  options.file = fields.Find<std::string>("file");
  options.shot.config.card = fields.Optional<bool>("card", true);
  options.shot.config.footer = fields.Optional<bool>("footer", true);
  return options;
}

void TakeShot(lua_State* L, Session& session, const Timeline::Node& node,
              const ShotOptions& options) {
  if (options.file) {
    RequirePng(*options.file);
    session.ShootToFile(node, options.shot,
                        Machine::Of(L).files().ResolveForWriting(*options.file));
  } else {
    session.Shoot(node, options.shot);
  }
}

void PushBody(lua_State* L, const World& world, const WorldState& state, int index) {
  const Body& body = world.scene().bodies[index];
  const RigidTransform X_WB = world.GetPoses(state)[index];
  const MovableIndex movable = world.movable_index(BodyIndex{index});
  const BodyState motion = movable.is_none() ? BodyState{} : state.bodies[movable.value];
  RecordWriter(L, kBody)
      .Set("name", body.name)
      .Set("movable", body.movable())
      .Set("p", Vector3(X_WB.translation()))
      .Set("q", Quaternion(X_WB.linear()))
      .Set("rpy_deg", CalcRpyDeg(X_WB.linear()))
      .Set("v", motion.v_WB)
      .Set("w", motion.w_WB);
}

Pushed PushCheck(lua_State* L, const Scene& scene) {
  const std::vector<CheckFinding> findings = CheckScene(scene);
  std::string text;
  for (const CheckFinding& finding : findings) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", SeverityOf(finding), finding.message);
  }
  const bool clean = std::all_of(findings.begin(), findings.end(), [](const CheckFinding& finding) {
    return finding.severity == CheckFinding::Severity::kNote;
  });
  RecordWriter record(L, kCheck);
  record.Set("text", text.empty() ? std::string("clean: at rest, no overlaps") : text)
      .Set("clean", clean);
  lua_createtable(L, static_cast<int>(findings.size()), 0);
  for (std::size_t i = 0; i < findings.size(); ++i) {
    RecordWriter(L, kFinding)
        .Set("severity", SeverityOf(findings[i]))
        .Set("where", findings[i].where)
        .Set("text", findings[i].message);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  record.SetTop("findings");
  return {1};
}

int FindBody(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return static_cast<int>(i);
    names.push_back(scene.bodies[i].name);
  }
  throw InputError("", "name", "a body of the scene",
                   '"' + name + '"' + FormatHint(FindNearest(name, names)));
}

void CountMemory(lua_State* L, int kibibytes) { lua_gc(L, LUA_GCSTEP, kibibytes); }

void CountSteps(lua_State* L, Session& session) {
  MemoryClaim& claim = session.steps_claim();
  const std::size_t before = claim.bytes(), now = session.timeline().held_bytes();
  if (now == before) return;
  claim = MemoryClaim();
  claim = MemoryClaim(Machine::Of(L).outside(), now);
  if (now < before) return;
  CountMemory(L, static_cast<int>((now - before) >> 10U));
  Machine::Of(L).RequireMemory(L, 0);
}

namespace {

struct SettleOptions {
  double seconds = 1.0;
};
struct SimulateOptions {
  bool trace = false;
};
struct RecordOptions {
  std::string directory;
  PictureMode pictures = PictureMode::kKey;
};
// An id of the session's, or an object.
struct StripEntry {
  std::string id;
  std::optional<AnyPlace> place;
};
struct StripOptions {
  std::vector<StripEntry> entries;
  std::optional<AnyPlace> against;
  Shot shot;
  std::string file;
};
struct CloudOptions {
  int points = 512;
};
struct MeshOptions {
  int triangles = ContactMeshConfig{}.triangles;
};

}  // namespace

template <>
struct LuaValue<SettleOptions> {
  static SettleOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    return {Fields(L, index, kSettleOptions).Optional<double>("seconds", 1.0)};
  }
};

template <>
struct LuaValue<SimulateOptions> {
  static SimulateOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    return {Fields(L, index, kSimulateOptions).Optional<bool>("trace", false)};
  }
};

template <>
struct LuaValue<RecordOptions> {
  static RecordOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kRecordOptions);
    return {fields.Required<std::string>("dir"),
            ParsePictureMode(fields.Optional<std::string>("pictures", "key"), "", "pictures")};
  }
};

template <>
struct LuaValue<StripEntry> {
  static StripEntry Read(lua_State* L, int index, const std::string& path) {
    if (lua_type(L, index) == LUA_TSTRING) {
      return {LuaValue<std::string>::Read(L, index, path), std::nullopt};
    }
    return {"", LuaValue<AnyPlace>::Read(L, index, path)};
  }
};

template <>
struct LuaValue<StripOptions> {
  static StripOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    const Fields fields(L, index, kStripOptions, "", "", kMostOfAStrip);
    StripOptions options;
    ReadStrip(L, fields, options.shot, options.file);
    options.against = fields.Find<AnyPlace>("against");
    for (int i = 1;; ++i) {
      const auto entry =
          fields.Positional<std::optional<StripEntry>>(i, "[" + std::to_string(i) + "]");
      if (!entry) return options;
      options.entries.push_back(*entry);
    }
  }
};

template <>
struct LuaValue<CloudOptions> {
  static CloudOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    return {Fields(L, index, kCloudOptions).Optional<int>("points", CloudOptions{}.points)};
  }
};

template <>
struct LuaValue<MeshOptions> {
  static MeshOptions Read(lua_State* L, int index, const std::string& /*path*/) {
    return {Fields(L, index, kMeshOptions).Optional<int>("triangles", MeshOptions{}.triangles)};
  }
};

namespace {

// Methods.

Pushed SessionSettle(lua_State* L, Session& session, const SettleOptions& options) {
  const auto& result = std::get<SettleFacts>(session.Settle(options.seconds).facts.details);
  CountSteps(L, session);
  RecordWriter(L, kSettleResult)
      .Set("moved_mm", result.moved_mm)
      .Set("rotated_deg", result.rotated_deg)
      .Set("at_rest", result.at_rest)
      .Set("body", result.body)
      .Set("not_converged", result.not_converged)
      .Set("unresolved_mm", result.unresolved_mm);
  return {1};
}

// Whether the object can be grasped where it stands.
Pushed SessionVerdict(lua_State* L, Session& session) {
  const Timeline::Node& node = session.timeline().Do(session.timeline().root(), Verb::kVerdict);
  const auto& verdict = std::get<VerdictFacts>(node.facts.details);
  CountSteps(L, session);
  RecordWriter(L, kVerdict)
      .Set("verdict", verdict.verdict)
      .Set("mu", verdict.mu)
      .Set("mu_star", verdict.mu_star)
      .Set("thin", verdict.thin)
      .Set("sentence", verdict.sentence)
      .Set("step_id", node.id());
  return {1};
}

Pushed SessionSimulate(lua_State* L, const std::shared_ptr<Session>& session,
                       const SimulateOptions& options) {
  PushObject(
      L, std::make_shared<LuaSimulation>(LuaSimulation{session, &session->start(), options.trace}));
  return {1};
}

void SessionRecord(lua_State* L, const std::shared_ptr<Session>& session,
                   const RecordOptions& options) {
  session->Record(Machine::Of(L).files().ResolveForWriting(options.directory), options.pictures);
  ScriptContext::Of(L).recording.push_back(session);
}

std::string SessionSave(lua_State* L, Session& session, const std::optional<std::string>& dir) {
  std::optional<std::filesystem::path> directory;
  if (dir) directory = Machine::Of(L).files().ResolveForWriting(*dir);
  return session.Save(directory).string();
}

void SessionShot(lua_State* L, Session& session, const ShotOptions& options) {
  TakeShot(L, session, session.timeline().last(), options);
}

// Steps side by side, the key ones where none are named; with `against` what led to one of them
// beside what led to the other.
void SessionStrip(lua_State* L, const std::shared_ptr<Session>& session,
                  const StripOptions& options) {
  const Timeline& timeline = session->timeline();
  std::vector<AnyPlace> places;
  for (const StripEntry& entry : options.entries) {
    places.push_back(entry.place ? *entry.place : AnyPlace{session, &timeline.Find(entry.id)});
  }
  const bool all = places.empty() && !options.against;
  if (places.empty()) places.push_back({session, &timeline.last()});
  if (options.against && places.size() > 1) {
    throw InputError("", "against", "one step to set it against",
                     fmt::format("{} steps", places.size()));
  }
  const std::filesystem::path file = PictureFile(L, options.file);
  if (session->config().pictures == PictureMode::kNone) return;
  const auto end_of = [](const AnyPlace& place) {
    return BranchEnd{place.session->timeline(), *place.node, place.session->drawer()};
  };
  if (options.against) {
    WritePng(DrawPairOfBranches(end_of(places[0]), end_of(*options.against), options.shot), file);
    return;
  }
  if (all) {
    std::vector<const StepFacts*> done;
    for (const auto& node : timeline.nodes()) done.push_back(&node->facts);
    const RunSteps steps(std::move(done), timeline.last().facts, timeline);
    const std::optional<Vector3> view;
    WritePng(DrawContactSheet(steps, timeline, session->drawer(), options.shot, view), file);
    return;
  }
  std::vector<StripStep> steps;
  for (const AnyPlace& place : places) {
    steps.push_back({&place.node->facts, &place.session->timeline(), &place.session->drawer()});
  }
  WritePng(DrawStrip(steps, options.shot, std::nullopt), file);
}

Pushed SessionBody(lua_State* L, Session& session, const std::string& name) {
  PushBody(L, session.world(), session.GetStart(), FindBody(session.scene(), name));
  return {1};
}

Pushed SessionCloud(lua_State* L, Session& session, const CloudOptions& options) {
  return PushCloud(L, session, options.points);
}

Pushed SessionCheck(lua_State* L, Session& session) { return PushCheck(L, session.scene()); }

Pushed SessionMesh(lua_State* L, Session& session, const MeshOptions& options) {
  return PushContactMesh(L, session, options.triangles);
}

// Properties.

std::string SessionName(Session& session) { return session.scene().name; }
std::string SessionFile(Session& session) { return session.scene().file; }
std::int64_t SessionSeed(Session& session) {
  return static_cast<std::int64_t>(session.config().seed);
}
double SessionDt(Session& session) { return session.world().config().dt; }
std::string SessionStepId(Session& session) { return session.timeline().last().id(); }
std::vector<std::string> SessionDepartures(Session& session) {
  return RuleDepartures(session.scene());
}
std::vector<std::string> SessionBodies(Session& session) {
  std::vector<std::string> names;
  for (const Body& body : session.scene().bodies) names.push_back(body.name);
  return names;
}
Pushed SessionObject(lua_State* L, Session& session) {
  PushBody(L, session.world(), session.GetStart(), 0);
  return {1};
}

int SessionToString(lua_State* L) {
  const auto session = FindObject<Session>(L, 1);
  lua_pushfstring(L, "Session(%s)", session ? session->scene().name.c_str() : "?");
  return 1;
}

}  // namespace

const ClassInfo& SessionClass() {
  static const ClassInfo info{"Session",
                              {
                                  Method<&SessionSettle>("settle", "options"),
                                  Method<&SessionVerdict>("verdict"),
                                  Method<&SessionSimulate>("simulate", "options"),
                                  Method<&SessionRecord>("record", "options"),
                                  Query<&SessionBreakWhen>("break_when", "predicate"),
                                  Method<&SessionShot>("shot", "options"),
                                  Method<&SessionStrip>("strip", "options"),
                                  Method<&SessionSave>("save", "dir"),
                                  Query<&SessionBody>("body", "name"),
                                  Query<&SessionCloud>("cloud", "options"),
                                  Query<&PushDistance>("distance", "point"),
                                  Query<&SessionMesh>("mesh", "options"),
                                  Method<&SessionGraph>("graph", "options"),
                                  Method<&SessionPlan>("plan", "options"),
                                  Method<&SessionWhatIf>("what_if", "options"),
                                  Method<&SessionGo>("go", "id"),
                                  Query<&SessionStep>("step", "id"),
                                  Query<&SessionWhy>("why"),
                                  Query<&SessionWhyNot>("why_not", "path"),
                                  Query<&SessionCheck>("check"),
                                  Method<&SessionSaveState>("save_state", "dir, at"),
                              },
                              {
                                  Property<&SessionName>("name"),
                                  Property<&SessionFile>("file"),
                                  Property<&SessionSeed>("seed"),
                                  Property<&SessionDt>("dt"),
                                  Property<&SessionStepId>("step_id"),
                                  Property<&SessionIds>("ids"),
                                  Property<&SessionStopped>("stopped"),
                                  Property<&SessionBodies>("bodies"),
                                  Property<&SessionObject>("object"),
                                  Property<&SessionDepartures>("departures"),
                              },
                              SessionToString};
  return info;
}

std::vector<const Schema*> SessionSchemas() {
  return {&kSettleOptions, &kSettleResult, &kVerdict,      &kSimulateOptions,
          &kRecordOptions, &kShotOptions,  &kStripOptions, &kBody,
          &kCloudOptions,  &kMeshOptions,  &kCheck,        &kFinding};
}

}  // namespace pregrasp
