#include "app/geometry/obj_text.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

TEST(ObjTextTest, ReadsBackToTheLastBitOrToTheDecimalsAskedFor) {
  TriangleMesh mesh;
  mesh.V.resize(3, 3);
  mesh.V << 0.1, -1e-17, 1.0 / 3.0, 2.5e300, 0.0, -7.0, 0.123456789, 1e-3, 4.0;
  mesh.F.resize(1, 3);
  mesh.F << 2, 0, 1;
  const TriangleMesh exact = ParseObj(FormatObj(mesh), "mesh.obj");
  EXPECT_EQ(exact.V, mesh.V);
  EXPECT_EQ(exact.F, mesh.F);
  mesh.V(1, 0) = 2.5;
  const TriangleMesh rounded = ParseObj(FormatObj(mesh, 6), "mesh.obj");
  EXPECT_LE((rounded.V - mesh.V).cwiseAbs().maxCoeff(), 0.51e-6);
  EXPECT_EQ(rounded.V(2, 0), 0.123457);
}

TEST(ObjTextTest, OnlyTriangleMeshesAreRead) {
  const auto error_of = [](const std::string& text) -> std::string {
    try {
      ParseObj(text, "mesh.obj");
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  const std::string good = "# a comment\nv 0 0 0\nv 1 0 0\nv 0 1e-3 0\n\nf 1 2 3\n";
  EXPECT_EQ(error_of(good), "none");
  EXPECT_NE(error_of(good + "f 1 2 4\n").find("vertices that exist"), std::string::npos);
  EXPECT_NE(error_of(good + "f 1 2 0\n").find("vertices that exist"), std::string::npos);
  EXPECT_EQ(error_of(good + "f 1/1 2/2 3/3\n").find("mesh.obj:7: "), 0U);
  for (const char* bad :
       {"v 0 0\n", "v 0 0 0 1\n", "v nan 0 0\n", "v 0 inf 0\n", "usemtl wood\n"}) {
    EXPECT_EQ(error_of(bad).find("mesh.obj:1: "), 0U) << bad;
  }
}

}  // namespace
}  // namespace pregrasp
