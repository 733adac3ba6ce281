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
#define PREGRASP_GL_LOAD(name)                                                     \
  gl.name = reinterpret_cast<decltype(gl.name)>(OSMesaGetProcAddress("gl" #name)); \
  PREGRASP_CHECK(gl.name != nullptr, "gl" #name, "is missing from Mesa's off-screen library");
  PREGRASP_GL_FUNCTIONS(PREGRASP_GL_LOAD)
#undef PREGRASP_GL_LOAD
}

// Mesa crashes on a driver that it does not have.
void RequireKnownDriver() {
  const char* driver = std::getenv("GALLIUM_DRIVER");
  const std::string name = driver == nullptr ? "" : driver;
  if (name.empty() || name == "llvmpipe") return;
  throw InputError("GALLIUM_DRIVER", "", "llvmpipe, or nothing", '"' + name + '"');
}

}  // namespace

GlContext::GlContext() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_STENCIL_BITS,
                            0,
                            OSMESA_ACCUM_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  RequireKnownDriver();
  context_ = OSMesaCreateContextAttribs(attributes, nullptr);
  PREGRASP_CHECK(context_ != nullptr, "OSMesa gives no OpenGL 4.5 core context");
  MakeCurrent();
  static std::once_flag once;
  std::call_once(once, LoadFunctions);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // depths are 0 to 1 from projection to buffer
}

GlContext::~GlContext() {
  if (OSMesaGetCurrentContext() == context_) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(context_);
}

void GlContext::MakeCurrent() {
  if (OSMesaGetCurrentContext() == context_) return;
  const bool current = OSMesaMakeCurrent(context_, buffer_, GL_UNSIGNED_BYTE, 16, 16) == GL_TRUE;
  PREGRASP_CHECK(current, "OSMesaMakeCurrent failed");
}

}  // namespace pregrasp
