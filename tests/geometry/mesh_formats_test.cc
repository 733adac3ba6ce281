// Meshes as people have them: legal files are read as they are meant, others are refused by name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "app/core/error.h"
#include "app/geometry/load_shape.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/polygon.h"
#include "app/geometry/read_text_mesh.h"
#include "app/geometry/signed_distance.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

class MeshFormatsTest : public ::testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }

  Shape Load(const std::string& name, double scale = 1.0) const {
    Mesh mesh;
    mesh.file = name;
    mesh.scale = scale;
    Shape shape = mesh;
    LoadShape(shape, folder_.path(), "a.lua:7", "object.shape");
    return shape;
  }

  std::string FormatProblem(const std::string& name) const {
    try {
      Load(name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  const TestFolder folder_;
};

// A channel of U-shaped cross-section as polygons: its ends have a hollow, with the first corner
// where a fan would leave the U.
struct Channel {
  std::vector<Vector3> corners;
  std::vector<std::vector<int>> faces;

  Channel() {
    const std::vector<Vector2> outline{{0.02, 0.06}, {0, 0.06},    {0, 0},       {0.08, 0},
                                       {0.08, 0.06}, {0.06, 0.06}, {0.06, 0.01}, {0.02, 0.01}};
    const int n = static_cast<int>(outline.size());
    for (const double z : {0.0, 0.03}) {
      for (const Vector2& p : outline) corners.emplace_back(p.x(), p.y(), z);
    }
    std::vector<int> bottom, top;
    for (int i = 0; i < n; ++i) {
      bottom.push_back(n - 1 - i);
      top.push_back(n + i);
      faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    faces.push_back(bottom);
    faces.push_back(top);
  }

  // The lines of corners and faces; each face begins with the number of its corners.
  std::string Lines() const {
    std::string text;
    for (const Vector3& p : corners) {
      text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    }
    for (const std::vector<int>& face : faces) {
      text += fmt::format("{}", face.size());
      for (const int corner : face) text += fmt::format(" {}", corner);
      text += '\n';
    }
    return text;
  }

  static constexpr double kVolume = (0.08 * 0.06 - 0.04 * 0.05) * 0.03;
};

TEST_F(MeshFormatsTest, AHollowPolygonKeepsItsHollowInPlyAndOff) {
  const Channel channel;
  const std::string lines = channel.Lines();
  Write("u.ply", fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty "
                             "float y\nproperty float z\nelement face {}\nproperty list uchar int "
                             "vertex_indices\nend_header\n{}",
                             channel.corners.size(), channel.faces.size(), lines));
  Write("u.off",
        fmt::format("OFF\n{} {} 0\n{}", channel.corners.size(), channel.faces.size(), lines));
  for (const char* name : {"u.ply", "u.off"}) {
    const Shape shape = Load(name);
    EXPECT_NEAR(CalcVolume(shape), Channel::kVolume, 1e-9) << name;
    const SignedDistance distance(shape);
    EXPECT_NEAR(distance.Calc({0.04, 0.035, 0.015}), 0.02, 1e-9) << name;  // the hollow's middle
    EXPECT_NEAR(distance.Calc({0.01, 0.030, 0.015}), -0.01, 1e-9) << name;
  }
}

// A block of 3 x 2 x 1 cm.
const char* const kBlockCorners[] = {"0 0 0",    "0.03 0 0",    "0.03 0.02 0",    "0 0.02 0",
                                     "0 0 0.01", "0.03 0 0.01", "0.03 0.02 0.01", "0 0.02 0.01"};
const char* const kBlockFaces[] = {"4 0 3 2 1", "4 4 5 6 7", "4 0 1 5 4",
                                   "4 1 2 6 5", "4 2 3 7 6", "4 3 0 4 7"};

Vector3 ExtentOf(const Shape& shape) {
  const MatrixX3& V = std::get<Mesh>(shape).mesh.V;
  return V.colwise().maxCoeff() - V.colwise().minCoeff();
}

TEST_F(MeshFormatsTest, OffMayHaveCommentsEmptyLinesAndColoursAnywhere) {
  std::string plain,
      commented = "# a block\n\n COFF # with colours\n\n# counts\n8 6 12 # edges\n\n";
  for (const char* corner : kBlockCorners) {
    plain += std::string(corner) + '\n';
    commented += std::string("  ") + corner + " 255 0 0 255 # corner\n#\n\n";
  }
  for (const char* face : kBlockFaces) {
    plain += std::string(face) + '\n';
    commented += std::string(face) + " 0.5 0.5 0.5\n\n# face\n";
  }
  Write("plain.off", "OFF\n8 6 12\n" + plain);
  Write("short.off", "OFF 8 6 12\r\n" + plain);
  Write("bare.off", "8 6 12\n" + plain);
  Write("commented.off", commented + "# the end");
  for (const char* name : {"plain.off", "short.off", "bare.off", "commented.off"}) {
    EXPECT_LT((ExtentOf(Load(name)) - Vector3(0.03, 0.02, 0.01)).norm(), 1e-12) << name;
  }
  const auto problem = [&](const std::string& text) {
    Write("bad.off", text);
    return FormatProblem("bad.off");
  };
  EXPECT_NE(problem("OFF\n8 6 12\n0 0 0\n1 0 0\n").find("has 2 of 8 vertices"), std::string::npos);
  EXPECT_NE(problem("OFF\n1 1 0\n0 0 0\n3 0 1 2\n").find("vertex 1 of 1"), std::string::npos);
  EXPECT_NE(problem("OFF\n4000000000 1 0\n0 0 0\n").find("1 of 4000000000"), std::string::npos);
  EXPECT_NE(problem("OFF BINARY\n").find("is binary"), std::string::npos);
  EXPECT_NE(problem("OFF\n1 1 0\n0 0 x\n").find("\"x\" for a number"), std::string::npos);
}

TEST_F(MeshFormatsTest, NormalsOfAnStlDoNotMatter) {
  const auto stl = [](const std::string& normal) {
    const Channel channel;
    std::string text = "solid channel\n";
    const TriangleMesh mesh = ParseOff(fmt::format("OFF\n{} {} 0\n{}", channel.corners.size(),
                                                   channel.faces.size(), channel.Lines()));
    for (int f = 0; f < mesh.F.rows(); ++f) {
      text += "  facet normal " + normal + "\n    outer loop\n";
      for (int i = 0; i < 3; ++i) {
        const Vector3 p = mesh.V.row(mesh.F(f, i));
        text += fmt::format("      vertex {:e} {:e} {:e}\n", p.x(), p.y(), p.z());
      }
      text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid channel\n";
  };
  for (const char* normal :
       {"0 0 0", "nan nan nan", "-nan(ind) -nan(ind) -nan(ind)", "1.#QNAN 0 0"}) {
    Write("u.stl", stl(normal));
    EXPECT_NEAR(CalcVolume(Load("u.stl")), Channel::kVolume, 1e-8) << normal;
  }
  Write("cut.stl", stl("0 0 0").substr(0, 400));
  EXPECT_NE(FormatProblem("cut.stl"), "accepted");
}

TEST_F(MeshFormatsTest, AColladaFileIsNotTurnedAndItsUnitCounts) {
  const auto dae = [](const std::string& up, const std::string& metre) {
    std::string corners, faces;
    for (const char* corner : kBlockCorners) corners += std::string(corner) + ' ';
    for (const char* f : {"0 3 2", "0 2 1", "4 5 6", "4 6 7", "0 1 5", "0 5 4", "1 2 6", "1 6 5",
                          "2 3 7", "2 7 6", "3 0 4", "3 4 7"}) {
      faces += std::string(f) + ' ';
    }
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")" +
           metre + R"("/><up_axis>)" + up +
           R"(</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="24">)" +
           corners + R"(</float_array><technique_common><accessor source="#pa" count="8" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="12">
<input semantic="VERTEX" source="#v" offset="0"/><p>)" +
           faces + R"(</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  };
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    Write("block.dae", dae(up, "1"));
    EXPECT_LT((ExtentOf(Load("block.dae")) - Vector3(0.03, 0.02, 0.01)).norm(), 1e-7) << up;
  }
  Write("inches.dae", dae("Z_UP", "0.0254"));
  EXPECT_LT((ExtentOf(Load("inches.dae", 10.0)) - 0.254 * Vector3(0.03, 0.02, 0.01)).norm(), 1e-7);
}

TEST_F(MeshFormatsTest, FacesGivenTwiceAndTriangleStripsAreRefusedByName) {
  std::string text;
  for (const char* corner : kBlockCorners) text += std::string("v ") + corner + '\n';
  for (const char* f : {"1 4 3", "1 3 2", "5 6 7", "5 7 8", "1 2 6", "1 6 5", "2 3 7", "2 7 6",
                        "3 4 8", "3 8 7", "4 1 5", "4 5 8"}) {
    text += std::string("f ") + f + '\n';
  }
  Write("once.obj", text);
  EXPECT_EQ(FormatProblem("once.obj"), "accepted");
  Write("twice.obj", text + "f 3 4 1\nf 3 4 1\nf 2 3 1\n");
  EXPECT_NE(FormatProblem("twice.obj").find("3 faces given twice"), std::string::npos);
  Write("strips.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 "
        "0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_NE(FormatProblem("strips.ply").find("triangle strips, which are not read"),
            std::string::npos);
}

TEST(PolygonTest, TrianglesCoverAPolygonOfAnyShapeOnce) {
  Rng rng(5);
  for (int trial = 0; trial < 200; ++trial) {
    // A star around a point: simple, with hollows, in a plane of any direction.
    const int n = 4 + trial % 20;
    const Matrix3 R =
        RotationFromRpy({6.0 * rng.Uniform(), 6.0 * rng.Uniform(), 6.0 * rng.Uniform()});
    std::vector<Vector3> corners;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * i / n, radius = 0.2 + rng.Uniform();
      corners.push_back(R * Vector3(radius * std::cos(angle), radius * std::sin(angle), 0.3));
    }
    const Vector3 nhat = R.col(2);
    double area = 0.0, covered = 0.0;
    for (int i = 0; i < n; ++i) {
      area += 0.5 * nhat.dot((corners[i] - 0.3 * nhat).cross(corners[(i + 1) % n] - 0.3 * nhat));
    }
    const auto triangles = TriangulatePolygon(corners);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    for (const auto& [a, b, c] : triangles) {
      const double part = 0.5 * nhat.dot((corners[b] - corners[a]).cross(corners[c] - corners[a]));
      EXPECT_GT(part, 0.0);  // turned as the polygon is
      covered += part;
    }
    EXPECT_NEAR(covered, area, 1e-12);
  }
}

TEST(PolygonTest, AConvexOneIsAFanAndWhatIsNoneGivesNothing) {
  const std::vector<Vector3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(TriangulatePolygon(square), (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(TriangulatePolygon({square.data(), 2}).empty());
  const std::vector<Vector3> point(5, Vector3(1, 2, 3));
  EXPECT_EQ(TriangulatePolygon(point).size(), 3U);
  const std::vector<Vector3> crossing{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  EXPECT_EQ(TriangulatePolygon(crossing).size(), 3U);
}

}  // namespace
}  // namespace pregrasp
