#include "app/geometry/solids.h"

#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <set>

#include "app/geometry/bounds.h"
#include "app/geometry/fcl_shape.h"
#include "app/geometry/mesh_topology.h"

namespace pregrasp {
namespace {

// The components of a mesh and how they lie to each other.
class Components {
 public:
  explicit Components(const TriangleMesh& mesh) : label_(LabelComponents(mesh)) {
    const int count = 1 + *std::max_element(label_.begin(), label_.end());
    geometry_.resize(count);
    group_.resize(count);
    std::iota(group_.begin(), group_.end(), 0);
    parts_ = SplitFaces(mesh, label_, count);
    for (const TriangleMesh& part : parts_) {
      bounds_.emplace_back(Vector3(part.V.colwise().minCoeff()),
                           Vector3(part.V.colwise().maxCoeff()));
    }
    FindGroups();
    for (int c = 0; c < count; ++c) cavity_.push_back(CountAround(c) % 2 == 1);
  }

  int count() const { return static_cast<int>(parts_.size()); }
  const std::vector<int>& label() const { return label_; }
  bool is_cavity(int c) const { return cavity_[c]; }
  bool is_outward(int c) const { return CalcVolume(parts_[c]) > 0.0; }
  bool meets_another(int c) const {
    return std::count(group_.begin(), group_.end(), group_[c]) > 1;
  }
  // Whether the first corner of c, and its bounds, lie within d.
  bool IsWithin(int c, int d) const {
    if (c == d || !bounds_[d].contains(bounds_[c])) return false;
    return std::abs(CalcWindingNumber(parts_[d], parts_[c].V.row(0))) > 0.5;
  }

 private:
  // Components whose surfaces meet, directly or through others, are one group.
  void FindGroups() {
    for (int c = 0; c < count(); ++c) {
      for (int d = c + 1; d < count(); ++d) {
        if (group_[c] == group_[d] || !Meet(c, d)) continue;
        std::replace(group_.begin(), group_.end(), int{group_[d]}, int{group_[c]});
      }
    }
  }

  bool Meet(int c, int d) {
    if (!bounds_[c].intersects(bounds_[d])) return false;
    const fcl::CollisionRequestd request(1, false);
    fcl::CollisionResultd result;
    const RigidTransform here = RigidTransform::Identity();
    return fcl::collide(Geometry(c), here, Geometry(d), here, request, result) > 0;
  }

  const fcl::CollisionGeometryd* Geometry(int c) {
    if (!geometry_[c]) geometry_[c] = MakeFclShape(Mesh{"", 1.0, parts_[c], false, ""});
    return geometry_[c].get();
  }

  // Groups other than its own that c lies within.
  int CountAround(int c) const {
    std::set<int> around;
    for (int d = 0; d < count(); ++d) {
      if (group_[d] != group_[c] && around.count(group_[d]) == 0 && IsWithin(c, d)) {
        around.insert(group_[d]);
      }
    }
    return static_cast<int>(around.size());
  }

  std::vector<int> label_;
  std::vector<TriangleMesh> parts_;
  std::vector<AlignedBox> bounds_;
  std::vector<std::shared_ptr<fcl::CollisionGeometryd>> geometry_;
  std::vector<int> group_;
  std::vector<bool> cavity_;
};

}  // namespace

std::vector<TriangleMesh> SeparateSolids(const TriangleMesh& mesh) {
  const Components components(mesh);
  TriangleMesh turned = mesh;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const int c = components.label()[f];
    if (components.is_outward(c) == components.is_cavity(c)) {
      std::swap(turned.F(f, 1), turned.F(f, 2));
    }
  }
  constexpr int kNone = -1;
  std::vector<int> solid_of(components.count(), kNone);
  int count = 0;
  for (int c = 0; c < components.count(); ++c) {
    if (components.is_cavity(c) || !components.meets_another(c)) continue;
    solid_of[c] = count++;
    for (int d = 0; d < components.count(); ++d) {
      const bool is_free = solid_of[d] == kNone && components.is_cavity(d);
      if (is_free && components.IsWithin(d, c)) solid_of[d] = solid_of[c];
    }
  }
  if (std::find(solid_of.begin(), solid_of.end(), kNone) != solid_of.end()) {
    std::replace(solid_of.begin(), solid_of.end(), kNone, count++);
  }
  std::vector<int> solid_of_face;
  for (const int c : components.label()) solid_of_face.push_back(solid_of[c]);
  return SplitFaces(turned, solid_of_face, count);
}

}  // namespace pregrasp
