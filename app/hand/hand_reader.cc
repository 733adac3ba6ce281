#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/core/data_folder.h"
#include "app/core/file_kind.h"
#include "app/core/sha256.h"
#include "app/core/text.h"
#include "app/hand/distance.h"
#include "app/hand/hand_file.h"
#include "app/hand/hand_kinematics.h"
#include "app/hand/hand_mirror.h"
#include "app/hand/urdf_tree.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr double kSamePlace = 1e-7;     // [m]; the file's numbers carry nine decimals
constexpr double kTipAtEnd = 1e-6;      // [m], of a capsule
constexpr double kTipInside = 5e-4;     // [m], of what a fingertip may lie within its link
constexpr double kMaxLinkMass = 100.0;  // [kg]
constexpr double kTipFar = 2e-3;        // [m], of what it may be off it

// The file below one of the folders that a hand's files may lie in.
fs::path FindFile(const fs::path& file, const fs::path& description, const std::string& what) {
  std::error_code error;
  const fs::path found = fs::canonical(file, error);
  if (const std::string clause = NonFileClause(file); !clause.empty()) {
    throw InputError(description.string(), what, "a file", '"' + file.string() + "\", " + clause);
  }
  for (const fs::path& folder :
       {fs::absolute(description).parent_path(), DataFolder() / "assets" / "hands"}) {
    const fs::path root = fs::weakly_canonical(folder, error);
    const fs::path relative = found.lexically_relative(root);
    if (!relative.empty() && *relative.begin() != "..") return file;
  }
  throw InputError(description.string(), what, "a file below the description's folder",
                   '"' + file.string() + '"');
}

// The rotation of a frame whose +z is `along` and whose -y is `palmar`.
Matrix3 RotationOf(const HandDescription::Frame& frame) {
  Matrix3 R;
  R.col(2) = frame.along;
  R.col(1) = -frame.palmar;
  R.col(0) = R.col(1).cross(R.col(2));
  return R;
}

class Reader {
 public:
  Reader(HandDescription description, HandReading* reading)
      : description_(std::move(description)), reading_(*reading), model_(reading->hand) {}

  void Read() {
    const fs::path file = FindFile(description_.urdf, description_.file, "urdf");
    urdf_file_ = file;
    const std::string text = ReadUrdfText(file);
    std::string complaint;
    urdf_ = ParseUrdf(file, text, &complaint);
    if (!complaint.empty())
      reading_.faults.emplace_back(file.string(), "", "a URDF that is read whole", complaint);
    model_.name = description_.name;
    model_.file = description_.file;
    model_.files = {description_.file, file};
    model_.sha256 = Sha256(Sha256OfFile(description_.file) + Sha256(text));
    model_.forearm = description_.forearm;
    ReadTree();
    if (!reading_.faults.empty()) return;  // what follows is about the links of a tree
    for (int link = 0; link < model_.num_links(); ++link) ReadLink(link);
    for (const auto& [link, capsules] : description_.capsules)
      RequireLink(link, "capsules." + link);
    for (int f = 0; f < model_.num_fingers; ++f) ReadTip(static_cast<Finger>(f));
    SortCapsules();
    ReadPosture();
    if (description_.mirror) MirrorHand(&model_);
    if (model_.capsules.size() > kMaxHandCapsules) {
      AddFault("capsules", fmt::format("at most {}", kMaxHandCapsules),
               std::to_string(model_.capsules.size()));
    }
    if (!reading_.faults.empty()) return;
    ChooseSelfPairs();
    CheckPosture();
  }

 private:
  // About the description, and about the URDF.
  void AddFault(const std::string& field, const std::string& expected, const std::string& got) {
    reading_.faults.emplace_back(description_.file.string(), field, expected, got);
  }
  void AddUrdfFault(const std::string& field, const std::string& expected, const std::string& got) {
    reading_.faults.emplace_back(urdf_file_.string(), field, expected, got);
  }

  std::string NearestLink(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& [link, value] : urdf_->links_) names.push_back(link);
    return FormatHint(FindNearest(name, names));
  }

  bool RequireLink(const std::string& name, const std::string& field) {
    if (urdf_->getLink(name)) return true;
    AddFault(field, "a link of the URDF", '"' + name + '"' + NearestLink(name));
    return false;
  }

  // The joints of the fingers after the thumb, then the thumb's.
  void ReadTree() {
    if (!RequireLink(description_.palm, "palm.link")) return;
    model_.num_fingers = static_cast<int>(description_.fingers.size());
    model_.links[0].name = description_.palm;
    X_LU_[0] =
        MakeTransform(RotationOf(description_.palm_frame), description_.palm_frame.p).inverse();
    if (!NeedsTurning(description_.palm_frame)) X_LU_[0] = RigidTransform::Identity();
    std::set<std::string> used;
    for (int i = 1; i <= model_.num_fingers; ++i) {
      const int f = i % model_.num_fingers;
      const HandDescription::Finger& finger = description_.fingers[f];
      const int first = model_.num_joints, count = static_cast<int>(finger.joints.size());
      model_.fingers[f] = {first, count};
      for (int k = 0; k < count; ++k) {
        const int j = first + k;
        ++model_.num_joints;
        model_.chain_begin[j + 1] = first;
        used.insert(finger.joints[k].urdf);
        X_LU_[j + 1] = RigidTransform::Identity();
        if (k + 1 == count && NeedsTurning(finger.tip)) {
          X_LU_[j + 1].linear() = RotationOf(finger.tip).transpose();
        }
        const std::string field = fmt::format("fingers[{}].joints[{}]", f + 1, k + 1);
        if (!ReadJoint(finger.joints[k], j, k == 0 ? 0 : j, field)) return;
      }
    }
    CheckLeftOver(*urdf_->getLink(description_.palm), used);
  }

  static bool NeedsTurning(const HandDescription::Frame& frame) {
    return frame.along != Vector3::UnitZ() || frame.palmar != -Vector3::UnitY() ||
           frame.p != Vector3::Zero();
  }

  // Whether reading can go on along the finger.
  bool ReadJoint(const HandDescription::Joint& wanted, int index, int parent,
                 const std::string& field) {
    const auto joint = urdf_->getJoint(wanted.urdf);
    if (!joint) {
      std::vector<std::string> names;
      for (const auto& [name, value] : urdf_->joints_) names.push_back(name);
      AddFault(field, "a joint of the URDF",
               '"' + wanted.urdf + '"' + FormatHint(FindNearest(wanted.urdf, names)));
      return false;
    }
    HandJoint& out = model_.joints[index];
    out.name = wanted.name;
    out.parent = parent;
    model_.links[index + 1].name = joint->child_link_name;
    // Links that are fixed to each other are one.
    RigidTransform X_PU = FromUrdf(joint->parent_to_joint_origin_transform);
    std::string at = joint->parent_link_name;
    while (at != model_.links[parent].name) {
      const auto up = urdf_->getLink(at)->parent_joint;
      if (!up || up->type != urdf::Joint::FIXED) {
        AddFault(field,
                 fmt::format("a joint of \"{}\", the link before it", model_.links[parent].name),
                 fmt::format("\"{}\", a joint of \"{}\"", wanted.urdf, joint->parent_link_name));
        return false;
      }
      X_PU = FromUrdf(up->parent_to_joint_origin_transform) * X_PU;
      at = up->parent_link_name;
    }
    out.X_PJ = X_LU_[parent] * X_PU * X_LU_[index + 1].inverse();
    ReadMovement(*joint, wanted.urdf, index);
    return true;
  }

  void ReadMovement(const urdf::Joint& joint, const std::string& name, int index) {
    HandJoint& out = model_.joints[index];
    if (joint.mimic) {
      AddUrdfFault(
          name, "a joint that is driven by itself",
          "one that follows \"" + joint.mimic->joint_name + "\" (mimic): make it free, or fixed");
    }
    if (joint.type != urdf::Joint::REVOLUTE || !joint.limits) {
      AddUrdfFault(name, "a revolute joint with limits", MovementOf(joint));
      return;
    }
    const Vector3 axis = FromUrdf(joint.axis);
    if (std::abs(axis.norm() - 1.0) > 1e-6) {
      AddUrdfFault(name, "an axis of length 1", FormatDouble(axis.norm()));
      return;
    }
    out.axis = X_LU_[index + 1].linear() * axis;
    out.axis.normalize();
    const urdf::JointLimits& limits = *joint.limits;
    out.lower = model_.q_lower[index] = limits.lower;
    out.upper = model_.q_upper[index] = limits.upper;
    out.max_speed = limits.velocity;
    out.max_effort = limits.effort;
    if (!(out.lower < out.upper && std::abs(out.lower) < 10.0 && std::abs(out.upper) < 10.0)) {
      AddUrdfFault(name, "limits lower < upper in radians",
                   fmt::format("{} and {}", out.lower, out.upper));
    }
    if (!(out.max_speed > 0.0 && std::isfinite(out.max_speed))) {
      AddUrdfFault(name, "a limit of velocity above 0 rad/s", FormatDouble(out.max_speed));
    }
  }

  // Whatever moves on the palm is a finger's.
  void CheckLeftOver(const urdf::Link& link, const std::set<std::string>& used) {
    for (const auto& joint : link.child_joints) {
      if (joint->type != urdf::Joint::FIXED && used.count(joint->name) == 0) {
        AddUrdfFault(joint->name, "a joint that a finger of the description lists, or a fixed one",
                     "a joint that moves \"" + joint->child_link_name + '"');
        continue;
      }
      CheckLeftOver(*urdf_->getLink(joint->child_link_name), used);
    }
  }

  void ReadLink(int index) {
    HandLink& link = model_.links[index];
    const auto given = description_.capsules.find(link.name);
    if (given != description_.capsules.end()) {
      for (std::size_t i = 0; i < given->second.size(); ++i) {
        HandCapsule capsule = given->second[i];
        capsule.name = fmt::format("{}/{}", link.name, i + 1);
        capsule.link = index;
        capsule.p_LA = X_LU_[index] * capsule.p_LA;
        capsule.p_LB = X_LU_[index] * capsule.p_LB;
        model_.capsules.push_back(std::move(capsule));
      }
    }
    ReadBody(index, *urdf_->getLink(link.name), X_LU_[index], given == description_.capsules.end());
    CheckInertia(link);
  }

  // A link of the URDF with all that is fixed to it.
  void ReadBody(int index, const urdf::Link& urdf, const RigidTransform& X_LB, bool shapes) {
    AddInertia(urdf, X_LB, &model_.links[index]);
    if (shapes) ReadCapsules(index, urdf, X_LB);
    for (const auto& visual : urdf.visual_array) ReadVisual(index, *visual, urdf.name, X_LB);
    for (const auto& joint : urdf.child_joints) {
      if (joint->type != urdf::Joint::FIXED) continue;
      ReadBody(index, *urdf_->getLink(joint->child_link_name),
               X_LB * FromUrdf(joint->parent_to_joint_origin_transform), shapes);
    }
  }

  // That of a body: positive, and no moment above the sum of the other two.
  void CheckInertia(const HandLink& link) {
    if (!(link.mass > 0.0 && link.mass <= kMaxLinkMass)) {
      AddUrdfFault(link.name + ".inertial",
                   fmt::format("a mass above 0 and at most {} kg", kMaxLinkMass),
                   FormatDouble(link.mass));
      return;
    }
    const Vector3 moments = Eigen::SelfAdjointEigenSolver<Matrix3>(link.I_LLcm).eigenvalues();
    const bool physical = link.I_LLcm.allFinite() && moments[0] > 0.0 &&
                          moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-3);
    if (physical) return;
    AddUrdfFault(link.name + ".inertial", "moments of inertia that a body can have",
                 fmt::format("{:.3g}, {:.3g}, {:.3g}", moments[0], moments[1], moments[2]));
  }

  void ReadVisual(int link, const urdf::Visual& visual, const std::string& body,
                  const RigidTransform& X_LB) {
    HandVisual out;
    out.link = link;
    out.X_LV = X_LB * FromUrdf(visual.origin);
    out.rgba = {0.8F, 0.8F, 0.8F, 1.0F};
    if (visual.material) {
      const urdf::Color& color = visual.material->color;
      out.rgba = {color.r, color.g, color.b, color.a};
    }
    if (const auto mesh = std::dynamic_pointer_cast<urdf::Mesh>(visual.geometry)) {
      Mesh shape;
      try {
        shape.file = FindFile(urdf_file_.parent_path() / MeshFileOf(*mesh), description_.file,
                              body + ".visual")
                         .string();
      } catch (const InputError& error) {
        reading_.faults.push_back(error);
        return;
      }
      if (std::find(model_.files.begin(), model_.files.end(), shape.file) == model_.files.end()) {
        model_.files.emplace_back(shape.file);
      }
      out.shape = shape;
      out.scale = FromUrdf(mesh->scale);
    } else if (const auto box = std::dynamic_pointer_cast<urdf::Box>(visual.geometry)) {
      out.shape = Box{FromUrdf(box->dim)};
    } else if (const auto round = std::dynamic_pointer_cast<urdf::Cylinder>(visual.geometry)) {
      out.shape = Cylinder{round->radius, round->length};
    } else if (const auto ball = std::dynamic_pointer_cast<urdf::Sphere>(visual.geometry)) {
      out.shape = Sphere{ball->radius};
    } else {
      return;  // nothing to draw
    }
    model_.visuals.push_back(std::move(out));
  }

  // URDF knows no capsule: the cylinders of a link with the spheres at their ends, then the spheres
  // left over.
  void ReadCapsules(int index, const urdf::Link& urdf, const RigidTransform& X_LB) {
    struct Ball {
      std::string name;
      Vector3 p_L;
      double radius;
      bool used;
    };
    std::vector<Ball> balls;
    for (const auto& shape : urdf.collision_array) {
      if (const auto sphere = std::dynamic_pointer_cast<urdf::Sphere>(shape->geometry)) {
        balls.push_back(
            {shape->name, X_LB * FromUrdf(shape->origin.position), sphere->radius, false});
      } else if (!std::dynamic_pointer_cast<urdf::Cylinder>(shape->geometry)) {
        AddUrdfFault(urdf.name + ".collision", "cylinders and spheres",
                     fmt::format("a {}: say capsules = {{[\"{}\"] = ..}} in the description",
                                 ShapeOf(*shape), model_.links[index].name));
        return;
      }
    }
    for (const auto& shape : urdf.collision_array) {
      const auto cylinder = std::dynamic_pointer_cast<urdf::Cylinder>(shape->geometry);
      if (!cylinder) continue;
      const RigidTransform X_LC = X_LB * FromUrdf(shape->origin);
      HandCapsule capsule{urdf.name + '/' + (shape->name.empty() ? ShapeOf(*shape) : shape->name),
                          index,
                          {},
                          {},
                          cylinder->radius};
      for (const double end : {-0.5, 0.5}) {
        Vector3 p_L = X_LC * Vector3(0.0, 0.0, end * cylinder->length);
        const auto ball = std::find_if(balls.begin(), balls.end(), [&](const Ball& b) {
          return !b.used && b.name == shape->name && (b.p_L - p_L).norm() < kSamePlace &&
                 std::abs(b.radius - cylinder->radius) < kSamePlace;
        });
        if (ball != balls.end()) {
          ball->used = true;
          p_L = ball->p_L;
        }
        (end < 0.0 ? capsule.p_LA : capsule.p_LB) = p_L;
      }
      AddCapsule(std::move(capsule));
    }
    for (const Ball& ball : balls) {
      if (ball.used) continue;
      AddCapsule({urdf.name + '/' + (ball.name.empty() ? "sphere" : ball.name), index, ball.p_L,
                  ball.p_L, ball.radius});
    }
  }

  void AddCapsule(HandCapsule capsule) {
    if (!(capsule.radius > 0.0 && capsule.radius < 1.0 && capsule.p_LA.allFinite() &&
          capsule.p_LB.allFinite())) {
      AddUrdfFault(capsule.name, "a radius above 0 m and finite places",
                   FormatDouble(capsule.radius));
      return;
    }
    model_.capsules.push_back(std::move(capsule));
  }

  void ReadTip(Finger finger) {
    const auto f = static_cast<std::size_t>(finger);
    const HandDescription::Finger& wanted = description_.fingers[f];
    const std::string field = fmt::format("fingers[{}].tip", f + 1);
    Fingertip& tip = model_.tips[f];
    tip.link = model_.fingers[f].first + model_.fingers[f].count;
    tip.p_LT = X_LU_[tip.link] * wanted.tip.p;
    tip.radius = wanted.tip_radius;
    const std::string& link = model_.links[tip.link].name;
    tip.capsule = -1;
    bool any = false;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < model_.capsules.size(); ++i) {
      const HandCapsule& capsule = model_.capsules[i];
      if (capsule.link != tip.link) continue;
      any = true;
      const double away = AxisDistance(capsule, tip.p_LT);
      nearest = std::min(nearest, away - capsule.radius - tip.radius);
      const Vector3 end = tip.p_LT + tip.radius * Vector3::UnitZ();
      const double inside = capsule.radius - AxisDistance(capsule, end);
      if (inside > kTipInside) {
        AddFault(field, "a sphere at the finger's end",
                 fmt::format("one whose end lies {:.1f} mm within {}", 1e3 * inside, capsule.name));
        return;
      }
      const double off =
          std::min((capsule.p_LA - tip.p_LT).norm(), (capsule.p_LB - tip.p_LT).norm());
      if (off < kTipAtEnd && std::abs(capsule.radius - tip.radius) < kSamePlace) {
        tip.capsule = static_cast<int>(i);
      }
    }
    if (!any) {
      AddUrdfFault(link + ".collision", "the shape of the finger's last link", "none");
      return;
    }
    if (nearest > kTipFar) {
      AddFault(field, "a sphere at the end of \"" + link + '"',
               fmt::format("one {:.1f} mm off its collision shapes", 1e3 * nearest));
      return;
    }
    if (tip.capsule >= 0) return;
    tip.capsule = static_cast<int>(model_.capsules.size());
    model_.capsules.push_back({link + "/tip", tip.link, tip.p_LT, tip.p_LT, tip.radius});
  }

  static double AxisDistance(const HandCapsule& capsule, const Vector3& p_L) {
    const Vector3 axis = capsule.p_LB - capsule.p_LA;
    const double length = axis.squaredNorm();
    const double t =
        length > 0.0 ? std::clamp(axis.dot(p_L - capsule.p_LA) / length, 0.0, 1.0) : 0.0;
    return (capsule.p_LA + t * axis - p_L).norm();
  }

  // Into link order; tips' own spheres came last.
  void SortCapsules() {
    std::vector<int> order(model_.capsules.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::stable_sort(order.begin(), order.end(), [this](int a, int b) {
      return model_.capsules[a].link < model_.capsules[b].link;
    });
    std::vector<HandCapsule> sorted;
    std::vector<int> place(order.size());
    for (const int i : order) {
      place[i] = static_cast<int>(sorted.size());
      sorted.push_back(model_.capsules[i]);
    }
    model_.capsules = std::move(sorted);
    for (Fingertip& tip : model_.tips) {
      if (tip.capsule >= 0 && tip.capsule < static_cast<int>(place.size())) {
        tip.capsule = place[tip.capsule];
      }
    }
    std::string without;
    for (int link = 1; link < model_.num_links(); ++link) {
      const auto on_link = [link](const HandCapsule& capsule) { return capsule.link == link; };
      if (std::none_of(model_.capsules.begin(), model_.capsules.end(), on_link)) {
        without += (without.empty() ? "" : ", ") + model_.links[link].name;
      }
    }
    if (!without.empty()) reading_.notes.push_back("links without a collision shape: " + without);
  }

  void ReadPosture() {
    std::vector<std::string> names;
    for (int j = 0; j < model_.num_joints; ++j) {
      names.push_back(model_.joints[j].name);
      model_.posture[j] = std::clamp(0.0, model_.q_lower[j], model_.q_upper[j]);
    }
    for (const auto& [name, angle] : description_.posture) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        AddFault("posture." + name, "a joint of the description",
                 '"' + name + '"' + FormatHint(FindNearest(name, names)));
        continue;
      }
      const auto j = found - names.begin();
      model_.posture[j] = angle;
      if (!(angle >= model_.q_lower[j] && angle <= model_.q_upper[j])) {
        AddFault("posture." + name,
                 fmt::format("an angle from {} to {} rad", model_.q_lower[j], model_.q_upper[j]),
                 FormatDouble(angle));
      }
    }
  }

  void ChooseSelfPairs() {
    std::array<bool, kMaxHandLinks> has_capsule{};
    for (const HandCapsule& capsule : model_.capsules) has_capsule[capsule.link] = true;
    // The nearest link towards the palm that has a capsule.
    const auto neighbour = [&](int link) {
      do {
        link = model_.joints[link - 1].parent;
      } while (link != 0 && !has_capsule[link]);
      return link;
    };
    const std::set<std::pair<std::string, std::string>> allowed = AllowedTouches();
    const int count = static_cast<int>(model_.capsules.size());
    for (int i = 0; i < count; ++i) {
      for (int k = i + 1; k < count; ++k) {
        const int a = model_.capsules[i].link;
        const int b = model_.capsules[k].link;  // a <= b: capsules are in link order
        if (a == b || neighbour(b) == a) continue;
        if (allowed.count({model_.links[a].name, model_.links[b].name}) != 0) continue;
        model_.self_pairs.emplace_back(i, k);
      }
    }
  }

  std::set<std::pair<std::string, std::string>> AllowedTouches() {
    std::vector<std::string> names;
    names.reserve(model_.num_links());
    for (int link = 0; link < model_.num_links(); ++link) names.push_back(model_.links[link].name);
    std::set<std::pair<std::string, std::string>> allowed;
    for (std::size_t i = 0; i < description_.may_touch.size(); ++i) {
      const auto& [a, b] = description_.may_touch[i];
      for (const std::string& name : {a, b}) {
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        AddFault(fmt::format("may_touch[{}]", i + 1), "the palm or a link that a joint moves",
                 '"' + name + '"' + FormatHint(FindNearest(name, names)));
      }
      allowed.insert({a, b});
      allowed.insert({b, a});
    }
    return allowed;
  }

  void CheckPosture() {
    HandPose pose;
    CalcHandPose(model_, RigidTransform::Identity(), model_.posture, &pose);
    CapsuleEnds ends;
    CalcCapsuleEnds(model_, pose, &ends);
    std::vector<HandDistance> near;
    FindNearSelf(model_, ends, 0.0, &near);
    if (near.empty()) return;
    const HandDistance& worst = *std::min_element(
        near.begin(), near.end(),
        [](const HandDistance& a, const HandDistance& b) { return a.distance < b.distance; });
    AddFault("posture", "one in which no part of the hand overlaps another",
             fmt::format("{} and {}, which overlap by {:.1f} mm (may_touch lets links touch)",
                         model_.capsules[worst.capsule].name, model_.capsules[worst.other].name,
                         -1e3 * worst.distance));
  }

  const HandDescription description_;
  HandReading& reading_;
  HandModel& model_;
  fs::path urdf_file_;
  urdf::ModelInterfaceSharedPtr urdf_;
  std::array<RigidTransform, kMaxHandLinks> X_LU_;  // the URDF's frame of a link in ours
};

}  // namespace

HandReading ReadHand(const fs::path& file) {
  HandReading reading;
  try {
    Reader(ReadHandFile(file), &reading).Read();
  } catch (const InputError& error) {
    reading.faults.push_back(error);
  }
  return reading;
}

}  // namespace pregrasp
