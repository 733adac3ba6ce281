#include "tests/grasp/qhull_margin.h"

#include <libqhull_r/qhull_ra.h>

#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "app/core/check.h"

namespace pregrasp {

MatrixX6 CalcEdgeWrenches(std::span<const WrenchContact> contacts, double mu, double torque_scale) {
  MatrixX6 wrenches(16 * static_cast<int>(contacts.size()), 6);
  int row = 0;
  for (const WrenchContact& contact : contacts) {
    const Matrix3 R = FrameFromNormal(contact.n.normalized());
    for (int k = 0; k < 16; ++k, ++row) {
      const Vector3 f = R * Vector3(mu * std::cos(kPi * k / 8), mu * std::sin(kPi * k / 8), 1.0);
      wrenches.row(row) << f.transpose(), contact.p.cross(f).transpose() / torque_scale;
    }
  }
  return wrenches;
}

double CalcNearestFacetByQhull(const MatrixX6& points) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> sink(std::fopen("/dev/null", "w"),
                                                             std::fclose);
  qhT qhull;
  qhT* qh = &qhull;
  qh_zero(qh, sink.get());
  std::vector<double> coordinates(points.data(), points.data() + points.size());
  std::string command = "qhull QJ";
  const int failure = qh_new_qhull(qh, 6, static_cast<int>(points.rows()), coordinates.data(),
                                   False, command.data(), nullptr, sink.get());
  PREGRASP_CHECK(failure == 0, failure);
  double nearest = std::numeric_limits<double>::infinity();
  const facetT* facet = nullptr;
  FORALLfacets { nearest = std::min(nearest, -facet->offset); }
  qh_freeqhull(qh, qh_ALL);
  return nearest;
}

}  // namespace pregrasp
