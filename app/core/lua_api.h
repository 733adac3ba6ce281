#pragma once

// Lua's API as the linked library exports it. Debian 12's C++ build of Lua has C names, as lua.hpp
// declares them; Debian 13's has C++ names. CMake tries which (CMakeLists.txt).

#ifdef PREGRASP_LUA_CXX_NAMES
// clang-format off: the others need lua.h
#include <lua5.4/lauxlib.h>
#include <lua5.4/lua.h>
#include <lua5.4/lualib.h>
// clang-format on
#else
#include <lua5.4/lua.hpp>
#endif
