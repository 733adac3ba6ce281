#include "app/geometry/load_shape.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/point_cloud.h"
#include "app/geometry/read_in_child.h"
#include "app/geometry/read_mesh.h"
#include "app/geometry/signed_distance.h"
#include "app/scene/shape_visit.h"
#include "tests/geometry/test_shapes.h"
#include "tests/geometry/write_mesh.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;
using testing::At;

class LoadShapeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    directory_ = fs::temp_directory_path() /
                 (std::string("pregrasp_load_") + info->name() + std::to_string(::getpid()));
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
  }

  Shape LoadAny(const std::string& name, double scale = 1.0) const {
    Mesh mesh;
    mesh.file = name;
    mesh.scale = scale;
    Shape shape = mesh;
    LoadShape(shape, directory_, "a.lua:7", "object.shape");
    return shape;
  }
  TriangleMesh Load(const std::string& name, double scale = 1.0) const {
    return std::get<Mesh>(LoadAny(name, scale)).mesh;
  }

  // The message, and that it is an InputError of the right place.
  std::string Refusal(const std::string& name) const {
    try {
      Load(name);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), "a.lua:7");
      EXPECT_EQ(error.field(), "object.shape");
      return error.what();
    }
    return "accepted";
  }

  fs::path directory_;
};

// A tetrahedron whose corners are in the buffer `uri`.
std::string TetrahedronAsGltf(const std::string& uri) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
"min": [0, 0, 0], "max": [1, 1, 1]},
{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"uri": ")" +
         uri + R"(", "byteLength": 72}]})";
}

std::string TetrahedronAsBytes() {
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::uint16_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
         std::string(reinterpret_cast<const char*>(faces), sizeof faces);
}

TriangleMesh OneTriangle() {
  TriangleMesh mesh;
  mesh.V.setIdentity(3, 3);
  mesh.F.resize(1, 3);
  mesh.F << 0, 1, 2;
  return mesh;
}

std::string ProblemOf(const std::function<TriangleMesh()>& read, const ReadLimits& limits = {}) {
  try {
    ReadInChild(read, limits);
  } catch (const UnreadableFile& error) {
    return error.expected + "; " + error.got;
  }
  return "";
}

TEST(ReadInChildTest, WhatIsReadComesBackAndWhatFailsIsAProblemOfTheFile) {
  const TriangleMesh mesh = ReadInChild(OneTriangle);
  EXPECT_EQ(mesh.V, OneTriangle().V);
  EXPECT_EQ(mesh.F, OneTriangle().F);
  EXPECT_EQ(ProblemOf([]() -> TriangleMesh { throw UnreadableFile("this", "that"); }),
            "this; that");
  EXPECT_EQ(ProblemOf([]() -> TriangleMesh { throw std::runtime_error("line 3"); }),
            "a mesh that can be read; of which its reader says: line 3");
  EXPECT_EQ(ProblemOf([]() -> TriangleMesh { std::abort(); }),
            "a mesh that can be read; on which its reader fails");
  EXPECT_EQ(ProblemOf([]() -> TriangleMesh { _exit(0); }),
            "a mesh that can be read; on which its reader fails");
}

TEST(ReadInChildTest, AReaderThatLoopsOrWaitsOrSwellsIsEnded) {
  ReadLimits limits;
  limits.seconds = 1.0;
  const std::string slow = "a file that can be read in limited time; which takes more than 1 s";
  EXPECT_EQ(ProblemOf(
                []() -> TriangleMesh {
                  for (volatile bool on = true; on;) {
                  }
                  return {};
                },
                limits),
            slow);
  limits.seconds = 0.1;
  EXPECT_EQ(ProblemOf(
                []() -> TriangleMesh {
                  pause();
                  return {};
                },
                limits),
            "a file that can be read in limited time; which takes more than 0.1 s");
#ifndef __SANITIZE_ADDRESS__
  limits.seconds = 20.0;
  limits.megabytes = 64;
  EXPECT_EQ(ProblemOf(
                []() -> TriangleMesh {
                  std::vector<std::string> swelling;
                  while (true) swelling.emplace_back(1 << 20, 'x');
                },
                limits),
            "a file that can be read in limited memory; which takes more than 64 MB");
#endif
}

TEST(ReadInChildTest, AnInterruptEndsTheReadingAndItsProcess) {
  RequestInterrupt();
  EXPECT_THROW(ReadInChild([]() -> TriangleMesh {
                 pause();
                 return {};
               }),
               Interrupted);
  ClearInterrupt();
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);  // no child is left
}

TEST_F(LoadShapeTest, APlyFileWithTwoElementsOfVerticesIsRefusedAndFacesMayComeFirst) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const std::string vertex_element =
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face_element = "element face 4\nproperty list uchar int vertex_indices\n";
  Write("first.ply", "ply\nformat ascii 1.0\n" + face_element + vertex_element + "end_header\n" +
                         faces + vertices);
  EXPECT_NEAR(CalcVolume(Mesh{"", 1.0, Load("first.ply"), false, ""}), 1.0 / 6.0, 1e-12);
  Write("two.ply", "ply\nformat ascii 1.0\n" + vertex_element + face_element + vertex_element +
                       "end_header\n" + vertices + faces + vertices);
  EXPECT_NE(Refusal("two.ply").find("which has 2 elements \"vertex\""), std::string::npos);
  Write("beyond.ply", "ply\nformat ascii 1.0\n" + face_element + vertex_element + "end_header\n" +
                          "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 4\n" + vertices);
  EXPECT_NE(Refusal("beyond.ply").find("a face with vertex 4 of 4"), std::string::npos);
}

TEST_F(LoadShapeTest, AMeshReadsItsOwnFolderAndNothingElse) {
  fs::create_directories(directory_ / "a" / "deeper");
  Write("a/deeper/own.bin", TetrahedronAsBytes());
  Write("elsewhere.bin", TetrahedronAsBytes());
  fs::create_symlink(directory_ / "elsewhere.bin", directory_ / "a" / "link.bin");
  ASSERT_EQ(mkfifo((directory_ / "a" / "pipe.bin").c_str(), 0600), 0);
  Write("a/own.gltf", TetrahedronAsGltf("deeper/own.bin"));
  EXPECT_NEAR(CalcVolume(Mesh{"", 1.0, Load("a/own.gltf"), false, ""}), 1.0 / 6.0, 1e-6);
  for (const char* uri : {"../elsewhere.bin", "link.bin", "pipe.bin", "missing.bin"}) {
    Write("a/other.gltf", TetrahedronAsGltf(uri));
    const std::string refusal = Refusal("a/other.gltf");
    EXPECT_NE(refusal.find("other files are plain files in its own folder"), std::string::npos)
        << uri << ": " << refusal;
    EXPECT_NE(refusal.find(uri), std::string::npos) << refusal;
  }
  // A material that is a pipe is left out, and nobody waits for it.
  ASSERT_EQ(mkfifo((directory_ / "pipe.mtl").c_str(), 0600), 0);
  Write(
      "t.obj",
      "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_EQ(Load("t.obj").F.rows(), 4);
}

TEST_F(LoadShapeTest, AGltfFileNamesItsBufferByUri) {
  Write("my block.bin", TetrahedronAsBytes());
  Write("a.gltf", TetrahedronAsGltf("my%20block.bin"));
  EXPECT_NEAR(CalcVolume(Load("a.gltf")), 1.0 / 6.0, 1e-6);
  Write("b.gltf", TetrahedronAsGltf("%2e%2e/outside.bin"));
  EXPECT_NE(Refusal("b.gltf").find("its own folder"), std::string::npos);
}

TEST_F(LoadShapeTest, ReadsAnObjAsItIs) {
  const TriangleMesh mesh = testing::MakeTorus(0.04, 0.01, 12, 8);
  Write("a.obj", testing::ObjText(mesh));
  const TriangleMesh loaded = Load("a.obj");
  EXPECT_EQ(loaded.V.rows(), mesh.V.rows());
  EXPECT_EQ(loaded.F.rows(), mesh.F.rows());
  EXPECT_NEAR(CalcVolume(loaded), CalcVolume(mesh), 1e-6 * CalcVolume(mesh));
}

TEST_F(LoadShapeTest, WeldsTheCornersOfAnStl) {
  const TriangleMesh mesh = testing::MakeCup(0.04, 0.09, 0.003, 24);
  Write("a.stl", testing::BinaryStl(mesh));
  const TriangleMesh loaded = Load("a.stl");
  EXPECT_EQ(loaded.V.rows(), mesh.V.rows());
  EXPECT_EQ(loaded.F.rows(), mesh.F.rows());
}

TEST_F(LoadShapeTest, AppliesTheScale) {
  Write("a.obj", testing::ObjText(Tessellate(Box{Vector3(100, 50, 20)})));
  EXPECT_NEAR(CalcVolume(Load("a.obj", 0.001)), 1e-4, 1e-10);
}

TEST_F(LoadShapeTest, TurnsAMeshOutward) {
  TriangleMesh mesh = testing::MakeTorus(0.04, 0.01, 12, 8);
  mesh.F.col(1).swap(mesh.F.col(2));
  Write("inward.obj", testing::ObjText(mesh));
  EXPECT_GT(CalcVolume(Load("inward.obj")), 0.0);
  for (int f = 0; f < mesh.F.rows(); f += 3) std::swap(mesh.F(f, 0), mesh.F(f, 1));
  Write("mixed.obj", testing::ObjText(mesh));
  const TriangleMesh loaded = Load("mixed.obj");
  EXPECT_TRUE(FindDefects(loaded).closed());
  EXPECT_GT(CalcVolume(loaded), 0.0);
}

TEST_F(LoadShapeTest, AComponentInsideAnotherIsACavityWhateverItsOrientation) {
  TriangleMesh hollow = Tessellate(Box{Vector3(2, 2, 2)});
  AppendMesh(hollow, Transformed(Tessellate(Box{Vector3(1, 1, 1)}), At(0.2, 0, 0)));
  AppendMesh(hollow, Transformed(Tessellate(Box{Vector3(1, 1, 1)}), At(5, 0, 0)));
  Write("hollow.obj", testing::ObjText(hollow));
  const TriangleMesh loaded = Load("hollow.obj");
  EXPECT_NEAR(CalcVolume(loaded), 8.0, 1e-6);
  const SignedDistance distance(testing::MakeMesh(loaded));
  EXPECT_GT(distance.Calc({0.2, 0, 0}), 0.0);
  EXPECT_LT(distance.Calc({-0.8, 0, 0}), 0.0);
  EXPECT_LT(distance.Calc({5, 0, 0}), 0.0);
}

// A cup and its handle, a knob sunk into a lid: two closed surfaces that go through each other.
TEST_F(LoadShapeTest, SolidsThatOverlapAreTheirUnion) {
  TriangleMesh lid = Tessellate(Box{Vector3(0.08, 0.08, 0.01)});
  AppendMesh(lid, Transformed(Tessellate(Box{Vector3(0.03, 0.02, 0.03)}), At(0.01, 0.02, 0.016)));
  Write("lid.obj", testing::ObjText(lid));
  const Shape shape = LoadAny("lid.obj");
  const double sunk = 0.03 * 0.02 * 0.004, volume = 6.4e-5 + 1.8e-5 - sunk;
  EXPECT_NEAR(CalcVolume(shape), volume, 1e-4 * volume);
  const Vector3 first = 1.8e-5 * Vector3(0.01, 0.02, 0.016) - sunk * Vector3(0.01, 0.02, 0.003);
  EXPECT_LT((CalcMassProperties(shape, 1.0).p_BoBcm - first / volume).norm(), 1e-6);
  const SignedDistance distance(shape);
  EXPECT_NEAR(distance.Calc(Vector3(0.01, 0.02, 0.002)), -0.003, 1e-9);
  EXPECT_NEAR(distance.Calc(Vector3(-0.02, -0.02, 0.009)), 0.004, 1e-9);
}

// Along an edge, or along faces with other triangles on either side.
TEST_F(LoadShapeTest, PartsWithCornersOfTheirOwnMayTouchAlongThem) {
  const TriangleMesh cube = WeldVertices(Tessellate(Box{Vector3(0.1, 0.1, 0.1)}), 0.0);
  const TriangleMesh tower = WeldVertices(Tessellate(Box{Vector3(0.1, 0.1, 0.2)}), 0.0);
  TriangleMesh beside = cube;
  AppendMesh(beside, Transformed(cube, At(0.1, 0.1, 0)));
  AppendMesh(beside, Transformed(tower, At(0, 0.1, 0)));
  Write("beside.ply", testing::PlyText(beside, "ascii"));
  const Shape shape = LoadAny("beside.ply");
  EXPECT_EQ(std::get<Union>(shape).parts.size(), 3U);
  EXPECT_NEAR(CalcVolume(shape), 4e-3, 1e-6);
}

TEST_F(LoadShapeTest, TheWallBetweenSolidsThatShareAFaceIsLeftOut) {
  TriangleMesh two = Tessellate(Box{Vector3(0.1, 0.1, 0.1)});
  AppendMesh(two, Transformed(Tessellate(Box{Vector3(0.1, 0.1, 0.1)}), At(0.1, 0, 0)));
  Write("two.stl", testing::BinaryStl(two));
  const TriangleMesh mesh = Load("two.stl");
  EXPECT_EQ(mesh.F.rows(), 20);
  EXPECT_NEAR(CalcVolume(mesh), 2e-3, 1e-9);
}

TEST_F(LoadShapeTest, ManyClosedPartsAreRefusedBeforeTheyAreCompared) {
  const TriangleMesh tetrahedron = [] {
    TriangleMesh mesh;
    mesh.V.resize(4, 3);
    mesh.V << 0, 0, 0, 0.004, 0, 0, 0, 0.004, 0, 0, 0, 0.004;
    mesh.F.resize(4, 3);
    mesh.F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
    return mesh;
  }();
  const auto row = [&](int count, double step) {
    TriangleMesh mesh;
    mesh.V.resize(4 * count, 3);
    mesh.F.resize(4 * count, 3);
    for (int i = 0; i < count; ++i) {
      const TriangleMesh one = Transformed(tetrahedron, At(step * i, 0, 0));
      mesh.V.middleRows(4 * i, 4) = one.V;
      mesh.F.middleRows(4 * i, 4) = one.F.array() + 4 * i;
    }
    return mesh;
  };
  Write("dust.obj", testing::ObjText(row(10'001, 0.005)));
  EXPECT_NE(Refusal("dust.obj")
                .find("at most 10000 closed parts, got \"dust.obj\", which has "
                      "10001"),
            std::string::npos)
      << Refusal("dust.obj");
  Write("chain.obj", testing::ObjText(row(65, 0.003)));
  EXPECT_NE(Refusal("chain.obj").find("at most 64 closed parts that touch or overlap"),
            std::string::npos)
      << Refusal("chain.obj");
}

TEST_F(LoadShapeTest, SplitsAVertexThatTwoSolidsShare) {
  TriangleMesh two = Tessellate(Box{Vector3(1, 1, 1)});
  AppendMesh(two, Transformed(Tessellate(Box{Vector3(1, 1, 1)}), At(1, 1, 1)));
  Write("pinched.obj", testing::ObjText(two));
  const Shape loaded = LoadAny("pinched.obj");
  Eigen::Index corners = 0;
  ForEachLeaf(loaded, RigidTransform::Identity(), [&](const Shape& leaf, const RigidTransform&) {
    corners += std::get<Mesh>(leaf).mesh.V.rows();
  });
  EXPECT_EQ(corners, 16);
  EXPECT_NEAR(CalcVolume(loaded), 2.0, 1e-9);
}

TEST_F(LoadShapeTest, RefusesAnOpenMeshAndCountsItsOpenEdges) {
  TriangleMesh mesh = Tessellate(Cylinder{0.04, 0.1}, 12);
  const TriangleMesh closed = mesh;
  mesh.F.resize(0, 3);
  for (int f = 0; f < closed.F.rows(); ++f) {  // without the fan to the top's centre
    if ((closed.F.row(f).array() == closed.V.rows() - 1).any()) continue;
    mesh.F.conservativeResize(mesh.F.rows() + 1, 3);
    mesh.F.bottomRows(1) = closed.F.row(f);
  }
  Write("cup.obj", testing::ObjText(mesh));
  EXPECT_EQ(Refusal("cup.obj"),
            "a.lua:7: object.shape: expected a closed mesh, got \"cup.obj\", which has 12 open "
            "edges: a hole about (0, 0, 0.05) m, 0.08 m across");
  // A box without one face of its top and one of its bottom.
  const TriangleMesh box = Tessellate(Box{Vector3(1, 1, 1)});
  std::vector<bool> keep(box.F.rows(), true);
  for (const double z : {0.5, -0.5}) {
    for (int f = 0; f < box.F.rows(); ++f) {
      if (!(box.V(box.F.row(f), 2).array() == z).all()) continue;
      keep[f] = false;
      break;
    }
  }
  Write("box.obj", testing::ObjText(TakeFaces(box, keep)));
  EXPECT_NE(Refusal("box.obj").find("6 open edges: 2 holes, the largest about ("),
            std::string::npos)
      << Refusal("box.obj");
}

// As modellers that merge corners write them.
TEST_F(LoadShapeTest, SolidsThatMeetInAnEdgeAreTakenApart) {
  const TriangleMesh cube = Tessellate(Box{Vector3(1, 1, 1)});
  TriangleMesh two = cube;
  AppendMesh(two, Transformed(cube, At(1, 1, 0)));
  two = WeldVertices(two, 0.0);
  ASSERT_EQ(FindDefects(two).crowded_edges, 1);
  Write("edge.obj", testing::ObjText(two));
  const Shape shape = LoadAny("edge.obj");
  ASSERT_EQ(std::get<Union>(shape).parts.size(), 2U);
  EXPECT_NEAR(CalcVolume(shape), 2.0, 1e-6);
  AppendMesh(two, Transformed(cube, At(2, 0, 0)));  // its edges meet those of both neighbours
  Write("chain.obj", testing::ObjText(WeldVertices(two, 0.0)));
  EXPECT_NEAR(CalcVolume(LoadAny("chain.obj")), 3.0, 1e-6);
}

TEST_F(LoadShapeTest, RefusesMoreThanTwoTrianglesAtAnEdge) {
  TriangleMesh two = Tessellate(Box{Vector3(1, 1, 1)});
  TriangleMesh other = Transformed(Tessellate(Box{Vector3(1, 1, 1)}), At(1, 1, 0));
  other.F.col(0).swap(other.F.col(1));  // inside out: nothing says what belongs together
  AppendMesh(two, other);
  Write("edge.obj", testing::ObjText(WeldVertices(two, 0.0)));
  EXPECT_EQ(Refusal("edge.obj"),
            "a.lua:7: object.shape: expected a mesh with two triangles at each edge, got "
            "\"edge.obj\", which has more at 1 edge");
}

TEST_F(LoadShapeTest, RefusesASurfaceWithOneSide) {
  // The projective plane of six vertices: closed, every edge has two triangles, no inside.
  TriangleMesh mesh;
  mesh.V.resize(6, 3);
  mesh.V << 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0.3, 0.2, -1, 0, 0, 0.1, -1;
  mesh.F.resize(10, 3);
  mesh.F << 0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0, 5, 1, 1, 2, 4, 2, 3, 5, 3, 4, 1, 4, 5, 2, 5, 1,
      3;
  ASSERT_EQ(FindDefects(mesh).open_edges, 0);
  Write("plane.obj", testing::ObjText(mesh));
  EXPECT_NE(Refusal("plane.obj").find("one side only"), std::string::npos);
}

TEST_F(LoadShapeTest, RefusesAMeshWithoutVolume) {
  TriangleMesh flat = Tessellate(Box{Vector3(1, 1, 1)});
  flat.V.col(2).setZero();
  Write("flat.obj", testing::ObjText(flat));
  EXPECT_NE(Refusal("flat.obj"), "accepted");
  TriangleMesh folded;
  folded.V.resize(3, 3);
  folded.V << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  folded.F.resize(2, 3);
  folded.F << 0, 1, 2, 0, 2, 1;
  Write("folded.obj", testing::ObjText(folded));
  EXPECT_NE(Refusal("folded.obj").find("encloses"), std::string::npos);
}

TEST_F(LoadShapeTest, RefusesCoordinatesThatAreNotFinite) {
  const TriangleMesh mesh = Tessellate(Box{Vector3(1, 1, 1)});
  std::string stl = testing::BinaryStl(mesh);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  stl.replace(84 + 50 * 3 + 12, 4, reinterpret_cast<const char*>(&nan), 4);
  Write("nan.stl", stl);
  EXPECT_NE(Refusal("nan.stl").find("finite"), std::string::npos) << Refusal("nan.stl");
}

TEST_F(LoadShapeTest, RefusesWhatIsNoMesh) {
  Write("empty.obj", "");
  Write("rubbish.obj", "Dear Sir or Madam,\n\nplease find enclosed no mesh at all.\n");
  Write("rubbish.ply", "Dear Sir or Madam,\n\nplease find enclosed no mesh at all.\n");
  Write("rubbish.stl", std::string(200, '\x7f'));
  Write("cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n");
  Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  Write("notes.txt", "hello");
  fs::create_directories(directory_ / "folder.obj");
  for (const char* name : {"empty.obj", "rubbish.obj", "rubbish.ply", "rubbish.stl", "cut.ply",
                           "points.obj", "notes.txt", "folder.obj", "missing.obj", ""}) {
    const std::string refusal = Refusal(name);
    EXPECT_EQ(refusal.rfind("a.lua:7: object.shape: expected ", 0), 0U) << name << ": " << refusal;
    EXPECT_EQ(refusal.find('\n'), std::string::npos) << name;
  }
  EXPECT_NE(Refusal("missing.obj").find("\"missing.obj\", which does not exist"),
            std::string::npos);
}

TEST_F(LoadShapeTest, RefusesFacesThatNameNoVertex) {
  Write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  Write("index.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
        "0\n0 1 0\n3 0 1 7\n");
  EXPECT_NE(Refusal("index.obj"), "accepted");
  EXPECT_NE(Refusal("index.ply"), "accepted");
}

TEST_F(LoadShapeTest, RefusesAFileThatEndsEarlyAtEveryLength) {
  const TriangleMesh mesh = Tessellate(Box{Vector3(1, 1, 1)});
  for (const std::string encoding : {"ascii", "binary_little_endian"}) {
    const std::string whole = testing::PlyText(mesh, encoding);
    Write("whole.ply", whole);
    EXPECT_NEAR(CalcVolume(Load("whole.ply")), 1.0, 1e-6) << encoding;
    for (std::size_t length = 0; length + 2 < whole.size(); length += 7) {
      Write("cut.ply", whole.substr(0, length));
      EXPECT_NE(Refusal("cut.ply"), "accepted") << encoding << " " << length;
    }
  }
}

TEST_F(LoadShapeTest, AMeshInMillimetresIsToldToBeScaled) {
  Write("mm.obj", testing::ObjText(Tessellate(Box{Vector3(120, 80, 60)})));
  EXPECT_NE(Refusal("mm.obj").find("scale"), std::string::npos);
}

TEST_F(LoadShapeTest, ReadsACloudInAnyEncodingAndScalesIt) {
  TriangleMesh points;
  points.V = 1000.0 * SamplePointCloud(Sphere{0.04}, 1000, Rng(1)).P;
  points.F.resize(0, 3);
  for (const std::string encoding : {"ascii", "binary_little_endian"}) {
    Write("ball.ply", testing::PlyText(points, encoding));
    Cloud cloud;
    cloud.file = "ball.ply";
    cloud.scale = 0.001;
    Shape shape = cloud;
    LoadShape(shape, directory_, "a.lua:7", "object.shape");
    EXPECT_NEAR(CalcVolume(shape) / CalcVolume(Sphere{0.04}), 1.0, 0.05) << encoding;
    EXPECT_EQ(std::get<Cloud>(shape).points.rows(), 1000);
  }
}

TEST_F(LoadShapeTest, RefusesACloudThatIsNone) {
  const auto refusal = [&](const std::string& name) -> std::string {
    Cloud cloud;
    cloud.file = name;
    Shape shape = cloud;
    try {
      LoadShape(shape, directory_, "a.lua:7", "object.shape");
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  TriangleMesh few = Tessellate(Box{Vector3(1, 1, 1)});
  few.F.resize(0, 3);
  Write("few.ply", testing::PlyText(few, "ascii"));
  Write("lost.ply",
        std::regex_replace(testing::PlyText(few, "ascii"), std::regex("\n0.5 "), "\nnan "));
  Write("cut.ply", testing::PlyText(few, "ascii").substr(0, 150));
  Write("a.obj", testing::ObjText(Tessellate(Box{Vector3(1, 1, 1)})));
  EXPECT_EQ(refusal("few.ply"),
            "a.lua:7: object.shape: expected at least 100 points, got \"few.ply\", which has 8");
  EXPECT_EQ(refusal("lost.ply"),
            "a.lua:7: object.shape: expected a cloud of the points that were seen, with the others "
            "left out, got \"lost.ply\", with 4 of 8 points not finite");
  EXPECT_EQ(refusal("cut.ply").rfind("a.lua:7: object.shape: expected a PLY file", 0), 0U);
  EXPECT_NE(refusal("a.obj").find(".ply"), std::string::npos);
  EXPECT_NE(refusal("gone.ply").find("does not exist"), std::string::npos);
}

TEST_F(LoadShapeTest, NamesThePartOfAUnion) {
  Union whole;
  whole.parts.push_back({Box{Vector3(1, 1, 1)}, RigidTransform::Identity()});
  Mesh missing;
  missing.file = "gone.stl";
  whole.parts.push_back({missing, RigidTransform::Identity()});
  Shape shape = whole;
  try {
    LoadShape(shape, directory_, "a.lua:7", "object.shape");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.field(), "object.shape[2]");
  }
}

TEST_F(LoadShapeTest, FillsInMassPropertiesOnlyWhereTheSceneGaveNone) {
  Write("a.obj",
        testing::ObjText(Transformed(Tessellate(Box{Vector3(0.1, 0.2, 0.3)}), At(1, 0, 0))));
  Mesh mesh;
  mesh.file = "a.obj";
  Scene scene;
  scene.bodies.resize(3);
  for (Body& body : scene.bodies) {
    body.shape = mesh;
    body.mass_properties = MassProperties{2.0, Vector3::Zero(), Matrix3::Zero()};
  }
  scene.bodies[1].mass_properties->p_BoBcm = Vector3(1, 0, 0.05);
  scene.bodies[1].mass_properties->I_BBcm = Matrix3::Identity();
  scene.bodies[2].com_given = true;
  LoadShapes(scene, directory_);
  const Matrix3 uniform = CalcMassProperties(Box{Vector3(0.1, 0.2, 0.3)}, 2.0).I_BBcm;
  EXPECT_LT((scene.bodies[0].mass_properties->p_BoBcm - Vector3(1, 0, 0)).norm(), 1e-6);
  EXPECT_LT((scene.bodies[0].mass_properties->I_BBcm - uniform).norm(), 1e-6 * uniform.norm());
  EXPECT_EQ(scene.bodies[1].mass_properties->p_BoBcm, Vector3(1, 0, 0.05));
  EXPECT_EQ(scene.bodies[1].mass_properties->I_BBcm, Matrix3::Identity());
  EXPECT_EQ(scene.bodies[2].mass_properties->p_BoBcm, Vector3::Zero());
}

}  // namespace
}  // namespace pregrasp
