#include "app/geometry/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/geometry/mass_properties.h"
#include "app/geometry/point_cloud.h"
#include "app/geometry/point_index.h"
#include "app/geometry/signed_distance.h"
#include "tests/geometry/test_shapes.h"

namespace pregrasp {
namespace {

using testing::MakeMesh;

// Independent uniform points on the surface, with holes and crowds as chance has them, moved by
// `noise` [m] along each axis.
PointCloud SampleByChance(const Shape& shape, int count, double noise, Rng rng) {
  const TriangleMesh mesh = Tessellate(shape, 96);
  std::vector<double> sums;
  double sum = 0.0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    sums.push_back(sum += (b - a).cross(c - a).norm());
  }
  PointCloud cloud{MatrixX3(count, 3), MatrixX3(count, 3)};
  for (int i = 0; i < count; ++i) {
    const auto it = std::lower_bound(sums.begin(), sums.end() - 1, sum * rng.Uniform());
    const auto f = static_cast<int>(it - sums.begin());
    const double s = std::sqrt(rng.Uniform()), t = rng.Uniform();
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)),
                  c = mesh.V.row(mesh.F(f, 2));
    cloud.P.row(i) = (1 - s) * a + s * (1 - t) * b + s * t * c;
    cloud.P.row(i) += noise * Vector3(rng.Normal(), rng.Normal(), rng.Normal()).transpose();
    cloud.N.row(i) = (b - a).cross(c - a).normalized();
  }
  return cloud;
}

struct Expectation {
  std::string name;
  Shape shape;
  MatrixX3 P;
  MatrixX3 N;
  int euler_number;
  double volume_error;  // relative
  double mean;          // of true surface points to the mesh, in spacings
  double largest;       // of the mesh to the true surface, in spacings
};

void Check(const Expectation& expected) {
  const Reconstruction made = ReconstructSurface(expected.P, expected.N);
  EXPECT_TRUE(FindDefects(made.mesh).closed()) << expected.name;
  EXPECT_EQ(made.euler_number, expected.euler_number) << expected.name;
  EXPECT_EQ(CalcEulerNumber(made.mesh), expected.euler_number) << expected.name;
  EXPECT_NEAR(CalcVolume(made.mesh) / CalcVolume(expected.shape), 1.0, expected.volume_error)
      << expected.name;
  const SignedDistance truth(expected.shape), found(MakeMesh(made.mesh));
  const PointCloud even = SamplePointCloud(expected.shape, 400, Rng(5));
  double sum = 0.0;
  for (int i = 0; i < even.P.rows(); ++i) sum += std::abs(found.Calc(even.P.row(i)));
  EXPECT_LT(sum / static_cast<double>(even.P.rows()), expected.mean * made.spacing)
      << expected.name;
  double largest = 0.0;
  for (int v = 0; v < made.mesh.V.rows(); ++v) {
    largest = std::max(largest, std::abs(truth.Calc(made.mesh.V.row(v))));
  }
  EXPECT_LT(largest, expected.largest * made.spacing) << expected.name;
  // What it says of itself is true.
  sum = 0.0;
  for (int i = 0; i < expected.P.rows(); ++i) sum += std::abs(found.Calc(expected.P.row(i)));
  EXPECT_NEAR(made.mean_error, sum / static_cast<double>(expected.P.rows()), 1e-9) << expected.name;
}

Expectation Even(const std::string& name, const Shape& shape, int count, bool normals, int euler,
                 double volume, double mean, double largest) {
  const PointCloud cloud = SamplePointCloud(shape, count, Rng(1));
  return {name, shape, cloud.P, normals ? cloud.N : MatrixX3(0, 3), euler, volume, mean, largest};
}

Expectation ByChance(const std::string& name, const Shape& shape, int count, double noise,
                     bool normals, int seed, double volume, double mean, double largest) {
  const PointCloud cloud = SampleByChance(shape, count, noise, Rng(seed));
  return {name, shape, cloud.P, normals ? cloud.N : MatrixX3(0, 3), 2, volume, mean, largest};
}

TEST(ReconstructTest, OfEvenPointsIsTheShapeWithSharpEdges) {
  Check(Even("ball", Sphere{0.04}, 1000, false, 2, 0.02, 0.05, 0.3));
  Check(Even("box", Box{Vector3(0.1, 0.06, 0.04)}, 1000, false, 2, 0.02, 0.06, 0.4));
  Check(Even("torus", MakeMesh(testing::MakeTorus(0.04, 0.012, 64, 32)), 2000, false, 0, 0.04, 0.08,
             0.4));
  Check(Even("C", MakeMesh(testing::MakeC(0.03, 0.02)), 3000, false, 2, 0.02, 0.06, 0.5));
}

TEST(ReconstructTest, KeepsAThinPlateWhosePointsAreCloserThanItIsThick) {
  const Shape ruler = Box{Vector3(0.3, 0.03, 0.003)};
  Check(Even("2 mm apart", ruler, 5000, false, 2, 0.06, 0.1, 1.5));
  Check(ByChance("by chance", ruler, 12000, 0.0, true, 1, 0.03, 0.05, 2.0));
}

TEST(ReconstructTest, OpensHollowsWhoseWallsThePointsResolve) {
  const Shape cup = MakeMesh(testing::MakeCup(0.04, 0.1, 0.006, 64));
  Check(Even("cup", cup, 3000, false, 2, 0.04, 0.1, 1.5));
  Check(Even("cup with normals", cup, 3000, true, 2, 0.04, 0.08, 0.8));
  Check(ByChance("by chance", cup, 8000, 0.0, true, 1, 0.03, 0.05, 2.0));
  Check(ByChance("noisy", cup, 10000, 2e-4, false, 1, 0.05, 0.12, 2.0));
}

TEST(ReconstructTest, TakesChanceSpacingAndNoiseWithAndWithoutNormals) {
  const Shape box = Box{Vector3(0.1, 0.06, 0.04)}, can = Cylinder{0.033, 0.1},
              capsule = Capsule{0.02, 0.06};
  for (int seed = 0; seed < 3; ++seed) {
    const bool normals = seed == 1;
    Check(ByChance("box", box, 2000, 0.0, normals, seed, 0.02, 0.03, 2.0));
    Check(ByChance("can", can, 2000, 0.0, normals, seed, 0.02, 0.05, 2.0));
    Check(ByChance("noisy capsule", capsule, 2000, 3e-4, normals, seed, 0.03, 0.2, 2.0));
  }
}

// As estimators without an orientation leave them.
TEST(ReconstructTest, NormalsThatPointToEitherSideAreNotBelieved) {
  const Shape box = Box{Vector3(0.1, 0.06, 0.04)}, can = Cylinder{0.033, 0.1};
  for (const Shape& shape : {box, can}) {
    for (const double noise : {0.0, 3e-4}) {
      PointCloud cloud = SampleByChance(shape, 2000, noise, Rng(5));
      Rng rng(6);
      for (Eigen::Index i = 0; i < cloud.N.rows(); ++i) {
        if (rng.UniformInt(2) == 1) cloud.N.row(i) *= -1.0;
      }
      const Reconstruction made = ReconstructSurface(cloud.P, cloud.N);
      const Reconstruction without = ReconstructSurface(cloud.P, MatrixX3(0, 3));
      EXPECT_EQ(made.mesh.V, without.mesh.V);
      EXPECT_NEAR(CalcVolume(made.mesh), CalcVolume(shape), 0.04 * CalcVolume(shape));
    }
  }
}

// As scanners leave them that look from inside the frame that they think in.
TEST(ReconstructTest, NormalsThatAllPointInwardAreTurned) {
  const Shape box = Box{Vector3(0.1, 0.06, 0.04)};
  const Shape cup = MakeMesh(testing::MakeCup(0.04, 0.1, 0.006, 64));
  for (const Shape& shape : {box, cup}) {
    const PointCloud cloud = SampleByChance(shape, 8000, 0.0, Rng(3));
    const Reconstruction outward = ReconstructSurface(cloud.P, cloud.N);
    const Reconstruction inward = ReconstructSurface(cloud.P, -cloud.N);
    EXPECT_EQ(inward.mesh.V, outward.mesh.V);
    EXPECT_NEAR(CalcVolume(inward.mesh), CalcVolume(shape), 0.04 * CalcVolume(shape));
  }
}

TEST(ReconstructTest, ReachesNoFartherOutThanThePointsWhereTheyLieFlat) {
  // A body must stand on the plane of its lowest points, not on spikes at its corners.
  for (int seed = 0; seed < 5; ++seed) {
    const PointCloud cloud = SampleByChance(Box{Vector3(0.1, 0.06, 0.04)}, 2000, 0.0, Rng(seed));
    const Reconstruction made = ReconstructSurface(cloud.P, MatrixX3(0, 3));
    const Vector3 reach = made.mesh.V.cwiseAbs().colwise().maxCoeff();
    EXPECT_LT((reach - Vector3(0.05, 0.03, 0.02)).maxCoeff(), 0.5 * made.spacing) << seed;
  }
}

TEST(ReconstructTest, RefusesWhatIsNoClosedSurface) {
  const MatrixX3 none(0, 3);
  EXPECT_THROW(ReconstructSurface(SamplePointCloud(Sphere{0.1}, 50, Rng(1)).P, none),
               UnclosedCloud);
  // All in one place, on a line, in a plane.
  MatrixX3 P = MatrixX3::Constant(500, 3, 0.25);
  EXPECT_THROW(ReconstructSurface(P, none), UnclosedCloud);
  for (int i = 0; i < P.rows(); ++i) P(i, 0) = 0.001 * i;
  EXPECT_THROW(ReconstructSurface(P, none), UnclosedCloud);
  Rng rng(2);
  for (int i = 0; i < P.rows(); ++i) P(i, 1) = 0.5 * rng.Uniform();
  EXPECT_THROW(ReconstructSurface(P, none), UnclosedCloud);
  // A wall thinner than half the spacing of points that chance placed.
  const Shape cup = MakeMesh(testing::MakeCup(0.04, 0.1, 0.002, 64));
  EXPECT_THROW(ReconstructSurface(SampleByChance(cup, 2000, 0.0, Rng(3)).P, none), UnclosedCloud);
}

// What is wrong with a cloud is said as it is, not as holes that come of it.
TEST(ReconstructTest, RefusesASideAloneAndATableWithTheirReasons) {
  const MatrixX3 all = SamplePointCloud(Box{Vector3(0.09, 0.07, 0.05)}, 4000, Rng(7)).P;
  const auto refusal = [](const std::vector<Vector3>& points) -> std::string {
    MatrixX3 P(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i) P.row(static_cast<Eigen::Index>(i)) = points[i];
    try {
      ReconstructSurface(P, MatrixX3(0, 3));
    } catch (const UnclosedCloud& error) {
      return error.got;
    }
    return "accepted";
  };
  std::vector<Vector3> seen, standing;
  for (int i = 0; i < all.rows(); ++i) {
    const Vector3 p = all.row(i);
    if (p.x() > 0.0449 || p.z() > 0.0249) seen.push_back(p);
    standing.push_back(p);
  }
  for (double x = -0.15; x < 0.15; x += 0.003) {
    for (double y = -0.12; y < 0.12; y += 0.003) standing.emplace_back(x, y, -0.025);
  }
  EXPECT_EQ(refusal(seen).find("whose points end along a rim"), 0U) << refusal(seen);
  EXPECT_NE(refusal(standing).find("lie in a sheet that reaches beyond all others"),
            std::string::npos)
      << refusal(standing);
}

TEST(ReconstructTest, IsTheSameEachTime) {
  const MatrixX3 P = SampleByChance(Capsule{0.02, 0.05}, 2000, 0.0, Rng(4)).P;
  EXPECT_EQ(ReconstructSurface(P, MatrixX3(0, 3)).mesh.V,
            ReconstructSurface(P, MatrixX3(0, 3)).mesh.V);
}

TEST(ReconstructTest, UsesAnEvenShareOfManyPoints) {
  const MatrixX3 P = SampleByChance(Sphere{0.04}, 30000, 0.0, Rng(4)).P;
  const Reconstruction made = ReconstructSurface(P, MatrixX3(0, 3));
  EXPECT_LE(made.mesh.F.rows(), 8000);
  EXPECT_NEAR(CalcVolume(made.mesh), CalcVolume(Sphere{0.04}), 0.005 * CalcVolume(Sphere{0.04}));
}

TEST(PointIndexTest, AgreesWithSearchingAllPoints) {
  Rng rng(6);
  MatrixX3 P(500, 3);
  for (int i = 0; i < P.rows(); ++i) {
    P.row(i) << rng.Normal(), 0.01 * rng.Normal(), 5.0 * rng.Uniform();
  }
  const PointIndex index(P, 0.2);
  std::vector<int> found;
  for (int i = 0; i < 200; ++i) {
    const Vector3 p(2 * rng.Normal(), rng.Normal(), rng.Uniform(-1, 6));
    const double radius = rng.Uniform(0.0, 2.0);
    std::vector<std::pair<double, int>> all;
    std::vector<int> within;
    for (int j = 0; j < P.rows(); ++j) {
      all.emplace_back((P.row(j).transpose() - p).squaredNorm(), j);
      if (all.back().first <= radius * radius) within.push_back(j);
    }
    index.FindWithin(p, radius, found);
    EXPECT_EQ(found, within);
    std::sort(all.begin(), all.end());
    index.FindNearest(p, 7, found);
    ASSERT_EQ(found.size(), 7U);
    for (int k = 0; k < 7; ++k) EXPECT_EQ(found[k], all[k].second);
  }
  index.FindNearest(Vector3::Zero(), 1000, found);
  EXPECT_EQ(found.size(), 500U);
}

}  // namespace
}  // namespace pregrasp
