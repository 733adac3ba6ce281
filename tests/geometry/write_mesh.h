#pragma once

// Meshes as the bytes of files, for the tests of reading.

#include <cstdint>
#include <cstring>
#include <string>

#include "app/core/text.h"
#include "app/scene/shape.h"

namespace pregrasp::testing {

inline std::string ObjText(const TriangleMesh& mesh) {
  std::string text;
  for (int v = 0; v < mesh.V.rows(); ++v) {
    text += "v";
    for (int k = 0; k < 3; ++k) text += ' ' + FormatDouble(mesh.V(v, k));
    text += '\n';
  }
  for (int f = 0; f < mesh.F.rows(); ++f) {
    text += "f";
    for (int k = 0; k < 3; ++k) text += ' ' + std::to_string(mesh.F(f, k) + 1);
    text += '\n';
  }
  return text;
}

template <typename T>
void PutBytes(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// Every triangle with corners of its own.
inline std::string BinaryStl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  PutBytes(bytes, static_cast<std::uint32_t>(mesh.F.rows()));
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) PutBytes(bytes, 0.0F);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) PutBytes(bytes, static_cast<float>(mesh.V(mesh.F(f, i), k)));
    }
    PutBytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

/// "ascii" or "binary_little_endian"; without faces when the mesh has none.
inline std::string PlyText(const TriangleMesh& mesh, const std::string& encoding) {
  const bool ascii = encoding == "ascii";
  std::string text = "ply\nformat " + encoding + " 1.0\ncomment made by a test\nelement vertex " +
                     std::to_string(mesh.V.rows()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n";
  if (mesh.F.rows() > 0) {
    text += "element face " + std::to_string(mesh.F.rows()) +
            "\nproperty list uchar int vertex_indices\n";
  }
  text += "end_header\n";
  for (int v = 0; v < mesh.V.rows(); ++v) {
    for (int k = 0; k < 3; ++k) {
      if (ascii) {
        text += FormatDouble(mesh.V(v, k)) + (k < 2 ? ' ' : '\n');
      } else {
        PutBytes(text, static_cast<float>(mesh.V(v, k)));
      }
    }
  }
  for (int f = 0; f < mesh.F.rows(); ++f) {
    if (ascii) {
      text += "3 " + std::to_string(mesh.F(f, 0)) + ' ' + std::to_string(mesh.F(f, 1)) + ' ' +
              std::to_string(mesh.F(f, 2)) + '\n';
    } else {
      PutBytes(text, std::uint8_t{3});
      for (int i = 0; i < 3; ++i) PutBytes(text, static_cast<std::int32_t>(mesh.F(f, i)));
    }
  }
  return text;
}

}  // namespace pregrasp::testing
