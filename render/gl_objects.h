#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "render/gl.h"

namespace pregrasp {

/// A GL name that deletes what it names; the context that made it must be current.
template <typename Deleter>
class GlName {
 public:
  GlName() = default;
  explicit GlName(GLuint name) : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~GlName() {
    if (name_ != 0) Deleter{}(name_);
  }
  GLuint get() const { return name_; }

 private:
  GLuint name_ = 0;
};

struct DeleteBuffer {
  void operator()(GLuint name) const { gl.DeleteBuffers(1, &name); }
};
struct DeleteTexture {
  void operator()(GLuint name) const { gl.DeleteTextures(1, &name); }
};
struct DeleteFramebuffer {
  void operator()(GLuint name) const { gl.DeleteFramebuffers(1, &name); }
};
struct DeleteVertexArray {
  void operator()(GLuint name) const { gl.DeleteVertexArrays(1, &name); }
};
struct DeleteProgram {
  void operator()(GLuint name) const { gl.DeleteProgram(name); }
};

using GlBuffer = GlName<DeleteBuffer>;
using GlTexture = GlName<DeleteTexture>;
using GlFramebuffer = GlName<DeleteFramebuffer>;
using GlVertexArray = GlName<DeleteVertexArray>;

GlBuffer MakeBuffer();
GlVertexArray MakeVertexArray();

/// Immutable storage; nearest filtering and clamped edges.
/// @param samples  0 for an ordinary texture.
GlTexture MakeTexture2D(GLenum format, int width, int height, int samples = 0);
GlTexture MakeTextureArray(GLenum format, int size, int layers);

/// Uploads plain values to `buffer` bound at `target`.
template <typename T>
void Upload(const GlBuffer& buffer, GLenum target, const std::vector<T>& values,
            GLenum usage = GL_STREAM_DRAW) {
  gl.BindBuffer(target, buffer.get());
  gl.BufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), usage);
}

/// A complete framebuffer of one texture or two; null leaves a part out.
GlFramebuffer MakeFramebuffer(const GlTexture* color, const GlTexture* depth);
/// Of one layer of an array.
GlFramebuffer MakeLayerFramebuffer(GLenum attachment, const GlTexture& array, int layer);

/// A vertex attribute of `floats` numbers, `offset` bytes into a record.
struct VertexAttribute {
  GLuint slot = 0;
  int floats = 0;
  std::size_t offset = 0;
};

/// Makes the bound vertex array read attributes from `buffer`, whose records are `stride` bytes; a
/// record serves one vertex, or one instance. Buffers of one array differ in `binding`.
void BindAttributes(GLuint binding, const GlBuffer& buffer, std::size_t stride, bool per_instance,
                    const std::vector<VertexAttribute>& attributes);

/// A linked program made of the named files of render/shaders; the uniform block Frame is
/// bound to slot 0 if the program has it.
class GlProgram {
 public:
  GlProgram() = default;
  /// @param vertex, fragment  shader files without suffix, joined in order; an empty `fragment`
  ///                          gives a depth-only program.
  /// @param defines           names defined in both.
  GlProgram(const std::vector<std::string>& vertex, const std::vector<std::string>& fragment,
            const std::vector<std::string>& defines = {});

  void Use() const { gl.UseProgram(program_.get()); }
  GLint uniform(const char* name) const { return gl.GetUniformLocation(program_.get(), name); }
  /// Tells the sampler `name` to read texture unit `unit`; the program must be in use.
  void SetSampler(const char* name, int unit) const { gl.Uniform1i(uniform(name), unit); }

 private:
  GlName<DeleteProgram> program_;
};

}  // namespace pregrasp
