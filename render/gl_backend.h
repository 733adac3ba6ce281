#pragma once

#include <memory>

namespace pregrasp {

/// An OpenGL 4.5 core context without a window, drawn by Mesa's llvmpipe on the processor, the same
/// everywhere. One of gl_osmesa.cc and gl_egl.cc is compiled in (-DPREGRASP_GL, render/README.md).
class GlBackend {
 public:
  /// @throws InternalError if there is no such context.
  GlBackend();
  ~GlBackend();
  GlBackend(const GlBackend&) = delete;
  GlBackend& operator=(const GlBackend&) = delete;

  bool is_current() const;
  void MakeCurrent();

  /// "OSMesa" or "EGL".
  static const char* name();
  /// The entry point of a function by its whole name, glClear; null if there is none.
  static void (*FindFunction(const char* function))();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace pregrasp
