#include <GL/osmesa.h>

#include "app/core/check.h"
#include "render/gl_backend.h"

namespace pregrasp {

// With a token colour buffer: pictures are drawn into framebuffer objects.
struct GlBackend::Context {
  OSMesaContext handle = nullptr;
  unsigned char buffer[16 * 16 * 4] = {};
};

GlBackend::GlBackend() : context_(std::make_unique<Context>()) {
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
  context_->handle = OSMesaCreateContextAttribs(attributes, nullptr);
  PREGRASP_CHECK(context_->handle != nullptr, "OSMesa gives no OpenGL 4.5 core context");
}

GlBackend::~GlBackend() {
  if (is_current()) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(context_->handle);
}

bool GlBackend::is_current() const { return OSMesaGetCurrentContext() == context_->handle; }

void GlBackend::MakeCurrent() {
  const bool current =
      OSMesaMakeCurrent(context_->handle, context_->buffer, GL_UNSIGNED_BYTE, 16, 16) == GL_TRUE;
  PREGRASP_CHECK(current, "OSMesaMakeCurrent failed");
}

const char* GlBackend::name() { return "OSMesa"; }

void (*GlBackend::FindFunction(const char* function))() { return OSMesaGetProcAddress(function); }

}  // namespace pregrasp
