#include "app/geometry/contact_mesh.h"
#include "app/geometry/point_cloud.h"
#include "app/geometry/signed_distance.h"
#include "app/job/planner_settings.h"
#include "bindings/lua_session.h"

namespace pregrasp {
namespace {

const Schema kCloud{"Cloud", {"count", "points", "normals"}};
const Schema kDistance{"Distance", {"phi", "nhat"}};
const Schema kMesh{"Mesh", {"num_vertices", "num_triangles", "vertices", "triangles"}};

constexpr int kMaxPoints = 4096;  // farthest-point sampling grows with the square

}  // namespace

Pushed PushCloud(lua_State* L, Session& session, int points) {
  RequireWithin("", "points", {1, kMaxPoints, 1}, points);
  const PointCloud cloud = SamplePointCloud(session.scene().object().shape, points,
                                            Rng(session.config().seed, RngStream::kObjectCloud));
  RecordWriter(L, kCloud)
      .Set("count", static_cast<int>(cloud.P.rows()))
      .Set("points", cloud.P)
      .Set("normals", cloud.N);
  return {1};
}

Pushed PushDistance(lua_State* L, Session& session, const Vector3& p_W) {
  const DistanceSample sample = session.job().environment().Calc(p_W);
  RecordWriter(L, kDistance).Set("phi", sample.phi).Set("nhat", sample.nhat);
  return {1};
}

Pushed PushContactMesh(lua_State* L, Session& session, int triangles) {
  RequireWithin("", "triangles", FindPlannerSetting("mesh.triangles").range, triangles);
  ContactMeshConfig config;
  config.triangles = triangles;
  PushMesh(L, BuildContactMesh(session.scene().object().shape, config));
  return {1};
}

void PushMesh(lua_State* L, const TriangleMesh& mesh) {
  RecordWriter record(L, kMesh);
  record.Set("num_vertices", static_cast<int>(mesh.V.rows()))
      .Set("num_triangles", static_cast<int>(mesh.F.rows()))
      .Set("vertices", mesh.V);
  LuaMatrix<3, int>::Push(L, mesh.F, 1);  // Lua counts from 1
  record.SetTop("triangles");
}

std::vector<const Schema*> GeometrySchemas() { return {&kCloud, &kDistance, &kMesh}; }

}  // namespace pregrasp
