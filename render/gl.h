#pragma once

// OpenGL 4.5 core without a loader library: a table of the entry points that the renderer uses,
// filled once per process. The prototypes give each pointer its type; none of them is called by
// name.
#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
// glext.h must follow gl.h.
#include <GL/glext.h>

#include <string>

#include "render/gl_backend.h"

namespace pregrasp {

#define PREGRASP_GL_FUNCTIONS(X)       \
  X(ActiveTexture)                     \
  X(AttachShader)                      \
  X(BindBuffer)                        \
  X(BindBufferBase)                    \
  X(BindFramebuffer)                   \
  X(BindTexture)                       \
  X(BindVertexArray)                   \
  X(BindVertexBuffer)                  \
  X(BlendFuncSeparate)                 \
  X(BlitFramebuffer)                   \
  X(BufferData)                        \
  X(CheckFramebufferStatus)            \
  X(ClearBufferfv)                     \
  X(ClipControl)                       \
  X(ColorMask)                         \
  X(CompileShader)                     \
  X(CreateProgram)                     \
  X(CreateShader)                      \
  X(CullFace)                          \
  X(DeleteBuffers)                     \
  X(DeleteFramebuffers)                \
  X(DeleteProgram)                     \
  X(DeleteShader)                      \
  X(DeleteTextures)                    \
  X(DeleteVertexArrays)                \
  X(DepthFunc)                         \
  X(DepthMask)                         \
  X(Disable)                           \
  X(DrawArrays)                        \
  X(DrawArraysInstanced)               \
  X(DrawBuffer)                        \
  X(DrawElementsInstancedBaseInstance) \
  X(Enable)                            \
  X(EnableVertexAttribArray)           \
  X(Finish)                            \
  X(FramebufferTexture)                \
  X(FramebufferTextureLayer)           \
  X(GenBuffers)                        \
  X(GenFramebuffers)                   \
  X(GenTextures)                       \
  X(GenVertexArrays)                   \
  X(GetError)                          \
  X(GetProgramInfoLog)                 \
  X(GetProgramiv)                      \
  X(GetShaderInfoLog)                  \
  X(GetShaderiv)                       \
  X(GetString)                         \
  X(GetUniformBlockIndex)              \
  X(GetUniformLocation)                \
  X(LinkProgram)                       \
  X(ReadBuffer)                        \
  X(ReadPixels)                        \
  X(ShaderSource)                      \
  X(TexBuffer)                         \
  X(TexParameteri)                     \
  X(TexStorage2D)                      \
  X(TexStorage2DMultisample)           \
  X(TexStorage3D)                      \
  X(Uniform1f)                         \
  X(Uniform1i)                         \
  X(Uniform2f)                         \
  X(Uniform4fv)                        \
  X(UniformBlockBinding)               \
  X(UniformMatrix4fv)                  \
  X(UseProgram)                        \
  X(VertexAttribBinding)               \
  X(VertexAttribFormat)                \
  X(VertexBindingDivisor)              \
  X(Viewport)

struct GlFunctions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): the name is declared, not used in an expression
#define PREGRASP_GL_DECLARE(name) decltype(&::gl##name) name = nullptr;
  PREGRASP_GL_FUNCTIONS(PREGRASP_GL_DECLARE)
#undef PREGRASP_GL_DECLARE
};

/// The table; valid once a GlContext was made. The pointers are the same for every context.
extern GlFunctions gl;

/// An off-screen context of its own. Current on the thread that called MakeCurrent last.
class GlContext {
 public:
  /// @throws InternalError if Mesa gives no OpenGL 4.5 core context.
  GlContext();

  void MakeCurrent();

  /// What draws: GL_RENDERER, how it is reached, and GL_VERSION. The context is current.
  std::string description() const;

 private:
  GlBackend backend_;
};

}  // namespace pregrasp
