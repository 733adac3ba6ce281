#include "app/hand/urdf_tree.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <fstream>

#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxBytes = 4U << 20U;
constexpr int kMaxNesting = 100;
constexpr int kMaxElements = 10000;  // a thousand times a finger's

// The first complaint of the URDF parser, which has no other way to tell.
class FirstComplaint : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text_.empty()) text_ = OneLine(text);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// The parser and its model are walked by recursion, along elements and along links.
bool IsLargeOrDeep(const std::string& xml) {
  int depth = 0, count = 0;
  for (std::size_t i = 0; i + 1 < xml.size(); ++i) {
    if (xml[i] == '<') {
      if (xml[i + 1] == '/') {
        --depth;
      } else if (xml[i + 1] != '!' && xml[i + 1] != '?') {
        ++depth;
        ++count;
      }
    } else if (xml[i] == '/' && xml[i + 1] == '>') {
      --depth;
    }
    if (depth > kMaxNesting || count > kMaxElements) return true;
  }
  return false;
}

// The parser takes links that go round in a circle, beside a root that none of them hangs on.
void RequireTree(const fs::path& file, const urdf::ModelInterface& model) {
  for (const auto& [name, link] : model.links_) {
    std::size_t steps = 0;
    for (auto at = link->getParent(); at; at = at->getParent()) {
      if (++steps > model.links_.size()) {
        throw InputError(file.string(), name, "a link of one tree",
                         "one whose parents go round in a circle");
      }
    }
  }
}

Matrix3 PointInertia(double mass, const Vector3& p) {
  return mass * (p.squaredNorm() * Matrix3::Identity() - p * p.transpose());
}

}  // namespace

std::string ReadUrdfText(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || text.size() > kMaxBytes || IsLargeOrDeep(text)) {
    throw InputError(file.string(), "", "a URDF of at most 4 MB and 10000 elements, 100 deep", "");
  }
  return text;
}

urdf::ModelInterfaceSharedPtr ParseUrdf(const fs::path& file, const std::string& text,
                                        std::string* complaint) {
  FirstComplaint first;
  console_bridge::useOutputHandler(&first);
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  console_bridge::restorePreviousOutputHandler();
  if (!model) throw InputError(file.string(), "", "a valid URDF description", first.text());
  *complaint = first.text();
  RequireTree(file, *model);
  return model;
}

Vector3 FromUrdf(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

RigidTransform FromUrdf(const urdf::Pose& pose) {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
  pose.rotation.getQuaternion(x, y, z, w);
  return MakeTransform(Quaternion(w, x, y, z), FromUrdf(pose.position));
}

std::string MovementOf(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return "one without limits";
    case urdf::Joint::CONTINUOUS:
      return "a continuous one";
    case urdf::Joint::PRISMATIC:
      return "a prismatic one";
    case urdf::Joint::FIXED:
      return "a fixed one";
    default:
      return "another type";
  }
}

std::string ShapeOf(const urdf::Collision& collision) {
  switch (collision.geometry ? collision.geometry->type : -1) {
    case urdf::Geometry::BOX:
      return "box";
    case urdf::Geometry::CYLINDER:
      return "cylinder";
    case urdf::Geometry::SPHERE:
      return "sphere";
    case urdf::Geometry::MESH:
      return "mesh";
    default:
      return "shape that it does not name";
  }
}

std::string MeshFileOf(const urdf::Mesh& mesh) {
  const std::string& name = mesh.filename;
  for (const std::string scheme : {"package://", "file://"}) {
    if (name.rfind(scheme, 0) != 0) continue;
    const std::string rest = name.substr(scheme.size());
    const std::size_t slash = rest.find('/');
    return scheme == "file://" || slash == std::string::npos ? rest : rest.substr(slash + 1);
  }
  return name;
}

void AddInertia(const urdf::Link& urdf, const RigidTransform& X_LB, HandLink* link) {
  if (!urdf.inertial) return;
  const urdf::Inertial& inertial = *urdf.inertial;
  const RigidTransform X_LI = X_LB * FromUrdf(inertial.origin);
  Matrix3 I;
  I << inertial.ixx, inertial.ixy, inertial.ixz,  //
      inertial.ixy, inertial.iyy, inertial.iyz,   //
      inertial.ixz, inertial.iyz, inertial.izz;
  const double mass = link->mass + inertial.mass;
  if (!(mass > 0.0)) return;
  const Vector3 p_LoLcm = (link->mass * link->p_LoLcm + inertial.mass * X_LI.translation()) / mass;
  link->I_LLcm += PointInertia(link->mass, link->p_LoLcm - p_LoLcm) +
                  X_LI.linear() * I * X_LI.linear().transpose() +
                  PointInertia(inertial.mass, X_LI.translation() - p_LoLcm);
  link->mass = mass;
  link->p_LoLcm = p_LoLcm;
}

}  // namespace pregrasp
