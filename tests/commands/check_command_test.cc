// `pregrasp check` of mesh files, and what `repair = true` says.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "app/geometry/mesh_topology.h"
#include "app/geometry/obj_text.h"
#include "app/geometry/tessellate.h"
#include "tests/bindings/run_program.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// A ball without the faces around its middle vertex.
void WriteTornBall(const fs::path& file) {
  const TriangleMesh ball = Tessellate(Sphere{0.04}, 96);
  std::vector<bool> keep(ball.F.rows(), true);
  for (int f = 0; f < ball.F.rows(); ++f) {
    keep[f] = !(ball.F.row(f).array() == static_cast<int>(ball.V.rows() / 2)).any();
  }
  std::ofstream(file) << FormatObj(TakeFaces(ball, keep));
}

TEST(CheckCommandTest, OfAMeshFileSaysWhereItIsOpenAndDrawsIt) {
  const TestFolder folder;
  WriteTornBall(folder.path() / "torn.obj");
  const ProgramResult open =
      RunProgram({"check", "torn.obj", "--picture", "torn.png"}, folder.path());
  EXPECT_EQ(open.code, 2);
  EXPECT_NE(open.err.find("torn.obj: expected a closed mesh, or repair = true, got \"torn.obj\", "
                          "which has "),
            std::string::npos)
      << open.err;
  EXPECT_GT(fs::file_size(folder.path() / "torn.png"), 10'000U);
  const ProgramResult mended = RunProgram({"check", "torn.obj", "--repair"}, folder.path());
  EXPECT_EQ(mended.code, 0) << mended.err;
  EXPECT_EQ(mended.out.find("torn.obj: repaired: 1 hole closed, "), 0U) << mended.out;
  EXPECT_NE(mended.out.find("torn.obj: closed, 0.08 x 0.08 x 0.08 m, "), std::string::npos)
      << mended.out;
  EXPECT_EQ(RunProgram({"check", "torn.obj", "--set", "a=1"}, folder.path()).code, 2);
  EXPECT_EQ(RunProgram({"check", "none.obj"}, folder.path()).code, 2);
}

TEST(CheckCommandTest, OfASceneNotesWhatWasRepaired) {
  const TestFolder folder;
  WriteTornBall(folder.path() / "torn.obj");
  const auto check = [&](const std::string& mesh) {
    std::ofstream(folder.path() / "scene.lua")
        << "return scene { name = 'ball', object = { shape = " << mesh
        << ", mass = 0.1, p = {0, 0, 0.04} }, environment = { { name = 'floor', "
           "shape = box{1, 1, 0.02}, p = {0, 0, -0.01} } } }";
    return RunProgram({"check", "scene.lua", "--no-grasps"}, folder.path());
  };
  EXPECT_EQ(check("mesh{'torn.obj'}").code, 2);
  const ProgramResult mended = check("mesh{'torn.obj', repair = true}");
  EXPECT_NE((mended.out + mended.err).find("note: \"torn.obj\" was repaired: 1 hole closed, "),
            std::string::npos)
      << mended.out << mended.err;
  const ProgramResult cloud = check("cloud{'torn.ply', repair = true}");
  EXPECT_EQ(cloud.code, 2);
  EXPECT_NE(cloud.err.find("repair"), std::string::npos) << cloud.err;
}

}  // namespace
}  // namespace pregrasp
