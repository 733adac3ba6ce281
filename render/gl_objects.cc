#include "render/gl_objects.h"

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "render/shader_text.h"

namespace pregrasp {
namespace {

void SetClampedNearest(GLenum target) {
  gl.TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlFramebuffer BindNewFramebuffer() {
  GLuint name = 0;
  gl.GenFramebuffers(1, &name);
  gl.BindFramebuffer(GL_FRAMEBUFFER, name);
  return GlFramebuffer(name);
}

void CheckComplete() {
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  PREGRASP_CHECK(status == GL_FRAMEBUFFER_COMPLETE, status);
}

GLuint Compile(GLenum kind, const std::vector<std::string>& files,
               const std::vector<std::string>& defines) {
  std::string text = "#version 450 core\n";
  for (const std::string& define : defines) text += "#define " + define + "\n";
  for (const std::string& file : files) text += ShaderText(file);
  const GLuint shader = gl.CreateShader(kind);
  const char* source = text.c_str();
  gl.ShaderSource(shader, 1, &source, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_FALSE) {
    char log[2048] = "";
    gl.GetShaderInfoLog(shader, sizeof(log), nullptr, log);
    PREGRASP_CHECK(ok != GL_FALSE, files.back(), log);
  }
  return shader;
}

}  // namespace

GlBuffer MakeBuffer() {
  GLuint name = 0;
  gl.GenBuffers(1, &name);
  return GlBuffer(name);
}

GlVertexArray MakeVertexArray() {
  GLuint name = 0;
  gl.GenVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlTexture MakeTexture2D(GLenum format, int width, int height, int samples) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  if (samples > 0) {
    gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, name);
    gl.TexStorage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, samples, format, width, height, GL_TRUE);
  } else {
    gl.BindTexture(GL_TEXTURE_2D, name);
    gl.TexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    SetClampedNearest(GL_TEXTURE_2D);
  }
  return GlTexture(name);
}

GlTexture MakeTextureArray(GLenum format, int size, int layers) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, name);
  gl.TexStorage3D(GL_TEXTURE_2D_ARRAY, 1, format, size, size, layers);
  SetClampedNearest(GL_TEXTURE_2D_ARRAY);
  return GlTexture(name);
}

GlFramebuffer MakeFramebuffer(const GlTexture* color, const GlTexture* depth) {
  GlFramebuffer framebuffer = BindNewFramebuffer();
  if (color != nullptr) {
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, color->get(), 0);
  }
  if (depth != nullptr) {
    gl.FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth->get(), 0);
  }
  CheckComplete();
  return framebuffer;
}

GlFramebuffer MakeLayerFramebuffer(GLenum attachment, const GlTexture& array, int layer) {
  GlFramebuffer framebuffer = BindNewFramebuffer();
  gl.FramebufferTextureLayer(GL_FRAMEBUFFER, attachment, array.get(), 0, layer);
  if (attachment == GL_DEPTH_ATTACHMENT) {
    gl.DrawBuffer(GL_NONE);
    gl.ReadBuffer(GL_NONE);
  }
  CheckComplete();
  return framebuffer;
}

void BindAttributes(GLuint binding, const GlBuffer& buffer, std::size_t stride, bool per_instance,
                    const std::vector<VertexAttribute>& attributes) {
  gl.BindVertexBuffer(binding, buffer.get(), 0, static_cast<GLsizei>(stride));
  gl.VertexBindingDivisor(binding, per_instance ? 1 : 0);
  for (const VertexAttribute& attribute : attributes) {
    gl.EnableVertexAttribArray(attribute.slot);
    gl.VertexAttribFormat(attribute.slot, attribute.floats, GL_FLOAT, GL_FALSE,
                          static_cast<GLuint>(attribute.offset));
    gl.VertexAttribBinding(attribute.slot, binding);
  }
}

GlProgram::GlProgram(const std::vector<std::string>& vertex,
                     const std::vector<std::string>& fragment,
                     const std::vector<std::string>& defines)
    : program_(gl.CreateProgram()) {
  ThrowIfInterrupted();
  const GLuint program = program_.get();
  std::vector<GLuint> shaders = {Compile(GL_VERTEX_SHADER, vertex, defines)};
  if (!fragment.empty()) shaders.push_back(Compile(GL_FRAGMENT_SHADER, fragment, defines));
  for (const GLuint shader : shaders) gl.AttachShader(program, shader);
  gl.LinkProgram(program);
  for (const GLuint shader : shaders) gl.DeleteShader(shader);
  GLint ok = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok == GL_FALSE) {
    char log[2048] = "";
    gl.GetProgramInfoLog(program, sizeof(log), nullptr, log);
    PREGRASP_CHECK(ok != GL_FALSE, vertex.back(), log);
  }
  const GLuint block = gl.GetUniformBlockIndex(program, "Frame");
  if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(program, block, 0);
}

}  // namespace pregrasp
