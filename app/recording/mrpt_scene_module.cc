// Scenes in MRPT's way; it calls nothing of ours.
#include "app/recording/mrpt_scene_module.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CArrow.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CSphere.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>

namespace pregrasp {
namespace {

// MRPT has sRGB's bytes.
mrpt::img::TColor ToColor(const MrptScene::Color& linear) {
  std::array<std::uint8_t, 4> bytes{};
  for (int i = 0; i < 4; ++i) {
    const float value = std::clamp(linear[i], 0.0F, 1.0F);
    const float shown = i == 3                ? value
                        : value <= 0.0031308F ? 12.92F * value
                                              : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F;
    bytes[i] = static_cast<std::uint8_t>(std::lround(255.0F * shown));
  }
  return {bytes[0], bytes[1], bytes[2], bytes[3]};
}

mrpt::math::TPoint3Df ToPoint(const Vector3& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

mrpt::opengl::CSetOfTriangles::Ptr MakeMesh(const MrptScene::Mesh& mesh) {
  auto set = mrpt::opengl::CSetOfTriangles::Create();
  const TriangleMesh& triangles = *mesh.mesh;
  set->reserve(static_cast<std::size_t>(triangles.F.rows()));
  for (Eigen::Index f = 0; f < triangles.F.rows(); ++f) {
    mrpt::math::TPoint3Df p[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = ToPoint(mesh.X_WB * Vector3(triangles.V.row(triangles.F(f, k)).transpose()));
    }
    mrpt::opengl::TTriangle triangle(p[0], p[1], p[2]);
    triangle.setColor(ToColor(mesh.face_colors.empty() ? mesh.color : mesh.face_colors[f]));
    set->insertTriangle(triangle);
  }
  return set;
}

}  // namespace

std::string EncodeMrptScene(const MrptScene& scene) {
  mrpt::opengl::COpenGLScene result;
  for (const MrptScene::Mesh& mesh : scene.meshes) result.insert(MakeMesh(mesh));
  for (const MrptScene::Arrow& arrow : scene.arrows) {
    const auto from = ToPoint(arrow.p_W), to = ToPoint(arrow.p_W + arrow.v_W);
    const auto radius = static_cast<float>(arrow.radius);
    constexpr float kHead = 0.2F;  // of the length
    auto shown = mrpt::opengl::CArrow::Create(from.x, from.y, from.z, to.x, to.y, to.z, kHead,
                                              radius, 2.0F * radius);
    shown->setColor_u8(ToColor(arrow.color));
    result.insert(shown);
  }
  for (const MrptScene::Ball& ball : scene.balls) {
    auto shown = mrpt::opengl::CSphere::Create(static_cast<float>(ball.radius));
    shown->setLocation(ball.p_W.x(), ball.p_W.y(), ball.p_W.z());
    shown->setColor_u8(ToColor(ball.color));
    result.insert(shown);
  }
  for (const MrptScene::Line& line : scene.lines) {
    auto shown = mrpt::opengl::CSetOfLines::Create();
    for (std::size_t i = 1; i < line.p_W.size(); ++i) {
      const Vector3 &a = line.p_W[i - 1], &b = line.p_W[i];
      shown->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
    shown->setColor_u8(ToColor(line.color));
    result.insert(shown);
  }
  for (const MrptScene::Label& label : scene.labels) {
    auto shown = mrpt::opengl::CText::Create(label.text);
    shown->setLocation(label.p_W.x(), label.p_W.y(), label.p_W.z());
    shown->setColor_u8(ToColor(label.color));
    result.insert(shown);
  }
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << result;
  return {static_cast<const char*>(bytes.getRawBufferData()), bytes.getTotalBytesCount()};
}

}  // namespace pregrasp
