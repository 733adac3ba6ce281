#include "app/training/training_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "app/core/check.h"
#include "app/geometry/hull.h"
#include "app/geometry/mass_properties.h"
#include "app/geometry/signed_distance.h"
#include "app/geometry/tessellate.h"

namespace pregrasp {
namespace {

constexpr double kTable = 1.2;  // side of a table [m]
constexpr double kTableThickness = 0.04;
constexpr double kWallThickness = 0.02;

// Whether the foot of the perpendicular from p to the plane of a, b, c (normal n) is in the
// triangle.
bool FootIsInside(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c,
                  const Vector3& n) {
  return n.dot((b - a).cross(p - a)) >= 0.0 && n.dot((c - b).cross(p - b)) >= 0.0 &&
         n.dot((a - c).cross(p - c)) >= 0.0;
}

// The solid angle of a triangle seen from the origin (van Oosterom and Strackee 1983).
double CalcSolidAngle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(std::abs(a.dot(b.cross(c))),
                          la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la);
}

struct Face {
  Vector3 nhat;
  double offset = 0.0, angle = 0.0;
  bool stable = false;
};

Vector3 Level(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

// Turns a level direction that is square to the object, or nearly, or any.
double DrawHeading(double object_heading, Rng& rng) {
  if (rng.Uniform() < 0.3) return rng.Uniform(0.0, 2.0 * kPi);
  return object_heading + 0.5 * kPi * rng.UniformInt(4) + DegToRad(4.0) * rng.Normal();
}

// A scene under construction, its object in place with its lowest point at height `bottom`.
class SceneDraft {
 public:
  SceneDraft(const SceneObject& object, const Matrix3& R_WO, double bottom, double heading)
      : object_(object), heading_(heading) {
    P_W_ = object.surface * R_WO.transpose();
    const Vector3 low = P_W_.colwise().minCoeff(), high = P_W_.colwise().maxCoeff();
    const Vector3 p_WO(-0.5 * (low.x() + high.x()), -0.5 * (low.y() + high.y()), bottom - low.z());
    P_W_.rowwise() += p_WO.transpose();
    Body body;
    body.name = "object";
    body.shape = object.object.shape;
    body.X_WB = MakeTransform(R_WO, p_WO);
    body.mass_properties = object.mass;
    scene_.bodies.push_back(body);
    height_ = high.z() - low.z() + bottom;
  }

  double ExtentAlong(const Vector3& dir) const { return (P_W_ * dir).maxCoeff(); }
  double WidthAlong(const Vector3& dir) const { return ExtentAlong(dir) + ExtentAlong(-dir); }
  double height() const { return height_; }
  double heading() const { return heading_; }
  Vector3 p_WOcm() const { return scene_.object().X_WB * object_.mass.p_BoBcm; }

  void AddBox(const std::string& name, const Vector3& size, double yaw, const Vector3& p_W) {
    Body body;
    body.name = name + std::to_string(scene_.bodies.size());
    body.shape = Box{size};
    body.X_WB = MakeTransform(RotationFromRpy({0.0, 0.0, yaw}), p_W);
    scene_.bodies.push_back(body);
  }

  void AddTable(Rng& rng) {
    AddBox("table", {kTable, kTable, kTableThickness}, rng.Uniform(0.0, kPi),
           {0.0, 0.0, -0.5 * kTableThickness});
  }

  // A table that ends under the object, or up to `inboard` beside it; at rest its centre of mass
  // stays on it.
  void AddTableEdge(bool at_rest, double inboard, Rng& rng) {
    const double yaw = DrawHeading(heading_, rng);
    edge_ = Level(yaw);
    const double reach = ExtentAlong(edge_);
    const double most = at_rest ? reach - p_WOcm().dot(edge_) - 0.003 : 0.6 * WidthAlong(edge_);
    const double over = rng.Uniform(-inboard, std::max(0.0, most));
    AddBox("table", {kTable, kTable, kTableThickness}, yaw,
           (reach - over - 0.5 * kTable) * edge_ + Vector3(0.0, 0.0, -0.5 * kTableThickness));
  }

  // Nothing stands beyond the table's edge.
  bool HasGround(const Vector3& dir) const { return edge_.dot(dir) < 0.3; }

  void AddWall(Rng& rng) {
    const double yaw = DrawHeading(heading_, rng);
    const Vector3 dir = Level(yaw);
    if (!HasGround(dir)) return;
    const double gap = rng.Uniform() < 0.6 ? rng.Uniform(0.0, 0.003) : rng.Uniform(0.003, 0.06);
    const double tall = rng.Uniform(0.03, 0.30);
    AddBox("wall", {kWallThickness, 0.6, tall}, yaw,
           (ExtentAlong(dir) + gap + 0.5 * kWallThickness) * dir + Vector3(0.0, 0.0, 0.5 * tall));
    walled_ = true;
  }

  void AddNeighbours(Rng& rng) {
    const double yaw = heading_ + 0.5 * kPi * rng.UniformInt(4);
    const double gap = rng.Uniform(0.0005, 0.006), thick = rng.Uniform(0.02, 0.09);
    const double tall = std::max(0.02, height_ * rng.Uniform(0.5, 1.3));
    const double wide = std::max(0.04, WidthAlong(Level(yaw + 0.5 * kPi)) * rng.Uniform(0.7, 1.4));
    for (const double side : {1.0, -1.0}) {
      const Vector3 dir = side * Level(yaw);
      if (!HasGround(dir) || rng.Uniform() < 0.15) continue;
      AddBox("neighbour", {thick, wide, tall}, yaw,
             (ExtentAlong(dir) + gap + 0.5 * thick) * dir + Vector3(0.0, 0.0, 0.5 * tall));
      neighboured_ = true;
    }
  }

  // Walls on all four sides but perhaps one, of a box or a drawer.
  void AddPen(Rng& rng) {
    const double tall = std::max(0.015, height_ * rng.Uniform(0.3, 1.2));
    const int open = rng.Uniform() < 0.5 ? static_cast<int>(rng.UniformInt(4)) : -1;
    for (int side = 0; side < 4; ++side) {
      const Vector3 dir = Level(heading_ + 0.5 * kPi * side);
      if (side == open || !HasGround(dir)) continue;
      const double gap =
          rng.Uniform() < 0.6 ? rng.Uniform(0.0005, 0.004) : rng.Uniform(0.004, 0.08);
      AddBox("side", {kWallThickness, 0.5, tall}, heading_ + 0.5 * kPi * side,
             (ExtentAlong(dir) + gap + 0.5 * kWallThickness) * dir + Vector3(0.0, 0.0, 0.5 * tall));
    }
    penned_ = true;
  }

  void AddCeiling(Rng& rng) {
    const double gap = rng.Uniform(0.005, 0.08);
    const Vector3 aside = rng.Uniform(0.0, 0.12) * Level(rng.Uniform(0.0, 2.0 * kPi));
    AddBox("shelf", {0.35, 0.35, 0.02}, heading_, aside + Vector3(0.0, 0.0, height_ + gap + 0.01));
  }

  bool walled() const { return walled_; }
  bool neighboured() const { return neighboured_; }
  bool penned() const { return penned_; }
  Scene Finish() {
    scene_.name = "training";
    return std::move(scene_);
  }

 private:
  const SceneObject& object_;
  double heading_, height_ = 0.0;
  MatrixX3 P_W_;
  Vector3 edge_ = Vector3::Zero();
  bool walled_ = false, neighboured_ = false, penned_ = false;
  Scene scene_;
};

const RestingPose& DrawRestingPose(const SceneObject& object, Rng& rng) {
  // Things stand as they are meant to, where they can, half of the time.
  if (rng.Uniform() < 0.5) {
    for (const RestingPose& pose : object.resting) {
      if (pose.R_WO(2, 2) > 0.999) return pose;
    }
  }
  double at = rng.Uniform();
  for (const RestingPose& pose : object.resting) {
    at -= pose.share;
    if (at < 0.0) return pose;
  }
  return object.resting.back();
}

}  // namespace

std::vector<RestingPose> FindRestingPoses(const MatrixX3& surface_O, const Vector3& p_OOcm) {
  const TriangleMesh hull = CalcConvexHull(surface_O);
  std::vector<Face> faces;
  for (int f = 0; f < hull.F.rows(); ++f) {
    const Vector3 a = Vector3(hull.V.row(hull.F(f, 0))) - p_OOcm;
    const Vector3 b = Vector3(hull.V.row(hull.F(f, 1))) - p_OOcm;
    const Vector3 c = Vector3(hull.V.row(hull.F(f, 2))) - p_OOcm;
    const Vector3 cross = (b - a).cross(c - a);
    if (cross.norm() < 1e-14) continue;
    const Vector3 nhat = cross.normalized();
    // Triangles of one plane are one face.
    auto face = std::find_if(faces.begin(), faces.end(), [&](const Face& known) {
      return known.nhat.dot(nhat) > 1.0 - 1e-9 && std::abs(known.offset - nhat.dot(a)) < 1e-7;
    });
    if (face == faces.end()) face = faces.insert(faces.end(), {nhat, nhat.dot(a)});
    face->angle += CalcSolidAngle(a, b, c);
    face->stable = face->stable || FootIsInside(Vector3::Zero(), a, b, c, nhat);
  }
  std::vector<RestingPose> poses;
  double total = 0.0;
  for (const Face& face : faces) {
    if (!face.stable) continue;
    const Quaternion q = Quaternion::FromTwoVectors(face.nhat, -Vector3::UnitZ());
    poses.push_back({q.toRotationMatrix(), face.angle});
    total += face.angle;
  }
  PREGRASP_CHECK(total > 0.0, faces.size());  // the nearest face is always stable
  for (RestingPose& pose : poses) pose.share /= total;
  return poses;
}

SceneObject MakeSceneObject(TrainingObject object) {
  SceneObject made;
  made.mass = CalcMassProperties(object.shape, object.mass);
  made.surface = Tessellate(object.shape).V;
  made.resting = FindRestingPoses(made.surface, made.mass.p_BoBcm);
  made.object = std::move(object);
  return made;
}

TrainingScene SampleTrainingScene(const SceneObject& object, Rng rng) {
  const double heading = rng.Uniform(0.0, 2.0 * kPi);
  const Matrix3 turn = RotationFromRpy({0.0, 0.0, heading});
  if (rng.UniformInt(8) == 0) {
    SceneDraft draft(object, rng.Rotation().toRotationMatrix(), 0.0, heading);
    return {"free", draft.Finish()};
  }
  Matrix3 R_WO = turn * DrawRestingPose(object, rng).R_WO;
  const bool tilted = rng.Uniform() < 0.4;
  if (tilted) {
    const double angle = DegToRad(rng.Uniform(1.0, 45.0));
    R_WO = Eigen::AngleAxisd(angle, Level(DrawHeading(heading, rng))).toRotationMatrix() * R_WO;
  }
  const bool raised = !tilted && rng.Uniform() < 0.15;
  SceneDraft draft(object, R_WO, raised ? rng.Uniform(0.001, 0.04) : 0.0, heading);
  const bool edge = rng.Uniform() < 0.5;
  if (edge) {
    draft.AddTableEdge(!tilted && !raised, 0.0, rng);
  } else {
    draft.AddTable(rng);
  }
  const double surroundings = rng.Uniform();
  if (surroundings < 0.25) draft.AddWall(rng);
  if (surroundings < 0.06) draft.AddWall(rng);
  if (surroundings > 0.85) draft.AddNeighbours(rng);
  const bool ceiling = rng.Uniform() < 0.06;
  if (ceiling) draft.AddCeiling(rng);

  std::string kind = edge ? "edge" : "table";
  if (tilted) kind += " tilted";
  if (raised) kind += " raised";
  if (draft.walled()) kind += " wall";
  if (draft.neighboured()) kind += " neighbours";
  if (ceiling) kind += " ceiling";
  return {kind, draft.Finish()};
}

TrainingScene SampleRestingScene(const SceneObject& object, Rng rng) {
  const double heading = rng.Uniform(0.0, 2.0 * kPi);
  const Matrix3 R_WO = RotationFromRpy({0.0, 0.0, heading}) * DrawRestingPose(object, rng).R_WO;
  SceneDraft draft(object, R_WO, 0.0, heading);
  if (rng.UniformInt(12) == 0) return {"free", draft.Finish()};
  std::string kind = "table";
  if (rng.Uniform() < 0.6) {
    draft.AddTableEdge(true, 0.03, rng);
    kind = "edge";
  } else {
    draft.AddTable(rng);
  }
  const double surroundings = rng.Uniform();
  if (surroundings < 0.25) draft.AddWall(rng);
  if (surroundings < 0.08) draft.AddWall(rng);
  if (surroundings > 0.80) draft.AddNeighbours(rng);
  if (surroundings > 0.60 && surroundings < 0.80) draft.AddPen(rng);
  const bool ceiling = rng.Uniform() < 0.08;
  if (ceiling) draft.AddCeiling(rng);
  if (draft.walled()) kind += " wall";
  if (draft.neighboured()) kind += " neighbours";
  if (draft.penned()) kind += " pen";
  if (ceiling) kind += " ceiling";
  return {kind, draft.Finish()};
}

std::vector<RigidTransform> MoveSurroundingsAway(const Scene& scene, const MatrixX3& P_O,
                                                 double relief) {
  std::vector<RigidTransform> X_WB;
  for (const Body& body : scene.bodies) X_WB.push_back(body.X_WB);
  if (relief == 0.0) return X_WB;
  const RigidTransform& X_WO = X_WB.front();
  for (std::size_t b = 1; b < scene.bodies.size(); ++b) {
    const SignedDistance distance(scene.bodies[b].shape);
    const RigidTransform X_BO = X_WB[b].inverse() * X_WO;
    DistanceSample nearest{std::numeric_limits<double>::infinity(), Vector3::UnitZ()};
    for (int i = 0; i < P_O.rows(); ++i) {
      const DistanceSample sample =
          distance.CalcWithGradient(X_BO * Vector3(P_O.row(i).transpose()));
      if (sample.phi < nearest.phi) nearest = sample;
    }
    const Vector3 away_W = -(X_WB[b].linear() * nearest.nhat);
    X_WB[b].translation() += relief * away_W;
  }
  return X_WB;
}

}  // namespace pregrasp
