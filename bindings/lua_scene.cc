#include "bindings/lua_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "app/scene/limits.h"
#include "bindings/function.h"
#include "bindings/machine.h"

namespace pregrasp {

namespace {
const ClassInfo kShapeClass{"Shape", {}, {}, nullptr};
const ClassInfo kSceneClass{"Scene", {}, {}, nullptr};
}  // namespace

template <>
struct LuaClass<const LuaShape> {
  static const ClassInfo& info() { return kShapeClass; }
  static const Session* session(const LuaShape& /*shape*/) { return nullptr; }
};
template <>
struct LuaClass<const Scene> {
  static const ClassInfo& info() { return kSceneClass; }
  static const Session* session(const Scene& /*scene*/) { return nullptr; }
};

namespace {

using ShapePtr = std::shared_ptr<const LuaShape>;

const Schema kSceneKeys{
    "SceneTable", {"name", "object", "environment", "fingertips", "hand", "gravity", "camera"}};
const Schema kBodyKeys{"BodyTable",
                       {"name", "shape", "p", "rpy_deg", "mass", "friction", "com", "inertia"}};
const Schema kFingertipKeys{"FingertipsTable",
                            {"friction", "max_force", "stiffness", "damping", "grasp_stiffness"}};
const Schema kCameraKeys{"CameraTable", {"p", "look_at", "fov_deg"}};
const Schema kPlacedKeys{"PlacedShapeTable", {"shape", "p", "rpy_deg"}};
const Schema kBoxKeys{"BoxTable", {"x", "y", "z"}};
const Schema kRoundKeys{"CylinderTable", {"r", "h"}};
const Schema kSphereKeys{"SphereTable", {"r"}};
const Schema kFileKeys{"FileTable", {"scale"}};
const Schema kMeshFileKeys{"MeshFileTable", {"scale", "repair"}};

const char kOneSceneOnly = 0;  // registry key, by address

constexpr int kMaxParts = 1000;  // of a union, all levels
constexpr int kMaxDepth = 16;    // of unions within unions

// box{1, 2, 3} or box{x = 1, y = 2, z = 3}, in metres.
std::vector<double> ReadSizes(lua_State* L, const Schema& schema) {
  std::string named;
  for (const std::string& key : schema.keys) named += (named.empty() ? "" : ", ") + key;
  const auto count = static_cast<int>(schema.keys.size());
  std::vector<double> sizes;
  if (lua_rawlen(L, 1) > 0) {
    sizes = LuaValue<std::vector<double>>::Read(L, 1, "");
    if (static_cast<int>(sizes.size()) != count) {
      throw InputError("", "", "{" + named + "} in metres",
                       fmt::format("{} numbers", sizes.size()));
    }
    return sizes;
  }
  const Fields fields(L, 1, schema);
  for (const std::string& key : schema.keys) sizes.push_back(fields.Required<double>(key));
  return sizes;
}

ShapePtr MakeShape(lua_State* L, Shape shape, int parts = 1, int depth = 1) {
  return std::make_shared<const LuaShape>(LuaShape{std::move(shape), WhereInLua(L), parts, depth});
}

}  // namespace

OneTable LuaValue<OneTable>::Read(lua_State* L, int index, const std::string& /*path*/) {
  if (!lua_istable(L, index)) {
    throw InputError("", "", "one table in braces {..}", DescribeValue(L, index));
  }
  return {L};
}

namespace {

ShapePtr MakeBox(OneTable table) {
  const std::vector<double> size = ReadSizes(table.L, kBoxKeys);
  return MakeShape(table.L, Box{{size[0], size[1], size[2]}});
}

ShapePtr MakeCylinder(OneTable table) {
  const std::vector<double> size = ReadSizes(table.L, kRoundKeys);
  return MakeShape(table.L, Cylinder{size[0], size[1]});
}

ShapePtr MakeCapsule(OneTable table) {
  const std::vector<double> size = ReadSizes(table.L, kRoundKeys);
  return MakeShape(table.L, Capsule{size[0], size[1]});
}

ShapePtr MakeSphere(OneTable table) {
  return MakeShape(table.L, Sphere{ReadSizes(table.L, kSphereKeys)[0]});
}

ShapePtr MakeMesh(OneTable table) {
  const Fields fields(table.L, 1, kMeshFileKeys, "", "", 1);
  Mesh shape;
  shape.file = fields.Positional<std::string>(1, "file");
  shape.scale = fields.Optional<double>("scale", 1.0);
  shape.repair = fields.Optional<bool>("repair", false);
  return MakeShape(table.L, std::move(shape));
}

ShapePtr MakeCloud(OneTable table) {
  const Fields fields(table.L, 1, kFileKeys, "", "", 1);
  Cloud shape;
  shape.file = fields.Positional<std::string>(1, "file");
  shape.scale = fields.Optional<double>("scale", 1.0);
  return MakeShape(table.L, std::move(shape));
}

ShapePtr ReadShape(lua_State* L, const Fields& fields) {
  fields.Push("shape");
  ShapePtr shape = FindObject<const LuaShape>(L, -1);
  if (!shape) {
    fields.Refuse("shape", "a shape (box, cylinder, capsule, sphere, mesh, cloud or union)");
  }
  lua_pop(L, 1);
  return shape;
}

// union{ box{..}, {shape = sphere{..}, p = {..}}, .. }
ShapePtr MakeUnion(OneTable table) {
  lua_State* L = table.L;
  const int count = CheckList(L, 1, "", "a list of shapes");
  Union whole;
  int parts = 0, depth = 0;
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(L, 1, i);
    const std::string path = fmt::format("union[{}].", i);
    PlacedShape placed;
    ShapePtr shape = FindObject<const LuaShape>(L, -1);
    if (!shape) {
      const Fields fields(L, lua_gettop(L), kPlacedKeys, path);
      shape = ReadShape(L, fields);
      placed.X_BP = ReadPose(fields);
    }
    lua_pop(L, 1);
    parts += shape->parts;
    depth = std::max(depth, shape->depth + 1);
    if (parts > kMaxParts || depth > kMaxDepth) {
      throw InputError("", "", fmt::format("at most {} parts and {} levels", kMaxParts, kMaxDepth),
                       fmt::format("{} and {}", parts, depth));
    }
    placed.shape = shape->shape;
    whole.parts.push_back(std::move(placed));
  }
  return MakeShape(L, std::move(whole), std::max(parts, 1), std::max(depth, 1));
}

// {Ixx, Iyy, Izz} or {Ixx, Iyy, Izz, Ixy, Ixz, Iyz} about the centre of mass, in the body's axes.
Matrix3 ReadInertia(const Fields& fields) {
  const auto values = fields.Required<std::vector<double>>("inertia");
  if (values.size() != 3 && values.size() != 6) {
    throw InputError(fields.where(), fields.Path("inertia"),
                     "{Ixx, Iyy, Izz} or {Ixx, Iyy, Izz, Ixy, Ixz, Iyz} in kg m^2",
                     fmt::format("{} numbers", values.size()));
  }
  Matrix3 I = Vector3(values[0], values[1], values[2]).asDiagonal();
  if (values.size() == 6) {
    I(0, 1) = I(1, 0) = values[3];
    I(0, 2) = I(2, 0) = values[4];
    I(1, 2) = I(2, 1) = values[5];
  }
  return I;
}

// The body table on top of the stack; pops it.
Body ReadBody(lua_State* L, const std::string& path, const std::string& scene_where,
              const std::string& default_name) {
  // The line of a body is that of its shape's constructor: tables do not know theirs.
  std::string where = scene_where;
  if (lua_istable(L, -1)) {
    lua_pushliteral(L, "shape");
    lua_rawget(L, -2);
    if (const ShapePtr shape = FindObject<const LuaShape>(L, -1)) where = shape->where;
    lua_pop(L, 1);
  }
  if (lua_isnil(L, -1)) throw InputError(where, path, "a body {shape = .., ..}", "nothing");
  const Fields fields(L, lua_gettop(L), kBodyKeys, path + ".", where);
  Body body;
  body.where = where;
  body.shape = ReadShape(L, fields)->shape;
  body.name = fields.Optional<std::string>("name", default_name);
  body.X_WB = ReadPose(fields);
  body.friction = fields.Optional<double>("friction", body.friction);
  if (const auto mass = fields.Find<double>("mass")) {
    body.mass_properties.emplace();
    body.mass_properties->mass = *mass;
    if (const auto com = fields.Find<Vector3>("com")) {
      body.mass_properties->p_BoBcm = *com;
      body.com_given = true;
    }
    if (fields.Has("inertia")) body.mass_properties->I_BBcm = ReadInertia(fields);
  } else {
    for (const char* key : {"com", "inertia"}) {
      if (fields.Has(key))
        throw InputError(where, path + ".mass", "a mass beside " + std::string(key), "nothing");
    }
  }
  lua_pop(L, 1);
  return body;
}

FingertipConfig ReadFingertips(lua_State* L, const Fields& scene) {
  scene.Push("fingertips");
  const Fields fields(L, lua_gettop(L), kFingertipKeys, "fingertips.", scene.where());
  FingertipConfig config;
  config.friction = fields.Optional<double>("friction", config.friction);
  config.max_force = fields.Optional<double>("max_force", config.max_force);
  config.stiffness = fields.Optional<double>("stiffness", config.stiffness);
  config.damping = fields.Optional<double>("damping", config.damping);
  config.grasp_stiffness = fields.Optional<double>("grasp_stiffness", config.grasp_stiffness);
  lua_pop(L, 1);
  return config;
}

Scene ReadSceneTable(lua_State* L, int index) {
  const std::string where = WhereInLua(L);
  if (!lua_istable(L, index)) {
    throw InputError(where, "", "a table {name = .., object = .., environment = ..}",
                     DescribeValue(L, index));
  }
  const Fields fields(L, index, kSceneKeys, "", where);
  Scene scene;
  scene.where = where;
  scene.name = fields.Required<std::string>("name");
  fields.Push("object");
  scene.bodies.push_back(ReadBody(L, "object", where, "object"));
  fields.Push("environment");
  const int count = CheckList(L, lua_gettop(L), "environment", "a list of bodies");
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(L, -1, i);
    scene.bodies.push_back(
        ReadBody(L, fmt::format("environment[{}]", i), where, fmt::format("body{}", i)));
  }
  lua_pop(L, 1);
  if (fields.Has("fingertips")) scene.fingertips = ReadFingertips(L, fields);
  scene.hand = fields.Optional<std::string>("hand", scene.hand);
  scene.gravity = fields.Optional<Vector3>("gravity", scene.gravity);
  if (fields.Has("camera")) scene.camera = ReadCamera(L, fields, "camera");
  return scene;
}

std::shared_ptr<const Scene> MakeScene(OneTable table) {
  lua_State* L = table.L;
  if (lua_rawgetp(L, LUA_REGISTRYINDEX, &kOneSceneOnly) == LUA_TNUMBER) {
    if (lua_tointeger(L, -1) == 0) {
      throw InputError("", "", "one scene in a file", "a second one");
    }
    lua_pushinteger(L, 0);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &kOneSceneOnly);
  }
  lua_pop(L, 1);
  return std::make_shared<const Scene>(ReadSceneTable(L, 1));
}

}  // namespace

RigidTransform ReadPose(const Fields& fields) {
  const Vector3 p = fields.Optional<Vector3>("p", Vector3::Zero());
  const Vector3 rpy_deg = fields.Optional<Vector3>("rpy_deg", Vector3::Zero());
  for (const double angle : rpy_deg) {
    RequireWithin(fields.where(), fields.Path("rpy_deg"), kAngleRange, angle);
  }
  return MakeTransform(RotationFromRpy(rpy_deg * (kPi / 180.0)), p);
}

CameraConfig ReadCamera(lua_State* L, const Fields& owner, const std::string& key) {
  owner.Push(key);
  const Fields fields(L, lua_gettop(L), kCameraKeys, owner.Path(key) + ".", owner.where());
  CameraConfig camera;
  camera.p_WCam = fields.Required<Vector3>("p");
  camera.p_WTarget = fields.Required<Vector3>("look_at");
  camera.fov_deg = fields.Optional<double>("fov_deg", camera.fov_deg);
  lua_pop(L, 1);
  return camera;
}

const std::vector<FunctionInfo>& SceneConstructors() {
  static const std::vector<FunctionInfo> constructors = {
      Function<&MakeScene>("scene", "table"),      Function<&MakeBox>("box", "size"),
      Function<&MakeCylinder>("cylinder", "size"), Function<&MakeCapsule>("capsule", "size"),
      Function<&MakeSphere>("sphere", "size"),     Function<&MakeMesh>("mesh", "file"),
      Function<&MakeCloud>("cloud", "file"),       Function<&MakeUnion>("union", "parts"),
  };
  return constructors;
}

std::vector<const Schema*> SceneSchemas() {
  return {&kSceneKeys, &kBodyKeys,  &kFingertipKeys, &kCameraKeys, &kPlacedKeys,
          &kBoxKeys,   &kRoundKeys, &kSphereKeys,    &kFileKeys,   &kMeshFileKeys};
}

std::vector<const ClassInfo*> SceneClasses() { return {&kShapeClass, &kSceneClass}; }

bool IsScene(lua_State* L, int index) { return FindObject<const Scene>(L, index) != nullptr; }

Scene ReadScene(lua_State* L, int index) {
  if (const auto scene = FindObject<const Scene>(L, index)) return *scene;
  return ReadSceneTable(L, index);
}

void AllowOneScene(lua_State* L) {
  lua_pushinteger(L, 1);
  lua_rawsetp(L, LUA_REGISTRYINDEX, &kOneSceneOnly);
}

}  // namespace pregrasp
