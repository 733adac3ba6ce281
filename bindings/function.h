#pragma once

#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "app/core/error.h"
#include "app/core/lua_api.h"
#include "app/core/memory_claim.h"
#include "bindings/machine.h"
#include "bindings/schema.h"
#include "bindings/value.h"

namespace pregrasp {

class Session;

/// Specialised for each C++ class that Lua holds: `static const ClassInfo& info()`, and `static
/// const Session* session(const T&)`, the session that a method of the object acts on; null for
/// none.
template <typename T>
struct LuaClass;

namespace internal {

/// What the userdata of an object holds.
template <typename T>
struct Holder {
  std::shared_ptr<T> object;
  MemoryClaim claim;
};

/// What an object costs beside its own size: the control block that shares it, and malloc's share
/// [bytes].
inline constexpr std::size_t kSharing = 64;

}  // namespace internal

/// Pushes an object that Lua shares with us; it is let go when Lua collects it. What is left of it
/// then is a closed object (CloseObject): a weak table may give it to the script once more.
template <typename T>
void PushObject(lua_State* L, std::shared_ptr<T> object) {
  using Holder = internal::Holder<T>;
  MemoryClaim claim = ClaimMemory(L, sizeof(T) + internal::kSharing);
  void* memory = lua_newuserdatauv(L, sizeof(Holder), 0);
  PushClassMetatable(L, LuaClass<T>::info(), [](lua_State* state) {
    static_cast<Holder*>(lua_touserdata(state, 1))->~Holder();
    CloseObject(state, 1);
    return 0;
  });
  new (memory) Holder{std::move(object), std::move(claim)};
  lua_setmetatable(L, -2);
}

/// The object at `index`, or null when it is something else or closed.
template <typename T>
std::shared_ptr<T> FindObject(lua_State* L, int index) {
  auto* holder = static_cast<internal::Holder<T>*>(TestClass(L, index, LuaClass<T>::info()));
  return holder == nullptr ? nullptr : holder->object;
}

template <typename T>
struct LuaValue<std::shared_ptr<T>> {
  static std::shared_ptr<T> Read(lua_State* L, int index, const std::string& path) {
    std::shared_ptr<T> object = FindObject<T>(L, index);
    if (!object)
      throw InputError("", path, WithArticle(LuaClass<T>::info().name), DescribeValue(L, index));
    return object;
  }
  static void Push(lua_State* L, std::shared_ptr<T> object) { PushObject(L, std::move(object)); }
};

/// @throws InputError while the session's break_when function is asked: everything stands still
/// then.
void RequireNotAsking(lua_State* L, const Session* session);

/// What a bound function returns that pushed its results itself.
struct Pushed {
  int count = 0;
};

namespace internal {

/// The name of parameter `number`, 1-based, of "a, b, c".
std::string ParameterName(const FunctionInfo& function, int number);
[[noreturn]] void ThrowTooMany(const FunctionInfo& function, int got);

/// Throws for a method that got something else than its object: most often after a dot.
[[noreturn]] void ThrowNoSelf(lua_State* L, int index, const FunctionInfo& function,
                              const std::string& class_name);

template <typename T>
inline constexpr const ClassInfo* (*kClassOfShared)() = nullptr;
template <typename T>
inline constexpr const ClassInfo* (*kClassOfShared<std::shared_ptr<T>>)() =
    [] { return &LuaClass<T>::info(); };

/// Reads one C++ parameter, moving `index` past what it took.
template <typename T>
struct Parameter {
  using Stored = std::decay_t<T>;
  static Stored Read(lua_State* L, int& index, const FunctionInfo& function, int first) {
    if (index < first && kClassOfShared<Stored> != nullptr &&
        TestClass(L, index, *kClassOfShared<Stored>()) == nullptr) {
      ThrowNoSelf(L, index, function, kClassOfShared<Stored>()->name);
    }
    const std::string path = ParameterName(function, index - first + 1);
    return LuaValue<Stored>::Read(L, index++, path);
  }
  static Stored& Pass(Stored& stored) { return stored; }
};

/// A class by reference: the object of a method call.
template <typename T>
requires requires { LuaClass<std::remove_const_t<T>>::info(); }
struct Parameter<T&> {
  using Stored = std::shared_ptr<std::remove_const_t<T>>;
  static Stored Read(lua_State* L, int& index, const FunctionInfo& function, int first) {
    Stored object = FindObject<std::remove_const_t<T>>(L, index);
    if (!object) {
      const std::string name = LuaClass<std::remove_const_t<T>>::info().name;
      if (index < first) ThrowNoSelf(L, index, function, name);
      throw InputError("", ParameterName(function, index - first + 1), WithArticle(name),
                       DescribeValue(L, index));
    }
    ++index;
    return object;
  }
  static T& Pass(Stored& stored) { return *stored; }
};

template <>
struct Parameter<lua_State*> {
  using Stored = lua_State*;
  static Stored Read(lua_State* L, int& /*index*/, const FunctionInfo& /*function*/,
                     int /*first*/) {
    return L;
  }
  static Stored Pass(Stored stored) { return stored; }
};

/// What a bound function is, and so what it may do and when.
enum class CallKind {
  kFunction,  ///< of a module
  kAction,    ///< a method, refused while a break_when function of its session is asked
  kQuery,     ///< a method that changes nothing but its result, and may be called always
  kProperty,
};

/// The session of the object that a method is called on, if this parameter is that object.
template <typename Stored>
struct SessionOfSelf {
  static const Session* Find(lua_State* /*L*/) { return nullptr; }
};
template <typename T>
struct SessionOfSelf<std::shared_ptr<T>> {
  static const Session* Find(lua_State* L) {
    const std::shared_ptr<T> object = FindObject<T>(L, 1);
    return object ? LuaClass<T>::session(*object) : nullptr;
  }
};

template <typename R, typename... Args>
int Invoke(lua_State* L, const FunctionInfo& function, CallKind kind, R (*target)(Args...)) {
  int index = 1;
  const bool method = kind != CallKind::kFunction;
  const int first = method ? 2 : 1;  // the object is not counted
  if (kind == CallKind::kAction) {
    (RequireNotAsking(L, SessionOfSelf<typename Parameter<Args>::Stored>::Find(L)), ...);
  }
  std::tuple<typename Parameter<Args>::Stored...> stored{
      Parameter<Args>::Read(L, index, function, first)...};
  if (lua_gettop(L) >= index) ThrowTooMany(function, lua_gettop(L) - first + 1);
  const auto call = [&](auto&... values) -> R { return target(Parameter<Args>::Pass(values)...); };
  if constexpr (std::is_void_v<R>) {
    std::apply(call, stored);
    return 0;
  } else if constexpr (std::is_same_v<R, Pushed>) {
    return std::apply(call, stored).count;
  } else {
    LuaValue<std::decay_t<R>>::Push(L, std::apply(call, stored));
    return 1;
  }
}

/// Runs the body of a bound function, which is the running closure's upvalue, with what all of them
/// share: compiled once.
/// @param paused  time within it is not the script's.
int CallBound(lua_State* L, int (*body)(lua_State* L, const FunctionInfo& function), bool paused);

template <auto kTarget, CallKind kKind>
int Thunk(lua_State* L) {
  const auto body = [](lua_State* state, const FunctionInfo& function) {
    return Invoke(state, function, kKind, kTarget);
  };
  return CallBound(L, body, kKind != CallKind::kProperty);
}

}  // namespace internal

/// A free function of a module. Time within it is not the script's.
template <auto kTarget>
FunctionInfo Function(std::string name, std::string parameters = "") {
  return {std::move(name), std::move(parameters),
          internal::Thunk<kTarget, internal::CallKind::kFunction>};
}

/// A method: the target's first parameter is the object, by reference. Refused while the
/// break_when function of the object's session is asked.
template <auto kTarget>
FunctionInfo Method(std::string name, std::string parameters = "") {
  return {std::move(name), std::move(parameters),
          internal::Thunk<kTarget, internal::CallKind::kAction>};
}

/// A method that may be called then too: it changes nothing that anything else sees.
template <auto kTarget>
FunctionInfo Query(std::string name, std::string parameters = "") {
  return {std::move(name), std::move(parameters),
          internal::Thunk<kTarget, internal::CallKind::kQuery>};
}

/// What x[number] gives: quick, as a property.
template <auto kTarget>
FunctionInfo Item(std::string name, std::string parameters) {
  return {std::move(name), std::move(parameters),
          internal::Thunk<kTarget, internal::CallKind::kProperty>};
}

/// A value that can be read: the target takes the object only, and is quick.
template <auto kTarget>
FunctionInfo Property(std::string name) {
  return {std::move(name), "", internal::Thunk<kTarget, internal::CallKind::kProperty>};
}

}  // namespace pregrasp
