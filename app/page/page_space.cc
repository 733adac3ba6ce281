#include "app/page/page_space.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "app/geometry/mesh_topology.h"
#include "app/geometry/simplify.h"
#include "app/geometry/tessellate.h"
#include "app/hand/hand_shapes.h"
#include "app/page/html_text.h"
#include "app/pictures/picture.h"
#include "app/session/motion_film.h"
#include "render/canvas.h"
#include "render/palette.h"
#include "render/upright.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kBodyTriangles = 6000, kHandTriangles = 500;  // of one mesh, at most
constexpr int kMostFrames = 900;                            // of the film

// Numbers as little-endian bytes in base64: a third of their size as text.
class Packed {
 public:
  void Add16(std::uint32_t value) { AddBytes(value, 2); }
  void Add32(std::uint32_t value) { AddBytes(value, 4); }
  void AddFloat(double value) { Add32(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }
  void AddPose(const RigidTransform& X) {
    for (const double p : {X.translation().x(), X.translation().y(), X.translation().z()}) {
      AddFloat(p);
    }
    const Quaternion q(X.linear());
    for (const double c : {q.w(), q.x(), q.y(), q.z()}) AddFloat(c);
  }
  std::string text() const { return Base64(bytes_); }

 private:
  void AddBytes(std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 255U);
  }
  std::string bytes_;
};

TriangleMesh Slim(const TriangleMesh& mesh, int most) {
  if (mesh.F.rows() <= most || !FindDefects(mesh).closed()) return mesh;
  return SimplifyMesh(mesh, {}, most);
}

// Corners in sixteen bits of the mesh's box each.
Json MeshJson(const TriangleMesh& mesh) {
  const Vector3 low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
  const Vector3 size = (high - low).cwiseMax(1e-9);
  Packed vertices, faces;
  for (Eigen::Index i = 0; i < mesh.V.rows(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double share = (mesh.V(i, axis) - low[axis]) / size[axis];
      vertices.Add16(static_cast<std::uint32_t>(std::lround(65535.0 * share)));
    }
  }
  const bool wide = mesh.V.rows() > 65536;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::uint32_t>(mesh.F(f, k));
      wide ? faces.Add32(vertex) : faces.Add16(vertex);
    }
  }
  return {{"low", {low.x(), low.y(), low.z()}},
          {"size", {size.x(), size.y(), size.z()}},
          {"wide", wide},
          {"v", vertices.text()},
          {"f", faces.text()}};
}

// To a hundredth of a millimetre, and directions alike.
double Short(double value) { return std::round(value * 1e5) / 1e5; }

Json PoseJson(const RigidTransform& X) {
  const Quaternion q(X.linear());
  const Vector3 p = X.translation();
  return {Short(p.x()), Short(p.y()), Short(p.z()), Short(q.w()),
          Short(q.x()), Short(q.y()), Short(q.z())};
}

std::string LinkPoses(const HandModel& hand, const HandConfiguration& configuration) {
  Packed packed;
  for (const RigidTransform& X_WL : CalcLinkPoses(hand, configuration)) packed.AddPose(X_WL);
  return packed.text();
}

// A finger: its number, its contact, the object's outward normal there, the force on it [N].
Json TipJson(Finger finger, const Vector3& p_W, const Vector3& nhat_W, const Vector3& f_W) {
  Json json = {static_cast<int>(finger)};
  for (const Vector3& v : {p_W, nhat_W, f_W}) {
    for (int axis = 0; axis < 3; ++axis) json.push_back(Short(v[axis]));
  }
  return json;
}

Json TipsJson(const std::vector<BodyRow::Contact>& contacts, const RigidTransform& X_WO) {
  Json json = Json::array();
  for (const BodyRow::Contact& contact : contacts) {
    json.push_back(
        TipJson(contact.finger, X_WO * contact.p_OC, X_WO.linear() * contact.nhat_O, contact.f_W));
  }
  return json;
}

class Space {
 public:
  explicit Space(const LoadedRun& run) : run_(run), model_(HandOf(run.scene)) {
    for (const Body& body : run.scene.bodies) AddBody(body);
    for (const HandShape& shape : ShapesOf(model_)) AddHandShape(shape);
  }

  Json Finish(const std::vector<const StepFacts*>& steps) {
    Json fingers = Json::array(), poses = Json::array();
    for (int f = 0; f < model_.num_fingers; ++f) {
      const auto finger = static_cast<Finger>(f);
      fingers.push_back({{"name", FingerName(finger)},
                         {"color", CssColor(FingerColor(finger))},
                         {"radius", model_.tips[f].radius}});
    }
    for (const StepFacts* step : steps) poses.push_back(step == nullptr ? Json() : StepJson(*step));
    return {
        {"meshes", std::move(meshes_)},  {"bodies", std::move(bodies_)}, {"hand", std::move(hand_)},
        {"links", model_.num_links()},   {"upright", UprightJson()},     {"force", ForceJson()},
        {"fingers", std::move(fingers)}, {"steps", std::move(poses)},    {"film", FilmJson()}};
  }

 private:
  int AddMesh(const TriangleMesh& mesh) {
    meshes_.push_back(MeshJson(mesh));
    return static_cast<int>(meshes_.size()) - 1;
  }

  void AddBody(const Body& body) {
    const Rgba color = bodies_.empty()  ? ObjectColor()
                       : body.movable() ? NeighbourColor()
                                        : TableColor();
    Json json = {{"name", body.name},
                 {"mesh", AddMesh(Slim(Tessellate(body.shape), kBodyTriangles))},
                 {"color", CssColor(color)}};
    if (!body.movable()) json["pose"] = PoseJson(body.X_WB);
    bodies_.push_back(std::move(json));
  }

  void AddHandShape(const HandShape& shape) {
    const auto known = mesh_of_.find(shape.mesh.get());
    int mesh = 0;
    if (known != mesh_of_.end()) {
      mesh = known->second;
    } else {
      mesh = mesh_of_[shape.mesh.get()] = AddMesh(Slim(*shape.mesh, kHandTriangles));
    }
    const std::optional<Finger> finger = model_.FingerOf(shape.link);
    const int tip = finger ? static_cast<int>(*finger) : -1;
    const auto& [r, g, b, a] = shape.rgba;
    hand_.push_back(
        {{"mesh", mesh}, {"link", shape.link}, {"color", CssColor({r, g, b, a})}, {"tip", tip}});
  }

  // The rotation to a frame in which z is against gravity, row by row: views turn about that.
  Json UprightJson() const {
    const Matrix3 R_UW = UprightRotation(-run_.scene.gravity.normalized());
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rows.push_back(R_UW(row, column));
    }
    return rows;
  }

  // Arrows are as long as the pictures'.
  Json ForceJson() const {
    const ForceScale scale = CalcForceScale(run_.scene);
    return {{"per_newton", scale.metres_per_newton},
            {"shortest", scale.Length(0.0)},
            {"longest", scale.Length(1e9)},
            {"radius", 0.0045 * scale.shrunk}};
  }

  Json StepJson(const StepFacts& step) const {
    Json bodies = Json::array(), fingers = Json::array();
    for (const BodyFacts& body : step.bodies) bodies.push_back(PoseJson(body.X_WB()));
    Json json = {{"bodies", std::move(bodies)}};
    const HandFacts* hand = nullptr;
    std::vector<int> touching;
    if (const auto* grasp = std::get_if<GraspFacts>(&step.details)) {
      if (grasp->hand) hand = &*grasp->hand;
      for (const auto& contact : grasp->contacts)
        touching.push_back(static_cast<int>(contact.finger));
    } else if (const auto* lift = std::get_if<LiftFacts>(&step.details)) {
      hand = &lift->hand;
      for (const auto& contact : lift->grip) touching.push_back(static_cast<int>(contact.finger));
    } else if (const auto* frame = std::get_if<FrameFacts>(&step.details)) {
      hand = &frame->hand;
      for (const auto& place : frame->touching) touching.push_back(static_cast<int>(place.finger));
    }
    if (hand != nullptr && std::ssize(hand->joints) == model_.num_joints) {
      json["hand"] = LinkPoses(model_, hand->configuration());
      json["on"] = touching;
    }
    for (const FingerFacts& finger : step.fingers) {
      if (!finger.on) continue;
      fingers.push_back(
          TipJson(finger.finger, finger.p_WF, step.object().q_WB * finger.nhat_O, finger.f_W));
    }
    if (!fingers.empty()) json["fingers"] = std::move(fingers);
    return json;
  }

  // The hand's motion, or without one what was simulated.
  Json FilmJson() const {
    std::vector<double> times;
    Packed bodies, hand;
    Json phases = Json::array(), on = Json::array(), fingers = Json::array();
    const std::vector<FilmFrame> film = ReadFilm(run_);
    if (!film.empty()) {
      const std::size_t stride = film.size() / kMostFrames + 1;
      for (std::size_t i = 0; i < film.size(); i += stride) {
        times.push_back(Short(film[i].motion.t));
        for (const RigidTransform& X_WB : film[i].X_WB) bodies.AddPose(X_WB);
        for (const auto& X_WL : CalcLinkPoses(model_, film[i].motion.hand)) {
          hand.AddPose(X_WL);
        }
        phases.push_back(MotionPhaseName(film[i].motion.phase));
        int bits = 0;
        for (int f = 0; f < model_.num_fingers; ++f) bits |= film[i].motion.on[f] ? 1 << f : 0;
        on.push_back(bits);
        fingers.push_back(TipsJson(film[i].contacts, film[i].X_WB[0]));
      }
      return {
          {"t", times}, {"bodies", bodies.text()},      {"hand", hand.text()}, {"phase", phases},
          {"on", on},   {"fingers", std::move(fingers)}};
    }
    const std::filesystem::path table = run_.directory / "rollout.csv";
    if (!std::filesystem::exists(table)) return nullptr;
    const std::vector<BodyRow> rows = ReadBodyRows(table, run_.scene);
    if (rows.size() < 2) return nullptr;
    constexpr double kPerSecond = 30.0;
    const double seconds = rows.back().t - rows.front().t;
    const double count = std::clamp(std::ceil(seconds * kPerSecond), 1.0, kMostFrames * 1.0);
    for (int i = 0; i <= static_cast<int>(count); ++i) {
      const auto row =
          static_cast<std::size_t>(std::lround(i / count * static_cast<double>(rows.size() - 1)));
      times.push_back(Short(rows[row].t));
      for (const RigidTransform& X_WB : rows[row].X_WB) bodies.AddPose(X_WB);
      fingers.push_back(TipsJson(rows[row].contacts, rows[row].X_WB[0]));
    }
    return {{"t", times}, {"bodies", bodies.text()}, {"fingers", std::move(fingers)}};
  }

  const LoadedRun& run_;
  const HandModel& model_;
  Json meshes_ = Json::array(), bodies_ = Json::array(), hand_ = Json::array();
  std::map<const TriangleMesh*, int> mesh_of_;
};

}  // namespace

std::string CssColor(const Rgba& color) {
  const auto channel = [](float linear) {
    return static_cast<int>(std::lround(255.0F * SrgbFromLinear(std::clamp(linear, 0.0F, 1.0F))));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", channel(color.r), channel(color.g), channel(color.b));
}

Json PageSpace(const LoadedRun& run, const std::vector<const StepFacts*>& steps) {
  return Space(run).Finish(steps);
}

}  // namespace pregrasp
