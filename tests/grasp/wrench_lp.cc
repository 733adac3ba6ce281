#include "tests/grasp/wrench_lp.h"

#include <glpk.h>

#include <cmath>

#include "app/core/check.h"

namespace pregrasp {

double CalcImbalanceByLp(std::span<const WrenchContact> contacts, const WrenchConfig& config,
                         bool with_weight, int facets, Pyramid pyramid) {
  glp_prob* lp = glp_create_prob();
  glp_set_obj_dir(lp, GLP_MIN);
  const int count = static_cast<int>(contacts.size());
  // Rows 1..6: net wrench = 0 with slacks of both signs. Rows 7..: each contact's normal force.
  glp_add_rows(lp, 6 + count);
  const Vector3 weight = with_weight ? Vector3(config.mass * config.gravity) : Vector3::Zero();
  for (int i = 0; i < 6; ++i) {
    const double balance = i < 3 ? -weight[i] : 0.0;
    glp_set_row_bnds(lp, i + 1, GLP_FX, balance, balance);
  }
  for (int i = 0; i < count; ++i) {
    glp_set_row_bnds(lp, 7 + i, config.f_min < config.f_max ? GLP_DB : GLP_FX, config.f_min,
                     config.f_max);
  }
  const double mu = pyramid == Pyramid::kInscribed ? config.mu : config.mu / std::cos(kPi / facets);
  for (int i = 0; i < count; ++i) {
    const Vector3 n = contacts[i].n / contacts[i].n.norm();
    Vector3 x = std::abs(n.x()) < 0.6 ? Vector3::UnitX() : Vector3::UnitY();
    x = (x - x.dot(n) * n).normalized();
    const Vector3 y = n.cross(x);
    for (int k = 0; k < facets; ++k) {
      const double angle = 2.0 * kPi * (k + 0.5) / facets;
      const Vector3 f = n + mu * std::cos(angle) * x + mu * std::sin(angle) * y;
      const Vector3 torque = contacts[i].p.cross(f) / config.torque_scale;
      const int column = glp_add_cols(lp, 1);
      glp_set_col_bnds(lp, column, GLP_LO, 0.0, 0.0);
      const int rows[] = {0, 1, 2, 3, 4, 5, 6, 7 + i};
      const double values[] = {0, f[0], f[1], f[2], torque[0], torque[1], torque[2], 1.0};
      glp_set_mat_col(lp, column, 7, rows, values);
    }
  }
  for (int i = 0; i < 6; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      const int column = glp_add_cols(lp, 1);
      glp_set_col_bnds(lp, column, GLP_LO, 0.0, 0.0);
      glp_set_obj_coef(lp, column, 1.0);
      const int rows[] = {0, i + 1};
      const double values[] = {0, sign};
      glp_set_mat_col(lp, column, 1, rows, values);
    }
  }
  glp_smcp parameters;
  glp_init_smcp(&parameters);
  parameters.msg_lev = GLP_MSG_OFF;
  parameters.tol_bnd = parameters.tol_dj = 1e-9;
  const int failure = glp_simplex(lp, &parameters);
  const int status = glp_get_status(lp);
  const double imbalance = glp_get_obj_val(lp);
  glp_delete_prob(lp);
  PREGRASP_CHECK(failure == 0 && status == GLP_OPT, failure, status);
  return imbalance;
}

}  // namespace pregrasp
