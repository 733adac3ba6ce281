#include <algorithm>
#include <map>
#include <utility>

#include "app/geometry/contact_mesh.h"
#include "app/geometry/point_cloud.h"
#include "app/geometry/signed_distance.h"
#include "app/job/planner_settings.h"
#include "bindings/lua_array.h"
#include "bindings/lua_session.h"

namespace pregrasp {
namespace {

const Schema kCloud{"Cloud", {"count", "points", "normals"}};
const Schema kDistance{"Distance", {"phi", "nhat"}};
const Schema kMesh{"Mesh",
                   {"num_vertices", "num_triangles", "vertices", "triangles", "normals", "areas",
                    "centres", "neighbors"}};

constexpr int kMaxPoints = 4096;  // farthest-point sampling grows with the square

}  // namespace

Pushed PushCloud(lua_State* L, Session& session, int points) {
  RequireWithin("", "points", {1, kMaxPoints, 1}, points);
  const std::shared_ptr<const PointCloud> cloud =
      ShareArrayData(L,
                     SamplePointCloud(session.scene().object().shape, points,
                                      Rng(session.config().seed, RngStream::kObjectCloud)),
                     6 * sizeof(double) * static_cast<std::size_t>(points));
  RecordWriter(L, kCloud)
      .Set("count", static_cast<int>(cloud->P.rows()))
      .Set("points", MakeRowArray("Vector3", cloud, cloud->P))
      .Set("normals", MakeRowArray("Vector3", cloud, cloud->N));
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
  TriangleMesh mesh = BuildContactMesh(session.scene().object().shape, config);
  const auto bytes = static_cast<std::size_t>(mesh.V.size()) * sizeof(double) +
                     static_cast<std::size_t>(mesh.F.size()) * sizeof(int);
  PushMesh(L, ShareArrayData(L, std::move(mesh), bytes));
  return {1};
}

namespace {

// Of each triangle those that share an edge with it, from 1.
std::vector<std::vector<int>> FindNeighbors(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, std::vector<int>> triangles_of_edge;
  for (int t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.F(t, k), b = mesh.F(t, (k + 1) % 3);
      triangles_of_edge[std::minmax(a, b)].push_back(t);
    }
  }
  std::vector<std::vector<int>> neighbors(static_cast<std::size_t>(mesh.F.rows()));
  for (const auto& [edge, triangles] : triangles_of_edge) {
    for (const int t : triangles) {
      for (const int other : triangles) {
        if (other != t) neighbors[static_cast<std::size_t>(t)].push_back(other + 1);
      }
    }
  }
  for (std::vector<int>& list : neighbors) std::sort(list.begin(), list.end());
  return neighbors;
}

}  // namespace

TriangleShape CalcTriangleShape(const TriangleMesh& mesh, int triangle) {
  const auto corner = [&](int k) -> Vector3 { return mesh.V.row(mesh.F(triangle, k)).transpose(); };
  const Vector3 cross = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  const Vector3 centre = (corner(0) + corner(1) + corner(2)) / 3.0;
  return {centre, cross.normalized(), 0.5 * cross.norm()};
}

void PushMesh(lua_State* L, const std::shared_ptr<const TriangleMesh>& mesh) {
  const auto count = static_cast<int>(mesh->F.rows());
  const auto of_triangle = [&](const char* name, auto TriangleShape::*value) {
    return LuaArray{name, count, [mesh, value](lua_State* state, int triangle) {
                      const auto field = CalcTriangleShape(*mesh, triangle).*value;
                      LuaValue<std::decay_t<decltype(field)>>::Push(state, field);
                    }};
  };
  // All of them together, when one is first asked for.
  const auto neighbors = std::make_shared<std::vector<std::vector<int>>>();
  const auto push_neighbors = [mesh, neighbors](lua_State* state, int triangle) {
    if (neighbors->empty()) *neighbors = FindNeighbors(*mesh);
    LuaValue<std::vector<int>>::Push(state, (*neighbors)[static_cast<std::size_t>(triangle)]);
  };
  RecordWriter(L, kMesh)
      .Set("num_vertices", static_cast<int>(mesh->V.rows()))
      .Set("num_triangles", count)
      .Set("vertices", MakeRowArray("Vector3", mesh, mesh->V))
      .Set("triangles", MakeRowArray("integer[]", mesh, mesh->F, 1))  // Lua counts from 1
      .Set("normals", of_triangle("Vector3", &TriangleShape::nhat_O))
      .Set("areas", of_triangle("number", &TriangleShape::area))
      .Set("centres", of_triangle("Vector3", &TriangleShape::p_OCentre))
      .Set("neighbors", LuaArray{"integer[]", count, push_neighbors});
}

std::vector<const Schema*> GeometrySchemas() { return {&kCloud, &kDistance, &kMesh}; }

}  // namespace pregrasp
