#include "app/recording/scene_file.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/core/error.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"
#include "app/core/json_values.h"
#include "app/geometry/obj_text.h"
#include "app/hand/hand_model.h"
#include "app/recording/checked_file.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kSceneSchema[] = "pregrasp.scene/1";

Json ToJson(const RigidTransform& X) {
  return {{"p", pregrasp::ToJson(Vector3(X.translation()))},
          {"q", QuaternionJson(X.linear())},
          {"R", pregrasp::ToJson(Matrix3(X.linear()))}};
}

RigidTransform ReadTransform(const JsonReader& reader) {
  const Matrix3 R = reader["R"].Mat3();
  if (!((R - reader["q"].Quat().toRotationMatrix()).cwiseAbs().maxCoeff() < 1e-6)) {
    reader["R"].Fail("the rotation that q gives");
  }
  return MakeTransform(R, reader["p"].Vec3());
}

// Writes a shape's meshes as it turns it into JSON. Names of bodies have no '.', so "NAME.PART.obj"
// is no other body's file.
class ShapeWriter {
 public:
  ShapeWriter(const std::filesystem::path& directory, std::string name)
      : directory_(directory), name_(std::move(name)) {}

  Json operator()(const Box& box) const {
    return {{"kind", "box"}, {"size", pregrasp::ToJson(box.size)}};
  }
  Json operator()(const Cylinder& cylinder) const {
    return {{"kind", "cylinder"}, {"radius", cylinder.radius}, {"height", cylinder.height}};
  }
  Json operator()(const Capsule& capsule) const {
    return {{"kind", "capsule"}, {"radius", capsule.radius}, {"height", capsule.height}};
  }
  Json operator()(const Sphere& sphere) const {
    return {{"kind", "sphere"}, {"radius", sphere.radius}};
  }
  Json operator()(const Mesh& mesh) const {
    return {{"kind", "mesh"},
            {"file", Write(".obj", mesh.mesh)},
            {"source",
             {{"file", mesh.file},
              {"scale", mesh.scale},
              {"repair", mesh.repair},
              {"repaired", mesh.repaired}}}};
  }
  Json operator()(const Cloud& cloud) const {
    return {{"kind", "cloud"},
            {"file", Write(".obj", cloud.mesh)},
            {"points", Write(".points.obj", {cloud.points, {}})},
            {"source", {{"file", cloud.file}, {"scale", cloud.scale}}}};
  }
  Json operator()(const Union& whole) const {
    Json parts = Json::array();
    for (std::size_t i = 0; i < whole.parts.size(); ++i) {
      const PlacedShape& part = whole.parts[i];
      const ShapeWriter writer(directory_, fmt::format("{}.{}", name_, i + 1));
      parts.push_back({{"X_BP", ToJson(part.X_BP)}, {"shape", std::visit(writer, part.shape)}});
    }
    return {{"kind", "union"}, {"parts", std::move(parts)}};
  }

 private:
  std::string Write(const char* ending, const TriangleMesh& mesh) const {
    MakeFolder(directory_ / "meshes");
    std::string file = "meshes/" + name_ + ending;
    WriteFile(directory_ / file, FormatObj(mesh));
    return file;
  }

  const std::filesystem::path& directory_;
  std::string name_;
};

std::filesystem::path FileInside(const JsonReader& file, const std::filesystem::path& directory) {
  const std::filesystem::path relative = file.Text();
  if (relative.is_absolute() || relative.lexically_normal() != relative ||
      *relative.begin() == "..") {
    file.Fail("a path inside the run directory");
  }
  return directory / relative;
}

TriangleMesh ReadMesh(const JsonReader& file, const std::filesystem::path& directory) {
  const std::filesystem::path path = FileInside(file, directory);
  return ParseObj(ReadFile(path), path.string());
}

Shape ReadShape(const JsonReader& reader, const std::filesystem::path& directory) {
  const std::string kind = reader["kind"].Text();
  if (kind == "box") return Box{reader["size"].Vec3()};
  if (kind == "cylinder") return Cylinder{reader["radius"].Number(), reader["height"].Number()};
  if (kind == "capsule") return Capsule{reader["radius"].Number(), reader["height"].Number()};
  if (kind == "sphere") return Sphere{reader["radius"].Number()};
  if (kind == "mesh") {
    const JsonReader source = reader["source"];
    return Mesh{source["file"].Text(), source["scale"].Number(),
                ReadMesh(reader["file"], directory), source["repair"].Bool(),
                source["repaired"].Text()};
  }
  if (kind == "cloud") {
    return Cloud{reader["source"]["file"].Text(), reader["source"]["scale"].Number(),
                 ReadMesh(reader["points"], directory).V, ReadMesh(reader["file"], directory)};
  }
  if (kind == "union") {
    Union whole;
    const JsonReader parts = reader["parts"];
    for (std::size_t i = 0; i < parts.size(); ++i) {
      whole.parts.push_back(
          {ReadShape(parts[i]["shape"], directory), ReadTransform(parts[i]["X_BP"])});
    }
    return whole;
  }
  reader["kind"].Fail("box, cylinder, capsule, sphere, mesh, cloud or union");
}

// The design's name for the object's centre of mass is p_O_com, O being the object's frame.
const char* CenterOfMassKey(bool is_object) { return is_object ? "p_O_com" : "p_B_com"; }

Json BodyToJson(const Body& body, bool is_object, const std::filesystem::path& directory) {
  Json json = {{"name", body.name},
               {"movable", body.movable()},
               {"shape", std::visit(ShapeWriter(directory, body.name), body.shape)},
               {"X_WB", ToJson(body.X_WB)},
               {"friction", body.friction},
               {"mass", nullptr},
               {CenterOfMassKey(is_object), nullptr},
               {"inertia", nullptr}};
  if (body.movable()) {
    json["mass"] = body.mass_properties->mass;
    json[CenterOfMassKey(is_object)] = pregrasp::ToJson(body.mass_properties->p_BoBcm);
    json["inertia"] = pregrasp::ToJson(body.mass_properties->I_BBcm);
  }
  return json;
}

Body ReadBody(const JsonReader& reader, bool is_object, const std::filesystem::path& directory) {
  Body body;
  body.name = reader["name"].Text();
  body.shape = ReadShape(reader["shape"], directory);
  body.X_WB = ReadTransform(reader["X_WB"]);
  body.friction = reader["friction"].Number();
  if (reader["movable"].Bool()) {
    body.mass_properties =
        MassProperties{reader["mass"].Number(), reader[CenterOfMassKey(is_object)].Vec3(),
                       reader["inertia"].Mat3()};
  }
  return body;
}

Json CameraToJson(const CameraConfig& camera) {
  return {{"p_WCam", pregrasp::ToJson(camera.p_WCam)},
          {"p_WTarget", pregrasp::ToJson(camera.p_WTarget)},
          {"fov_deg", camera.fov_deg}};
}

Json FingertipsToJson(const Scene& scene) {
  const FingertipConfig& tips = scene.fingertips;
  // The resolved damping of the spring law, for readers; LoadScene uses `damping`.
  const double b = tips.damping * std::sqrt(tips.stiffness * scene.object().mass_properties->mass);
  return {{"friction", tips.friction},   {"max_force", tips.max_force},
          {"stiffness", tips.stiffness}, {"damping", tips.damping},
          {"damping_N_s_per_m", b},      {"grasp_stiffness", tips.grasp_stiffness}};
}

// The files of a hand that is not shipped, as they lie to each other, below `hand`.
std::string CopyHand(const HandModel& hand, const std::filesystem::path& directory) {
  const std::filesystem::path from = std::filesystem::absolute(hand.file).parent_path();
  for (const std::filesystem::path& file : hand.files) {
    const std::filesystem::path to =
        "hand" / std::filesystem::absolute(file).lexically_normal().lexically_relative(
                     from.lexically_normal());
    if (to.lexically_normal().begin()->string() != "hand") continue;  // a shipped hand's
    MakeFolder((directory / to).parent_path());
    WriteFile(directory / to, ReadFile(file));
  }
  return "hand/" + hand.file.filename().string();
}

Json HandToJson(const Scene& scene, const std::filesystem::path& directory) {
  const HandModel& hand = HandOf(scene);
  Json joints = Json::array(), tips = Json::array();
  for (int j = 0; j < hand.num_joints; ++j) joints.push_back(hand.joints[j].name);
  for (int f = 0; f < hand.num_fingers; ++f) {
    tips.push_back({{"finger", kFingerNames[f]}, {"radius", hand.tips[f].radius}});
  }
  const std::string name = IsHandFile(scene.hand) ? CopyHand(hand, directory) : scene.hand;
  return {{"name", name}, {"sha256", hand.sha256}, {"joints", joints}, {"tips", tips}};
}

// A run shows and moves the hand that it was planned with, or none.
void ReadHand(const JsonReader& reader, const std::filesystem::path& directory, Scene& scene) {
  scene.hand = reader["name"].Text();
  if (IsHandFile(scene.hand)) scene.hand = FileInside(reader["name"], directory).string();
  if (HandOf(scene).sha256 != reader["sha256"].Text()) {
    reader["sha256"].Fail("that of the hand \"" + scene.hand + "\" as it is now, " +
                          HandOf(scene).sha256);
  }
}

}  // namespace

void WriteScene(const std::filesystem::path& directory, const Scene& scene, double dt) {
  Json bodies = Json::array();
  for (const Body& body : scene.bodies) {
    bodies.push_back(BodyToJson(body, &body == scene.bodies.data(), directory));
  }
  const Json json = {{"schema", kSceneSchema},
                     {"name", scene.name},
                     {"gravity", pregrasp::ToJson(scene.gravity)},
                     {"dt", dt},
                     {"fingertips", FingertipsToJson(scene)},
                     {"hand", HandToJson(scene, directory)},
                     {"camera", scene.camera ? CameraToJson(*scene.camera) : Json()},
                     {"bodies", std::move(bodies)}};
  WriteFile(directory / "scene.json", FormatJsonIndented(json));
}

Scene LoadScene(const std::filesystem::path& file) {
  const nlohmann::json document = ParseJson(ReadFile(file), file.string());
  const JsonReader reader(document, file.string());
  if (reader["schema"].Text() != kSceneSchema) reader["schema"].Fail(kSceneSchema);
  Scene scene;
  scene.name = reader["name"].Text();
  scene.file = file.string();
  scene.gravity = reader["gravity"].Vec3();
  const JsonReader tips = reader["fingertips"];
  scene.fingertips = {tips["friction"].Number(), tips["max_force"].Number(),
                      tips["stiffness"].Number(), tips["damping"].Number(),
                      tips["grasp_stiffness"].Number()};
  if (const JsonReader camera = reader["camera"]; !camera.is_null()) {
    scene.camera = CameraConfig{camera["p_WCam"].Vec3(), camera["p_WTarget"].Vec3(),
                                camera["fov_deg"].Number()};
  }
  if (document.contains("hand"))
    ReadHand(reader["hand"], file.parent_path(), scene);  // without, the default
  TakeHand(scene);
  const JsonReader bodies = reader["bodies"];
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    scene.bodies.push_back(ReadBody(bodies[i], i == 0, file.parent_path()));
    scene.bodies.back().where = fmt::format("{}: bodies[{}]", file.string(), i);
  }
  ValidateScene(scene);
  return scene;
}

}  // namespace pregrasp
