#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <variant>

#include "tests/bench/dynamics_scenes.h"
#include "tests/mjcf.h"

namespace pregrasp {
namespace {

using testing::FreeMujoco;
using testing::LoadMjcf;
using testing::MjcfShape;
using testing::MjcfText;

// One scene as an MJCF model: a free joint for what moves, a plane for the table.
class ModelWriter {
 public:
  std::string Write(const Scene& scene) {
    std::string bodies;
    for (const Body& body : scene.bodies) bodies += WriteBody(body);
    return fmt::format(
        "<mujoco><option gravity=\"{}\"/><asset>{}</asset><worldbody>{}</worldbody></mujoco>",
        MjcfText(scene.gravity), meshes_, bodies);
  }

 private:
  std::string WriteBody(const Body& body) {
    if (body.name == "table") {
      return fmt::format("<geom type=\"plane\" size=\"1 1 1\" friction=\"{} 0 0\"/>",
                         body.friction);
    }
    std::string text = fmt::format("<body name=\"{}\" pos=\"{}\" quat=\"{}\">", body.name,
                                   MjcfText(Vector3(body.X_WB.translation())),
                                   MjcfText(Quaternion(body.X_WB.linear())));
    if (body.movable()) {
      const MassProperties& mass = *body.mass_properties;
      text +=
          fmt::format("<freejoint/><inertial pos=\"{}\" mass=\"{}\" diaginertia=\"{}\"/>",
                      MjcfText(mass.p_BoBcm), mass.mass, MjcfText(Vector3(mass.I_BBcm.diagonal())));
    }
    text += WriteGeoms(body.shape, RigidTransform::Identity(), body.friction);
    text += "</body>";
    return text;
  }

  std::string WriteGeoms(const Shape& shape, const RigidTransform& X_BP, double friction) {
    if (const auto* whole = std::get_if<Union>(&shape)) {
      std::string text;
      for (const PlacedShape& part : whole->parts) {
        text += WriteGeoms(part.shape, X_BP * part.X_BP, friction);
      }
      return text;
    }
    return fmt::format("<geom {} pos=\"{}\" quat=\"{}\" friction=\"{} 0 0\"/>",
                       MjcfShape(shape, "hull", &meshes_), MjcfText(Vector3(X_BP.translation())),
                       MjcfText(Quaternion(X_BP.linear())), friction);
  }

  std::string meshes_;
};

}  // namespace

EngineRun RunMujoco(const DynamicsCase& c) {
  const std::unique_ptr<mjModel, FreeMujoco> owned_model = LoadMjcf(ModelWriter().Write(c.scene));
  mjModel* const model = owned_model.get();
  const std::unique_ptr<mjData, FreeMujoco> owned_data(mj_makeData(model));
  mjData* const data = owned_data.get();
  const int object = mj_name2id(model, mjOBJ_BODY, c.scene.object().name.c_str());
  const Vector3 nhat_O = c.finger ? FingerNormal(c) : Vector3(Vector3::UnitZ());
  const Vector3 p_WC_start = c.scene.object().X_WB * c.p_OC;
  const auto pose = [&] {
    const double* q = data->qpos;  // the object comes first
    return MakeTransform(Quaternion(q[3], q[4], q[5], q[6]), Vector3(q[0], q[1], q[2]));
  };
  EngineRun run;
  const double dt = model->opt.timestep;
  run.steps = static_cast<int>(std::lround(DynamicsCase::kSeconds / dt));
  const double start = ThreadCpuSeconds();
  for (int i = 0; i < run.steps; ++i) {
    if (c.finger) {
      const RigidTransform X_WO = pose();
      const Vector3 r_W = X_WO.linear() * c.p_OC;
      const Vector3 w_W = X_WO.linear() * Vector3(data->qvel[3], data->qvel[4], data->qvel[5]);
      const Vector3 v_W(data->qvel[0], data->qvel[1], data->qvel[2]);
      const Vector3 f =
          CalcPeerFingerForce(c, c.TargetAt((i + 1) * dt, p_WC_start), X_WO.translation() + r_W,
                              v_W + w_W.cross(r_W), X_WO.linear() * nhat_O);
      const Vector3 arm = X_WO.linear() * (c.p_OC - c.scene.object().mass_properties->p_BoBcm);
      const Vector3 torque = arm.cross(f);
      for (int k = 0; k < 3; ++k) {
        data->xfrc_applied[6 * object + k] = f[k];
        data->xfrc_applied[6 * object + 3 + k] = torque[k];
      }
    }
    mj_step(model, data);
  }
  run.cpu_seconds = ThreadCpuSeconds() - start;
  run.X_WO = pose();
  return run;
}

}  // namespace pregrasp
