#include "render/gl.h"

#include <cstdlib>
#include <mutex>
#include <string>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

GlFunctions gl;

namespace {

void LoadFunctions() {
#define PREGRASP_GL_LOAD(name)                                                        \
  gl.name = reinterpret_cast<decltype(gl.name)>(GlBackend::FindFunction("gl" #name)); \
  PREGRASP_CHECK(gl.name != nullptr, "gl" #name, "is missing from Mesa's off-screen library");
  PREGRASP_GL_FUNCTIONS(PREGRASP_GL_LOAD)
#undef PREGRASP_GL_LOAD
}

// Mesa crashes on a driver that it does not have. Before the backend is made.
GlBackend MakeBackend() {
  const char* driver = std::getenv("GALLIUM_DRIVER");
  const std::string name = driver == nullptr ? "" : driver;
  if (!name.empty() && name != "llvmpipe") {
    throw InputError("GALLIUM_DRIVER", "", "llvmpipe, or nothing", '"' + name + '"');
  }
  return {};
}

}  // namespace

GlContext::GlContext() : backend_(MakeBackend()) {
  MakeCurrent();
  static std::once_flag once;
  std::call_once(once, LoadFunctions);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // depths are 0 to 1 from projection to buffer
}

void GlContext::MakeCurrent() {
  if (!backend_.is_current()) backend_.MakeCurrent();
}

std::string GlContext::description() const {
  const auto text = [](GLenum name) {
    return std::string(reinterpret_cast<const char*>(gl.GetString(name)));
  };
  return text(GL_RENDERER) + " through " + GlBackend::name() + ", OpenGL " + text(GL_VERSION);
}

}  // namespace pregrasp
