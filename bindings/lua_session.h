#pragma once

#include <memory>
#include <optional>

#include "app/session/session.h"
#include "bindings/function.h"

namespace pregrasp {

/// A simulation as a script holds it: a cursor into its session's timeline.
struct LuaSimulation {
  std::shared_ptr<Session> session;
  const Timeline::Node* node = nullptr;
  bool traced = false;
  const Timeline::Node* ahead =
      nullptr;  ///< where it was when it first went back; null: it is there

  /// As it is at the cursor.
  std::shared_ptr<const Simulation> simulation() const;
};

const ClassInfo& SessionClass();
const ClassInfo& SimulationClass();

template <>
struct LuaClass<Session> {
  static const ClassInfo& info() { return SessionClass(); }
  static const Session* session(const Session& object) { return &object; }
};
template <>
struct LuaClass<LuaSimulation> {
  static const ClassInfo& info() { return SimulationClass(); }
  static const Session* session(const LuaSimulation& object) { return object.session.get(); }
};

/// What break_when takes: a function of the script, by its reference in the registry (LUA_NOREF for
/// none), or names of ready-made conditions.
struct Predicate {
  int reference = LUA_NOREF;
  std::vector<std::string> conditions;
};
template <>
struct LuaValue<Predicate> {
  static Predicate Read(lua_State* L, int index, const std::string& path);
};

/// break_when(f): from now on f sees the events of each physics step of the session's simulations,
/// after each of their actions; the first one that it says yes to is where the action ended.
void SessionBreakWhen(lua_State* L, const std::shared_ptr<Session>& session,
                      const Predicate& predicate);

/// Whether something is asked of the session's steps.
bool HasPredicate(lua_State* L, const std::shared_ptr<Session>& session);
/// The first of the simulation's states, from `first` on, where it says yes; none if it never does.
std::optional<int> FindStop(lua_State* L, const std::shared_ptr<Session>& session,
                            const Simulation& simulation, int first);
/// Asks it about a step of the planner that was just done; of a certificate, about its physics
/// steps first. @returns whether it says yes.
bool StopsAt(lua_State* L, const std::shared_ptr<Session>& session, const Timeline::Node& node);

/// stopped: what break_when last said yes to; nil.
Pushed SessionStopped(lua_State* L, const std::shared_ptr<Session>& session);

/// While this lives, the session stands still: methods of its objects that change it are refused.
class StandStill {
 public:
  StandStill(lua_State* L, const Session* session);
  ~StandStill();
  StandStill(const StandStill&) = delete;
  StandStill& operator=(const StandStill&) = delete;

 private:
  lua_State* L_;
};

/// Calls the function below the value on top with it, as the script's own code; takes both off.
/// @returns whether it said yes.
bool AskFunction(lua_State* L);

/// Reads what a picture shows, from the fields that shot{..} and strip{..} share.
void ReadPicture(lua_State* L, const Fields& fields, PictureConfig& picture);
/// Where a picture goes that belongs to no run: what `file` names, in a folder that is there.
/// @throws InputError for a place among a run's files.
std::filesystem::path PictureFile(lua_State* L, const std::string& file);

/// What is asked for where the file of a picture is missing.
inline constexpr const char* kWhereTo = "where the picture goes, as \"out/picture.png\"";
/// The most steps of a strip, which are its list's entries.
inline constexpr int kMostOfAStrip = 64;
/// What strip{..} has besides: size, and where it goes.
void ReadStrip(lua_State* L, const Fields& fields, Shot& shot, std::string& file);

/// What shot{..} takes.
struct ShotOptions {
  Shot shot;
  std::optional<std::string> file;
};
template <>
struct LuaValue<ShotOptions> {
  static ShotOptions Read(lua_State* L, int index, const std::string& path);
};

/// Takes the picture of a step, for the run or for a file of its own.
void TakeShot(lua_State* L, Session& session, const Timeline::Node& node,
              const ShotOptions& options);

/// Pushes where a body is and how it moves. @param index  of the scene.
void PushBody(lua_State* L, const World& world, const WorldState& state, int index);

/// The scene's index of a body. @throws InputError with the nearest name.
int FindBody(const Scene& scene, const std::string& name);

/// Tells Lua's collector of memory of ours that a new object or step holds [KiB].
void CountMemory(lua_State* L, int kibibytes);
/// The same for what the session holds until it ends: it counts toward the script's memory.
/// @throws std::bad_alloc beyond the script's cap.
void CountMemory(lua_State* L, Session& session, int kibibytes);
/// Counts what the session's timeline holds now, in place of what it held when this was last
/// called. For whatever does steps of the planner. @throws std::bad_alloc beyond the script's cap.
void CountSteps(lua_State* L, Session& session);

/// What check says of a scene.
Pushed PushCheck(lua_State* L, const Scene& scene);

std::vector<const Schema*> SessionSchemas();
std::vector<const Schema*> EventSchemas();
std::vector<const Schema*> SimulationSchemas();
std::vector<const Schema*> GeometrySchemas();

// The geometry calls of a session.
Pushed PushCloud(lua_State* L, Session& session, int points);
Pushed PushDistance(lua_State* L, Session& session, const Vector3& p_W);
void PushMesh(lua_State* L, const std::shared_ptr<const TriangleMesh>& mesh);
/// A triangle of a contact mesh.
struct TriangleShape {
  Vector3 p_OCentre, nhat_O;  ///< its outward normal
  double area = 0.0;          ///< [m^2]
};
TriangleShape CalcTriangleShape(const TriangleMesh& mesh, int triangle);
Pushed PushContactMesh(lua_State* L, Session& session, int triangles);

}  // namespace pregrasp
