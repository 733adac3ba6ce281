#include "app/hand/hand_model.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/text.h"

namespace pregrasp {
namespace {

constexpr double kSamePlace = 1e-7;  // [m]; the file's numbers carry nine decimals

Vector3 FromUrdf(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

RigidTransform FromUrdf(const urdf::Pose& pose) {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
  pose.rotation.getQuaternion(x, y, z, w);
  return MakeTransform(Quaternion(w, x, y, z), FromUrdf(pose.position));
}

Matrix3 PointInertia(double mass, const Vector3& p) {
  return mass * (p.squaredNorm() * Matrix3::Identity() - p * p.transpose());
}

std::string ReadFile(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string(), "", "a readable URDF file", "");
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {
    console_bridge::noOutputHandler();  // a failure becomes an InputError instead
    urdf_ = urdf::parseURDF(ReadFile(file));
    console_bridge::restorePreviousOutputHandler();
    if (!urdf_) throw InputError(file.string(), "", "a valid URDF description", "");
  }

  HandModel Read() {
    model_.name = urdf_->getName();
    ReadTree();
    for (int link = 0; link < kNumHandLinks; ++link) ReadLink(link);
    for (int finger = 0; finger < kNumFingers; ++finger) ReadTip(static_cast<Finger>(finger));
    ChooseSelfPairs();
    return std::move(model_);
  }

 private:
  [[noreturn]] void Fail(const std::string& field, const std::string& expected,
                         const std::string& got) const {
    throw InputError(file_.string(), field, expected, got);
  }

  void ReadTree() {
    model_.links[0].name = urdf_->getRoot()->name;
    std::size_t num_moving = 0;
    for (const auto& [name, joint] : urdf_->joints_)
      num_moving += joint->type != urdf::Joint::FIXED;
    if (num_moving != kNumHandJoints) {
      Fail("", fmt::format("{} moving joints", kNumHandJoints), std::to_string(num_moving));
    }
    for (const auto& [first, count] : kFingerJoints) {
      for (int j = first; j < first + count; ++j) ReadJoint(j, j == first ? 0 : j);
      for (int link = first + 1; link <= first + count; ++link) model_.chain_begin[link] = first;
    }
  }

  void ReadJoint(int index, int parent) {
    const std::string field = kHandJointNames[index];
    const auto joint = urdf_->getJoint(field);
    if (!joint || joint->type != urdf::Joint::REVOLUTE || !joint->limits) {
      Fail(field, "a revolute joint with limits", joint ? "another type" : "none");
    }
    if (joint->parent_link_name != model_.links[parent].name) {
      Fail(field, fmt::format("parent \"{}\"", model_.links[parent].name),
           '"' + joint->parent_link_name + '"');
    }
    HandJoint& out = model_.joints[index];
    out.parent = parent;
    out.X_PJ = FromUrdf(joint->parent_to_joint_origin_transform);
    out.axis = FromUrdf(joint->axis);
    if (std::abs(out.axis.norm() - 1.0) > 1e-6) {
      Fail(field, "an axis of length 1", FormatDouble(out.axis.norm()));
    }
    out.axis.normalize();
    out.lower = model_.q_lower[index] = joint->limits->lower;
    out.upper = model_.q_upper[index] = joint->limits->upper;
    out.max_speed = joint->limits->velocity;
    out.max_effort = joint->limits->effort;
    if (!(out.lower < out.upper)) {
      Fail(field, "lower < upper", fmt::format("{} and {}", out.lower, out.upper));
    }
    model_.links[index + 1].name = joint->child_link_name;
  }

  void ReadLink(int index) {
    HandLink& link = model_.links[index];
    const auto urdf = urdf_->getLink(link.name);
    AddInertia(*urdf, RigidTransform::Identity(), &link);
    for (const auto& joint : urdf->child_joints) {
      if (joint->type != urdf::Joint::FIXED) continue;
      AddInertia(*urdf_->getLink(joint->child_link_name),
                 FromUrdf(joint->parent_to_joint_origin_transform), &link);
    }
    ReadCapsules(index, *urdf);
    for (const auto& visual : urdf->visual_array) ReadVisual(index, *visual);
  }

  // Adds the body that `urdf` describes, its frame at X_LB, to the link.
  static void AddInertia(const urdf::Link& urdf, const RigidTransform& X_LB, HandLink* link) {
    if (!urdf.inertial) return;
    const urdf::Inertial& inertial = *urdf.inertial;
    const RigidTransform X_LI = X_LB * FromUrdf(inertial.origin);
    Matrix3 I;
    I << inertial.ixx, inertial.ixy, inertial.ixz,  //
        inertial.ixy, inertial.iyy, inertial.iyz,   //
        inertial.ixz, inertial.iyz, inertial.izz;
    const double mass = link->mass + inertial.mass;
    const Vector3 p_LoLcm =
        (link->mass * link->p_LoLcm + inertial.mass * X_LI.translation()) / mass;
    link->I_LLcm += PointInertia(link->mass, link->p_LoLcm - p_LoLcm) +
                    X_LI.linear() * I * X_LI.linear().transpose() +
                    PointInertia(inertial.mass, X_LI.translation() - p_LoLcm);
    link->mass = mass;
    link->p_LoLcm = p_LoLcm;
  }

  void ReadVisual(int link, const urdf::Visual& visual) {
    const auto mesh = std::dynamic_pointer_cast<urdf::Mesh>(visual.geometry);
    if (!mesh || !FromUrdf(visual.origin).isApprox(RigidTransform::Identity())) {
      Fail(model_.links[link].name + ".visual", "a mesh in the link's own frame", "another shape");
    }
    HandVisual out{link, file_.parent_path() / mesh->filename, {0.8F, 0.8F, 0.8F, 1.0F}};
    if (visual.material) {
      const urdf::Color& color = visual.material->color;
      out.rgba = {color.r, color.g, color.b, color.a};
    }
    model_.visuals.push_back(std::move(out));
  }

  // URDF knows no capsule: the cylinders of a link with the spheres at their ends, then the spheres
  // left over.
  void ReadCapsules(int index, const urdf::Link& urdf) {
    struct Ball {
      std::string name;
      Vector3 p_L;
      double radius;
      bool used;
    };
    const std::string& link = model_.links[index].name;
    std::vector<Ball> balls;
    for (const auto& shape : urdf.collision_array) {
      if (const auto sphere = std::dynamic_pointer_cast<urdf::Sphere>(shape->geometry)) {
        balls.push_back({shape->name, FromUrdf(shape->origin.position), sphere->radius, false});
      } else if (!std::dynamic_pointer_cast<urdf::Cylinder>(shape->geometry)) {
        Fail(link + ".collision." + shape->name, "cylinders and spheres", "another shape");
      }
    }
    for (const auto& shape : urdf.collision_array) {
      const auto cylinder = std::dynamic_pointer_cast<urdf::Cylinder>(shape->geometry);
      if (!cylinder) continue;
      const RigidTransform X_LC = FromUrdf(shape->origin);
      HandCapsule capsule{link + '/' + shape->name, index, {}, {}, cylinder->radius};
      for (const double end : {-0.5, 0.5}) {
        const Vector3 p_L = X_LC * Vector3(0.0, 0.0, end * cylinder->length);
        const auto ball = std::find_if(balls.begin(), balls.end(), [&](const Ball& b) {
          return !b.used && b.name == shape->name && (b.p_L - p_L).norm() < kSamePlace &&
                 std::abs(b.radius - cylinder->radius) < kSamePlace;
        });
        if (ball == balls.end()) {
          Fail(capsule.name, "a sphere of its radius at each end of the cylinder", "none");
        }
        ball->used = true;
        (end < 0.0 ? capsule.p_LA : capsule.p_LB) = ball->p_L;
      }
      model_.capsules.push_back(std::move(capsule));
    }
    for (const Ball& ball : balls) {
      if (ball.used) continue;
      model_.capsules.push_back({link + '/' + ball.name, index, ball.p_L, ball.p_L, ball.radius});
    }
  }

  void ReadTip(Finger finger) {
    Fingertip& tip = model_.tips[static_cast<int>(finger)];
    tip.link = DistalLink(finger);
    const std::string& link = model_.links[tip.link].name;
    tip.capsule = -1;
    for (std::size_t i = 0; i < model_.capsules.size(); ++i) {
      if (model_.capsules[i].link == tip.link) tip.capsule = static_cast<int>(i);
    }
    if (tip.capsule < 0) Fail(link + ".collision", "a capsule", "none");
    const HandCapsule& capsule = model_.capsules[tip.capsule];
    tip.p_LT = capsule.p_LB;
    tip.radius = FingertipRadius(finger);
    if (std::abs(capsule.radius - tip.radius) > kSamePlace) {
      Fail(capsule.name, fmt::format("a fingertip of radius {} m", tip.radius),
           FormatDouble(capsule.radius));
    }
    for (const auto& joint : urdf_->getLink(link)->child_joints) {
      if (joint->type == urdf::Joint::FIXED) {
        tip.p_LTip = FromUrdf(joint->parent_to_joint_origin_transform.position);
      }
    }
  }

  void ChooseSelfPairs() {
    std::array<bool, kNumHandLinks> has_capsule{};
    for (const HandCapsule& capsule : model_.capsules) has_capsule[capsule.link] = true;
    // The nearest link towards the palm that has a capsule.
    const auto neighbour = [&](int link) {
      do {
        link = model_.joints[link - 1].parent;
      } while (link != 0 && !has_capsule[link]);
      return link;
    };
    const int count = static_cast<int>(model_.capsules.size());
    for (int i = 0; i < count; ++i) {
      for (int k = i + 1; k < count; ++k) {
        const int a = model_.capsules[i].link;
        const int b = model_.capsules[k].link;  // a <= b: capsules are in link order
        if (a != b && neighbour(b) != a) model_.self_pairs.emplace_back(i, k);
      }
    }
  }

  std::filesystem::path file_;
  urdf::ModelInterfaceSharedPtr urdf_;
  HandModel model_;
};

}  // namespace

HandModel LoadHandModel(const std::filesystem::path& urdf_file) { return Reader(urdf_file).Read(); }

const HandModel& ShadowHand() {
  static const HandModel hand =
      LoadHandModel(DataFolder() / "assets" / "hand" / "shadow_right.urdf");
  return hand;
}

HandJoints RelaxedPosture() {
  HandJoints q;
  q << -0.05, 0.30, 0.40, 0.25,       // index
      0.00, 0.35, 0.45, 0.25,         // middle
      -0.05, 0.40, 0.45, 0.25,        // ring
      0.10, -0.10, 0.40, 0.45, 0.25,  // little
      0.30, 0.60, 0.00, 0.25, 0.35;   // thumb
  return q;
}

}  // namespace pregrasp
