#include "tests/replay/mujoco_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/geometry/hull.h"
#include "tests/mjcf.h"

namespace pregrasp {
namespace {

using testing::FreeMujoco;
using testing::LoadMjcf;
using testing::MjcfShape;
using testing::MjcfText;

constexpr double kUntouchedSeconds = 0.3;
constexpr double kJump = 3e-3;  // a contact that moves so far in a row was put anew [m]

bool IsPutAnew(const ReplayRow::FingerColumns& from, const ReplayRow::FingerColumns& to) {
  return !to.on || !from.on || (to.p_OC - from.p_OC).norm() > kJump;
}

// A scene as an MJCF model: bodies of convex pieces, every pair of bodies of which one moves with
// the smaller friction of the two.
class SceneModel {
 public:
  std::string Write(const Scene& scene, const std::vector<RigidTransform>& X_WB, double dt) {
    std::string bodies;
    int movable = 0;
    for (const Body& body : scene.bodies) {
      bodies += WriteBody(body, body.movable() ? X_WB.at(movable++) : body.X_WB);
    }
    return fmt::format(
        "<mujoco><option gravity=\"{}\" timestep=\"{}\" cone=\"elliptic\" impratio=\"10\" "
        "iterations=\"200\" noslip_iterations=\"10\"/><size njmax=\"4000\" nconmax=\"1000\"/>"
        "<asset>{}</asset><worldbody>{}</worldbody><contact>{}</contact></mujoco>",
        MjcfText(scene.gravity), dt, meshes_, bodies, WritePairs(scene, dt));
  }

 private:
  std::string WriteBody(const Body& body, const RigidTransform& X_WB) {
    std::string text =
        fmt::format("<body name=\"{}\" pos=\"{}\" quat=\"{}\">", body.name,
                    MjcfText(Vector3(X_WB.translation())), MjcfText(Quaternion(X_WB.linear())));
    if (body.movable()) {
      const MassProperties& mass = *body.mass_properties;
      const Matrix3& I = mass.I_BBcm;
      text += fmt::format(
          "<freejoint/><inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{} {} {} {} {} {}\"/>",
          MjcfText(mass.p_BoBcm), mass.mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
    }
    counts_.push_back(0);
    for (const ConvexPiece& piece : DecomposeConvex(body.shape)) text += WriteGeom(piece);
    return text + "</body>";
  }

  std::string WriteGeom(const ConvexPiece& piece) {
    const std::string name = fmt::format("g{}.{}", counts_.size() - 1, counts_.back()++);
    return fmt::format(
        "<geom name=\"{}\" {} pos=\"{}\" quat=\"{}\" contype=\"0\" conaffinity=\"0\"/>", name,
        MjcfShape(piece.shape, name, &meshes_), MjcfText(Vector3(piece.X_BP.translation())),
        MjcfText(Quaternion(piece.X_BP.linear())));
  }

  std::string WritePairs(const Scene& scene, double dt) const {
    std::string pairs;
    for (std::size_t a = 0; a < scene.bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < scene.bodies.size(); ++b) {
        if (!scene.bodies[a].movable() && !scene.bodies[b].movable()) continue;
        const double mu = std::min(scene.bodies[a].friction, scene.bodies[b].friction);
        for (int i = 0; i < counts_[a]; ++i) {
          for (int j = 0; j < counts_[b]; ++j) {
            pairs += fmt::format(
                "<pair geom1=\"g{}.{}\" geom2=\"g{}.{}\" condim=\"3\" friction=\"{} {} 0 0 0\" "
                "solref=\"{} 1\"/>",
                a, i, b, j, mu, mu, std::max(0.002, 2.0 * dt));
          }
        }
      }
    }
    return pairs;
  }

  std::string meshes_;
  std::vector<int> counts_;  // pieces by body
};

// One finger: a massless point on a spring, on the object's surface, sliding where the cone says.
class SpringFinger {
 public:
  void Put(const ReplayRow::FingerColumns& columns) {
    on_ = columns.on;
    p_OC_ = columns.p_OC;
  }
  bool on() const { return on_; }
  const Vector3& p_OC() const { return p_OC_; }

  // The force on the object, and the slide of the point in the step.
  Vector3 CalcForce(const FingertipConfig& tips, const ReplayRow::FingerColumns& columns,
                    const Vector3& target_W, const RigidTransform& X_WO, const Vector3& v_WC,
                    double dt) {
    const Vector3 n_W = X_WO.linear() * columns.n_OC;
    Vector3 s = columns.k * (target_W - X_WO * p_OC_) - columns.b * v_WC;
    const double normal = -s.dot(n_W);
    if (normal <= 0.0) return Vector3::Zero();
    Vector3 across = s + normal * n_W;
    const double limit = tips.friction * normal, size = across.norm();
    if (size > limit) {
      // It slides by what takes the spring back to the cone, its damper resisting.
      const Vector3 slide = (size - limit) / (columns.k + columns.b / dt) * (across / size);
      p_OC_ += X_WO.linear().transpose() * slide;
      across *= limit / size;
    }
    s = across - normal * n_W;
    return s.norm() > tips.max_force ? Vector3(s * (tips.max_force / s.norm())) : s;
  }

 private:
  bool on_ = false;
  Vector3 p_OC_ = Vector3::Zero();
};

class Replay {
 public:
  Replay(const Scene& scene, const std::vector<ReplayRow>& rows, double dt)
      : scene_(scene), rows_(rows), dt_(dt) {
    model_ = LoadMjcf(SceneModel().Write(scene, rows.front().X_WB, dt));
    data_.reset(mj_makeData(model_.get()));
    object_ = mj_name2id(model_.get(), mjOBJ_BODY, scene.object().name.c_str());
  }

  ReplayResult Run() {
    ReplayResult result;
    result.X_WO.push_back(rows_.front().X_WB.front());
    for (int f = 0; f < kNumFingers; ++f) fingers_[f].Put(rows_.front().fingers[f]);
    double touched_t = -1e9;
    for (std::size_t row = 1; row < rows_.size(); ++row) {
      const ReplayRow &from = rows_[row - 1], &to = rows_[row];
      for (int f = 0; f < kNumFingers; ++f) {
        if (IsPutAnew(from.fingers[f], to.fingers[f])) fingers_[f].Put(to.fingers[f]);
      }
      const int steps = static_cast<int>(std::lround(to.t / dt_) - std::lround(from.t / dt_));
      for (int i = 1; i <= steps; ++i) Step(from, to, static_cast<double>(i) / steps);
      result.X_WO.push_back(Pose());
      if (const int body = FindTouching(); body >= 0) {
        touched_t = to.t;
        result.touching_body = body;
      }
    }
    if (rows_.back().t - touched_t > kUntouchedSeconds) result.touching_body = -1;
    return result;
  }

 private:
  // The free joint of the object comes first.
  RigidTransform Pose() const {
    const double* q = data_->qpos;
    return MakeTransform(Quaternion(q[3], q[4], q[5], q[6]), Vector3(q[0], q[1], q[2]));
  }

  void Step(const ReplayRow& from, const ReplayRow& to, double s) {
    const RigidTransform X_WO = Pose();
    const double* v = data_->qvel;
    const Vector3 v_WO(v[0], v[1], v[2]), w_W = X_WO.linear() * Vector3(v[3], v[4], v[5]);
    const Vector3 p_WOcm = X_WO * scene_.object().mass_properties->p_BoBcm;
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
    for (int f = 0; f < kNumFingers; ++f) {
      if (!fingers_[f].on()) continue;
      const ReplayRow::FingerColumns &a = from.fingers[f], &b = to.fingers[f];
      const bool goes_on = !IsPutAnew(a, b) && a.k == b.k;
      const Vector3 target =
          goes_on ? Vector3(a.target_W + s * (b.target_W - a.target_W)) : b.target_W;
      const Vector3 p_WC = X_WO * fingers_[f].p_OC();
      const Vector3 v_WC = v_WO + w_W.cross(p_WC - X_WO.translation());
      const Vector3 f_W = fingers_[f].CalcForce(scene_.fingertips, b, target, X_WO, v_WC, dt_);
      force += f_W;
      torque += (p_WC - p_WOcm).cross(f_W);
    }
    for (int k = 0; k < 3; ++k) {
      data_->xfrc_applied[6 * object_ + k] = force[k];
      data_->xfrc_applied[6 * object_ + 3 + k] = torque[k];
    }
    mj_step(model_.get(), data_.get());
  }

  // The scene index of a body that presses on the object; -1 for none.
  int FindTouching() const {
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      const int a = model_->geom_bodyid[contact.geom1], b = model_->geom_bodyid[contact.geom2];
      if (a != object_ && b != object_) continue;
      mjtNum force[6];
      mj_contactForce(model_.get(), data_.get(), i, force);
      // MuJoCo's body 0 is the world; the scene's follow in order.
      if (force[0] > 0.0) return (a == object_ ? b : a) - 1;
    }
    return -1;
  }

  const Scene& scene_;
  const std::vector<ReplayRow>& rows_;
  double dt_;
  std::unique_ptr<mjModel, FreeMujoco> model_;
  std::unique_ptr<mjData, FreeMujoco> data_;
  int object_ = 0;
  std::array<SpringFinger, kNumFingers> fingers_;
};

std::vector<std::string> SplitCells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

// A row's values by the names of the columns.
class Columns {
 public:
  Columns(const std::string& file, const std::string& header) : file_(file) {
    const std::vector<std::string> names = SplitCells(header);
    for (std::size_t i = 0; i < names.size(); ++i) index_[names[i]] = i;
  }
  void Read(const std::string& line) {
    values_.clear();
    for (const std::string& cell : SplitCells(line)) values_.push_back(std::stod(cell));
    if (values_.size() != index_.size()) {
      throw InputError(file_, "", fmt::format("{} columns", index_.size()),
                       std::to_string(values_.size()));
    }
  }
  bool Has(const std::string& name) const { return index_.count(name) > 0; }
  double Get(const std::string& name) const {
    const auto found = index_.find(name);
    if (found == index_.end()) throw InputError(file_, name, "a column of that name", "none");
    return values_[found->second];
  }
  Vector3 Get3(const std::string& stem) const {
    return {Get(stem + "_x"), Get(stem + "_y"), Get(stem + "_z")};
  }

 private:
  std::string file_;
  std::map<std::string, std::size_t> index_;
  std::vector<double> values_;
};

ReplayRow ReadRow(const Columns& columns, const Scene& scene) {
  ReplayRow row;
  row.t = columns.Get("t");
  for (const Body& body : scene.bodies) {
    if (!body.movable()) continue;
    const std::string prefix = row.X_WB.empty() ? "" : body.name + '_';
    const Vector3 q = columns.Get3(prefix + "q_WO");
    row.X_WB.push_back(
        MakeTransform(Quaternion(columns.Get(prefix + "q_WO_w"), q.x(), q.y(), q.z()),
                      columns.Get3(prefix + "p_WO")));
  }
  const FingertipConfig& tips = scene.fingertips;
  const double mass = scene.object().mass_properties->mass;
  for (int f = 0; f < kNumFingers; ++f) {
    const std::string prefix = std::string(kFingerNames[f]) + '_';
    if (!columns.Has(prefix + "on")) continue;
    ReplayRow::FingerColumns& finger = row.fingers[f];
    finger.on = columns.Get(prefix + "on") == 1.0;
    finger.p_OC = columns.Get3(prefix + "p_OC");
    finger.n_OC = columns.Get3(prefix + "n_OC");
    finger.target_W = columns.Get3(prefix + "target_W");
    finger.f_W = columns.Get3(prefix + "f_W");
    const bool has_spring = columns.Has(prefix + "k");  // of rollout.csv: the scene's
    finger.k = has_spring ? columns.Get(prefix + "k") : tips.stiffness;
    finger.b =
        has_spring ? columns.Get(prefix + "b") : tips.damping * std::sqrt(tips.stiffness * mass);
  }
  return row;
}

constexpr double kTogether = 1e-7;  // by which two targets' ways in a row may differ [m]

Vector3 MeanTarget(const ReplayRow& row) {
  Vector3 mean = Vector3::Zero();
  int count = 0;
  for (const ReplayRow::FingerColumns& finger : row.fingers) {
    if (!finger.on) continue;
    mean += finger.target_W;
    ++count;
  }
  PREGRASP_CHECK(count > 0);
  return mean / count;
}

// Whether the same fingers are on, and the targets of all have gone the same way.
bool HasMovedTogether(const ReplayRow& from, const ReplayRow& to) {
  std::optional<Vector3> way;
  for (int f = 0; f < kNumFingers; ++f) {
    const ReplayRow::FingerColumns &a = from.fingers[f], &b = to.fingers[f];
    if (a.on != b.on) return false;
    if (!b.on) continue;
    const Vector3 moved = b.target_W - a.target_W;
    if (!way) way = moved;
    if ((moved - *way).norm() > kTogether) return false;
  }
  return way.has_value();
}

}  // namespace

std::vector<ReplayRow> ReadReplayTable(const std::filesystem::path& file, const Scene& scene) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw InputError(file.string(), "", "a table", "nothing");
  Columns columns(file.string(), line);
  std::vector<ReplayRow> rows;
  while (std::getline(stream, line)) {
    columns.Read(line);
    rows.push_back(ReadRow(columns, scene));
  }
  return rows;
}

ReplayResult ReplayInMujoco(const Scene& scene, const std::vector<ReplayRow>& rows, double dt) {
  PREGRASP_CHECK(!rows.empty());
  return Replay(scene, rows, dt).Run();
}

std::vector<RigidTransform> ObjectPoses(const std::vector<ReplayRow>& rows) {
  std::vector<RigidTransform> X_WO;
  for (const ReplayRow& row : rows) X_WO.push_back(row.X_WB.front());
  return X_WO;
}

ReplayVerdict JudgeReplay(const std::vector<ReplayRow>& rows,
                          const std::vector<RigidTransform>& X_WO, int touching_body) {
  PREGRASP_CHECK(X_WO.size() == rows.size(), X_WO.size(), rows.size());
  // From the last row on that two targets came to otherwise, all go the same way.
  std::size_t lift = rows.size() - 1;
  while (lift > 0 && HasMovedTogether(rows[lift - 1], rows[lift])) --lift;
  const RigidTransform& X_WO_start = rows.front().X_WB.front();
  ReplayVerdict verdict;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Vector3 way = Vector3::Zero();
    if (i > lift) way = MeanTarget(rows[i]) - MeanTarget(rows[lift]);
    verdict.shift =
        std::max(verdict.shift, (X_WO[i].translation() - X_WO_start.translation() - way).norm());
    verdict.turn_deg =
        std::max(verdict.turn_deg, RadToDeg(RotationAngle(X_WO_start.linear(), X_WO[i].linear())));
  }
  const double share = std::max(verdict.shift / 0.01, verdict.turn_deg / 15.0);
  verdict.held = share <= 1.0 && touching_body < 0;
  verdict.is_close = share > 0.8 && share < 1.2;
  return verdict;
}

}  // namespace pregrasp
