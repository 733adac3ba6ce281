#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstring>

#include "app/core/check.h"
#include "render/gl_backend.h"

namespace pregrasp {
namespace {

template <typename Function>
Function FindEgl(const char* function) {
  const auto found = reinterpret_cast<Function>(eglGetProcAddress(function));
  PREGRASP_CHECK(found != nullptr, function, "is missing from EGL");
  return found;
}

// Mesa's device without hardware, whatever else the machine has: its pictures are the same
// everywhere, and need no rights to a device.
EGLDisplay OpenSoftwareDevice() {
  const auto query = FindEgl<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto describe = FindEgl<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  const auto open = FindEgl<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  std::array<EGLDeviceEXT, 64> devices{};
  EGLint count = 0;
  query(static_cast<EGLint>(devices.size()), devices.data(), &count);
  for (EGLint i = 0; i < count; ++i) {
    EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
    const char* extensions = describe(device, EGL_EXTENSIONS);
    if (extensions == nullptr || std::strstr(extensions, "EGL_MESA_device_software") == nullptr) {
      continue;
    }
    EGLDisplay display = open(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    PREGRASP_CHECK(display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr),
                   "EGL does not open Mesa's software device", eglGetError());
    return display;
  }
  PREGRASP_CHECK(false, "EGL has no software device: Debian's libegl-mesa0 brings it", count);
  return EGL_NO_DISPLAY;
}

// One for the process, which EGL counts on: it stays open.
EGLDisplay Display() {
  static EGLDisplay display = OpenSoftwareDevice();
  return display;
}

}  // namespace

struct GlBackend::Context {
  EGLContext handle = EGL_NO_CONTEXT;
};

GlBackend::GlBackend() : context_(std::make_unique<Context>()) {
  PREGRASP_CHECK(eglBindAPI(EGL_OPENGL_API), eglGetError());
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  // Without a surface: pictures are drawn into framebuffer objects.
  context_->handle = eglCreateContext(Display(), EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  PREGRASP_CHECK(context_->handle != EGL_NO_CONTEXT, "EGL gives no OpenGL 4.5 core context",
                 eglGetError());
}

GlBackend::~GlBackend() {
  if (is_current()) eglMakeCurrent(Display(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(Display(), context_->handle);
}

bool GlBackend::is_current() const { return eglGetCurrentContext() == context_->handle; }

void GlBackend::MakeCurrent() {
  const bool current =
      eglMakeCurrent(Display(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_->handle) == EGL_TRUE;
  PREGRASP_CHECK(current, "eglMakeCurrent failed", eglGetError());
}

const char* GlBackend::name() { return "EGL"; }

void (*GlBackend::FindFunction(const char* function))() { return eglGetProcAddress(function); }

}  // namespace pregrasp
