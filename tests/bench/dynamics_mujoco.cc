#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <variant>

#include "app/core/check.h"
#include "tests/bench/dynamics_scenes.h"

namespace pregrasp {
namespace {

std::string Text(const Vector3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string Text(const Quaternion& q) {
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

// One scene as an MJCF model: a free joint for what moves, a plane for the table.
class ModelWriter {
 public:
  std::string Write(const Scene& scene) {
    std::string bodies;
    for (const Body& body : scene.bodies) bodies += WriteBody(body);
    return fmt::format(
        "<mujoco><option gravity=\"{}\"/><asset>{}</asset><worldbody>{}</worldbody></mujoco>",
        Text(scene.gravity), meshes_, bodies);
  }

 private:
  std::string WriteBody(const Body& body) {
    if (body.name == "table") {
      return fmt::format("<geom type=\"plane\" size=\"1 1 1\" friction=\"{} 0 0\"/>",
                         body.friction);
    }
    std::string text =
        fmt::format("<body name=\"{}\" pos=\"{}\" quat=\"{}\">", body.name,
                    Text(Vector3(body.X_WB.translation())), Text(Quaternion(body.X_WB.linear())));
    if (body.movable()) {
      const MassProperties& mass = *body.mass_properties;
      text += fmt::format("<freejoint/><inertial pos=\"{}\" mass=\"{}\" diaginertia=\"{}\"/>",
                          Text(mass.p_BoBcm), mass.mass, Text(Vector3(mass.I_BBcm.diagonal())));
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
    std::string kind;
    if (const auto* box = std::get_if<Box>(&shape)) {
      kind = fmt::format("type=\"box\" size=\"{}\"", Text(Vector3(0.5 * box->size)));
    } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
      kind =
          fmt::format("type=\"cylinder\" size=\"{} {}\"", cylinder->radius, 0.5 * cylinder->height);
    } else {
      const TriangleMesh& mesh = std::get<Mesh>(shape).mesh;
      std::string vertices;
      for (int i = 0; i < mesh.V.rows(); ++i) vertices += fmt::format(" {}", Text(mesh.V.row(i)));
      meshes_ += fmt::format("<mesh name=\"hull\" vertex=\"{}\"/>", vertices);
      kind = "type=\"mesh\" mesh=\"hull\"";
    }
    return fmt::format("<geom {} pos=\"{}\" quat=\"{}\" friction=\"{} 0 0\"/>", kind,
                       Text(Vector3(X_BP.translation())), Text(Quaternion(X_BP.linear())),
                       friction);
  }

  std::string meshes_;
};

mjModel* LoadModel(const std::string& xml) {
  auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  mj_makeEmptyFileVFS(vfs.get(), "scene.xml", static_cast<int>(xml.size()));
  const int file = mj_findFileVFS(vfs.get(), "scene.xml");
  std::memcpy(vfs->filedata[file], xml.data(), xml.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML("scene.xml", vfs.get(), error, sizeof(error));
  mj_deleteVFS(vfs.get());
  PREGRASP_CHECK(model != nullptr, error);
  return model;
}

}  // namespace

EngineRun RunMujoco(const DynamicsCase& c) {
  mjModel* model = LoadModel(ModelWriter().Write(c.scene));
  mjData* data = mj_makeData(model);
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
  mj_deleteData(data);
  mj_deleteModel(model);
  return run;
}

}  // namespace pregrasp
