#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <vector>

#include "tests/bench/dynamics_scenes.h"

namespace pregrasp {
namespace {

constexpr double kDt = 1.0 / 240.0;
constexpr double kMargin = 1e-3;  // [m]; the default of 4 cm is larger than these objects

btVector3 ToBullet(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
Vector3 FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform ToBullet(const RigidTransform& X) {
  const Quaternion q(X.linear());
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), ToBullet(Vector3(X.translation())));
}

class BulletScene {
 public:
  BulletScene(const DynamicsCase& c, int iterations)
      : dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
    world_.setGravity(ToBullet(c.scene.gravity));
    world_.getSolverInfo().m_numIterations = iterations;
    for (const Body& body : c.scene.bodies) AddBody(body);
  }
  ~BulletScene() {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  BulletScene(const BulletScene&) = delete;
  BulletScene& operator=(const BulletScene&) = delete;

  void Step() { world_.stepSimulation(kDt, 0, kDt); }
  btRigidBody& object() { return *bodies_[0]; }
  const Vector3& p_OoOcm() const { return p_OoOcm_; }

 private:
  btCollisionShape* Keep(std::unique_ptr<btCollisionShape> shape) {
    shapes_.push_back(std::move(shape));
    return shapes_.back().get();
  }

  btCollisionShape* MakeShape(const Shape& shape) {
    if (const auto* box = std::get_if<Box>(&shape)) {
      return Keep(std::make_unique<btBoxShape>(ToBullet(Vector3(0.5 * box->size))));
    }
    if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      auto made = std::make_unique<btCylinderShapeZ>(
          btVector3(cylinder->radius, cylinder->radius, 0.5 * cylinder->height));
      made->setMargin(kMargin);
      return Keep(std::move(made));
    }
    const TriangleMesh& mesh = std::get<Mesh>(shape).mesh;
    auto hull = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < mesh.V.rows(); ++i) {
      hull->addPoint(btVector3(mesh.V(i, 0), mesh.V(i, 1), mesh.V(i, 2)), false);
    }
    hull->recalcLocalAabb();
    hull->setMargin(kMargin);
    return Keep(std::move(hull));
  }

  // A body whose frame is at the centre of mass.
  void AddBody(const Body& body) {
    const Vector3 p_BoBcm =
        body.movable() ? body.mass_properties->p_BoBcm : Vector3(Vector3::Zero());
    btCollisionShape* shape = nullptr;
    const auto* whole = std::get_if<Union>(&body.shape);
    if (body.name == "table") {  // the engine's best table is a plane
      shape = Keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), 0.05));
    } else if (whole != nullptr || p_BoBcm.norm() > 0.0) {
      auto compound = std::make_unique<btCompoundShape>();
      const RigidTransform shift(Eigen::Translation3d(-p_BoBcm));
      if (whole == nullptr) compound->addChildShape(ToBullet(shift), MakeShape(body.shape));
      for (std::size_t i = 0; whole != nullptr && i < whole->parts.size(); ++i) {
        compound->addChildShape(ToBullet(shift * whole->parts[i].X_BP),
                                MakeShape(whole->parts[i].shape));
      }
      shape = Keep(std::move(compound));
    } else {
      shape = MakeShape(body.shape);
    }
    double mass = 0.0;
    btVector3 inertia(0, 0, 0);
    if (body.movable()) {
      mass = body.mass_properties->mass;
      inertia = ToBullet(Vector3(body.mass_properties->I_BBcm.diagonal()));
    }
    if (bodies_.empty()) p_OoOcm_ = p_BoBcm;
    states_.push_back(std::make_unique<btDefaultMotionState>(
        ToBullet(RigidTransform(body.X_WB * Eigen::Translation3d(p_BoBcm)))));
    btRigidBody::btRigidBodyConstructionInfo info(mass, states_.back().get(), shape, inertia);
    info.m_friction = std::sqrt(body.friction);  // a pair multiplies
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btDefaultMotionState>> states_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  Vector3 p_OoOcm_ = Vector3::Zero();
};

}  // namespace

EngineRun RunBullet(const DynamicsCase& c, int iterations) {
  BulletScene scene(c, iterations);
  btRigidBody& object = scene.object();
  const Vector3 nhat_O = c.finger ? FingerNormal(c) : Vector3(Vector3::UnitZ());
  const btVector3 r_O = ToBullet(Vector3(c.p_OC - scene.p_OoOcm()));
  const Vector3 p_WC_start = c.scene.object().X_WB * c.p_OC;
  EngineRun run;
  run.steps = static_cast<int>(std::lround(DynamicsCase::kSeconds / kDt));
  const double start = ThreadCpuSeconds();
  for (int i = 0; i < run.steps; ++i) {
    if (c.finger) {
      const btTransform& X_WO = object.getWorldTransform();
      const btVector3 r_W = X_WO.getBasis() * r_O;
      const Vector3 f = CalcPeerFingerForce(c, c.TargetAt((i + 1) * kDt, p_WC_start),
                                            FromBullet(X_WO.getOrigin() + r_W),
                                            FromBullet(object.getVelocityInLocalPoint(r_W)),
                                            FromBullet(X_WO.getBasis() * ToBullet(nhat_O)));
      object.applyForce(ToBullet(f), r_W);
    }
    scene.Step();
  }
  run.cpu_seconds = ThreadCpuSeconds() - start;
  const btTransform& X_WO = object.getWorldTransform();
  const btQuaternion q = X_WO.getRotation();
  run.X_WO = MakeTransform(Quaternion(q.w(), q.x(), q.y(), q.z()), FromBullet(X_WO.getOrigin())) *
             Eigen::Translation3d(-scene.p_OoOcm());
  return run;
}

}  // namespace pregrasp
