#include "render/frame_data.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "render/gl_state.h"

namespace pregrasp {

FrameData::FrameData()
    : line_vao_(MakeVertexArray()),
      block_(MakeBuffer()),
      lines_(MakeBuffer()),
      face_color_buffer_(MakeBuffer()) {
  GLuint name = 0;
  gl.GenTextures(1, &name);
  face_colors_ = GlTexture(name);
  gl.BindVertexArray(line_vao_.get());
  gl.BindBuffer(GL_ARRAY_BUFFER, lines_.get());
  const std::array<std::pair<int, std::size_t>, 4> parts = {{{3, offsetof(LinePiece, p)},
                                                             {3, offsetof(LinePiece, q)},
                                                             {4, offsetof(LinePiece, color)},
                                                             {1, offsetof(LinePiece, width)}}};
  for (GLuint slot = 0; slot < parts.size(); ++slot) {
    gl.EnableVertexAttribArray(slot);
    gl.VertexAttribPointer(slot, parts[slot].first, GL_FLOAT, GL_FALSE, sizeof(LinePiece),
                           reinterpret_cast<const void*>(parts[slot].second));
    gl.VertexAttribDivisor(slot, 1);
  }
}

void FrameData::Upload(const FrameContent& content, const MeshCache& cache) {
  pregrasp::Upload(cache.instances(), GL_ARRAY_BUFFER, content.instances);
  pregrasp::Upload(lines_, GL_ARRAY_BUFFER, content.lines);
  auto colors = content.face_colors;
  if (colors.empty()) colors.push_back({});
  pregrasp::Upload(face_color_buffer_, GL_TEXTURE_BUFFER, colors);
  BindTexture(kFaceColors, GL_TEXTURE_BUFFER, face_colors_.get());
  gl.TexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, face_color_buffer_.get());
}

void FrameData::SetBlock(const FrameBlock& block) {
  pregrasp::Upload(block_, GL_UNIFORM_BUFFER, std::vector<FrameBlock>{block});
  gl.BindBufferBase(GL_UNIFORM_BUFFER, 0, block_.get());
}

}  // namespace pregrasp
