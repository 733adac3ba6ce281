#include "render/frame_data.h"

#include <cstddef>
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
  gl.BindBuffer(GL_ARRAY_BUFFER, lines_.get());  // makes the name a buffer
  BindAttributes(0, lines_, sizeof(LinePiece), true,
                 {{0, 3, offsetof(LinePiece, p)},
                  {1, 3, offsetof(LinePiece, q)},
                  {2, 4, offsetof(LinePiece, color)},
                  {3, 1, offsetof(LinePiece, width)}});
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
