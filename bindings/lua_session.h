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

/// A function of the script, by its reference in the registry; LUA_NOREF for none.
struct Predicate {
  int reference = LUA_NOREF;
};
template <>
struct LuaValue<Predicate> {
  static Predicate Read(lua_State* L, int index, const std::string& path);
};

/// break_when(f): from now on f sees the events of each physics step of the session's simulations,
/// after each of their actions; the first one that it says yes to is where the action ended.
void SessionBreakWhen(lua_State* L, const std::shared_ptr<Session>& session,
                      const Predicate& predicate);

/// Whether the session has such a function.
bool HasPredicate(lua_State* L, const std::shared_ptr<Session>& session);
/// The first of the simulation's states, from `first` on, where it says yes; none if it never does.
std::optional<int> FindStop(lua_State* L, const std::shared_ptr<Session>& session,
                            const Simulation& simulation, int first);

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

std::vector<const Schema*> SessionSchemas();
std::vector<const Schema*> EventSchemas();
std::vector<const Schema*> SimulationSchemas();
std::vector<const Schema*> GeometrySchemas();

// The geometry calls of a session.
Pushed PushCloud(lua_State* L, Session& session, int points);
Pushed PushDistance(lua_State* L, Session& session, const Vector3& p_W);
void PushMesh(lua_State* L, const TriangleMesh& mesh);
Pushed PushContactMesh(lua_State* L, Session& session, int triangles);

}  // namespace pregrasp
