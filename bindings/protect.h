#pragma once

#include <exception>
#include <new>
#include <string>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/lua_api.h"
#include "bindings/machine.h"

namespace pregrasp {

/// Whether `message` starts with a line of the file that `where` is a line of.
bool InSameFile(const std::string& message, const std::string& where);

/// The one translator from C++ exceptions to Lua errors: every function that Lua can call runs its
/// body through it. Lua is Debian's C++ build, whose own errors are exceptions too, but none that
/// derive from std::exception: they pass through, running destructors on their way, and must never
/// meet a catch (...).
///
/// InputError becomes an error that a script may catch, with the file:line of the Lua code that
/// called, unless it names a line of the same file already; Interrupted and our own bugs end the
/// script whatever catches them.
template <typename Body>
int Protect(lua_State* L, Body&& body) {
  // The exception object must be gone before lua_error leaves this frame.
  std::string message;
  Machine::StopReason stop = Machine::StopReason::kNone;
  try {
    return body();
  } catch (const InputError& error) {
    message = error.what();
  } catch (const Interrupted& error) {
    message = error.what();
    stop = Machine::StopReason::kInterrupt;
  } catch (const std::bad_alloc&) {
    message = Machine::Of(L).MemoryMessage();
  } catch (const std::exception& error) {
    message = error.what();
    stop = Machine::StopReason::kInternal;
  }
  if (stop != Machine::StopReason::kNone) Machine::Of(L).Stop(L, stop, message);
  const std::string where = WhereInLua(L);
  if (!where.empty() && !InSameFile(message, where)) message = where + ": " + message;
  lua_pushlstring(L, message.data(), message.size());
  return lua_error(L);
}

}  // namespace pregrasp
