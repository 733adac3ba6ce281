#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <nlopt.hpp>
#include <utility>
#include <vector>

#include "app/hand/ik_terms.h"

namespace pregrasp::internal {
namespace {

// Constraints in units that make one of them a centimetre, so that all have the size of the scaled
// variables.
constexpr double kLengthUnit = 0.01;  // [m]
constexpr double kConeSlack = 1e-3;   // of the cosine
// Of the buffer that least squares asks for: an exact solution may not leave room for more.
constexpr double kClearanceShare = 0.1;
// One inequality per capsule (its least distance to anything), one for touches, one per cone:
// grouping by minima keeps SLSQP's quadratic programs small.
constexpr int kMaxInequalities = kMaxHandCapsules + 1 + kNumFingers;

// d(left rotation)/d(theta) of exp(theta x): the left Jacobian of SO(3).
Matrix3 CalcLeftJacobian(const Vector3& theta) {
  const double angle = theta.norm();
  Matrix3 K;
  K << 0.0, -theta.z(), theta.y(), theta.z(), 0.0, -theta.x(), -theta.y(), theta.x(), 0.0;
  if (angle < 1e-6) return Matrix3::Identity() + 0.5 * K;
  const double a2 = angle * angle;
  return Matrix3::Identity() + (1.0 - std::cos(angle)) / a2 * K +
         (angle - std::sin(angle)) / (a2 * angle) * K * K;
}

// The problem as NLopt sees it: x is the scaled step from the start. NLopt asks for objective and
// constraints one after the other at the same x, so the point is kept.
class Program {
 public:
  Program(const IkTerms& terms, const IkPoint& start, IkPoint* point)
      : terms_(terms),
        units_(HandUnits()),
        start_(start.configuration),
        point_(point),
        least_cost_(start.task_cost),
        best_(start.configuration) {}

  int num_equalities() const { return 3 * terms_.num_contacts; }
  int num_inequalities() const {
    return static_cast<int>(terms_.hand.capsules.size()) + 1 + terms_.num_contacts;
  }
  int evaluations() const { return evaluations_; }
  const HandConfiguration& best() const { return best_; }

  void MoveTo(const double* x) {
    const Eigen::Map<const HandVector> x_new(x, kMaxHandDofs);
    if (evaluations_ > 0 && x_new == x_) return;
    x_ = x_new;
    const HandVector step = x_.cwiseProduct(units_);
    rotation_ = CalcLeftJacobian(step.segment<3>(3));
    point_->configuration = Advance(start_, step);
    EvaluatePoint(terms_, terms_.config.influence, point_);
    ++evaluations_;
    if (point_->task_cost < least_cost_) {
      least_cost_ = point_->task_cost;
      best_ = point_->configuration;
    }
    if (IsSolution(terms_, *point_, terms_.config.tip_target)) {
      best_ = point_->configuration;
      throw nlopt::forced_stop();
    }
  }

  double CalcObjective(double* gradient) const {
    if (gradient != nullptr) Eigen::Map<HandVector>(gradient, kMaxHandDofs) = x_;
    return 0.5 * x_.squaredNorm();
  }

  void CalcEqualities(double* values, double* gradients) const {
    for (int i = 0; i < terms_.num_contacts; ++i) {
      const IkTerms::Contact& contact = terms_.contacts[i];
      const Vector3 p_WT = point_->pose.CalcPoint(contact.link, contact.p_LT);
      for (int k = 0; k < 3; ++k) {
        values[3 * i + k] = (p_WT[k] - contact.p_WTarget[k]) / kLengthUnit;
        if (gradients == nullptr) continue;
        HandVector row = HandVector::Zero();
        AddPointGradient(terms_.hand, point_->pose, contact.link, p_WT,
                         Vector3::Unit(k) / kLengthUnit, &row);
        Store(row, gradients + (3 * i + k) * kMaxHandDofs);
      }
    }
  }

  // At most 0 when satisfied.
  void CalcInequalities(double* values, double* gradients) const {
    const int num_capsules = static_cast<int>(terms_.hand.capsules.size());
    std::array<const HandDistance*, kMaxInequalities> least{};
    for (const HandDistance& near : point_->near) {
      const HandDistance*& group = least[near.touch ? num_capsules : near.capsule];
      if (group == nullptr || near.distance < group->distance) group = &near;
    }
    for (int i = 0; i <= num_capsules; ++i) {
      HandVector row = HandVector::Zero();
      values[i] = -terms_.config.influence / kLengthUnit;  // nothing near
      if (least[i] != nullptr) {
        const double required = least[i]->touch ? -terms_.touch.depth : terms_.config.min_clearance;
        values[i] =
            (required + kClearanceShare * terms_.config.clearance_buffer - least[i]->distance) /
            kLengthUnit;
        AddDistanceGradient(terms_.hand, point_->pose, *least[i], -1.0 / kLengthUnit, &row);
      }
      if (gradients != nullptr) Store(row, gradients + i * kMaxHandDofs);
    }
    for (int i = 0; i < terms_.num_contacts; ++i) {
      const IkTerms::Contact& contact = terms_.contacts[i];
      const int at = num_capsules + 1 + i;
      values[at] = terms_.least_cosine + kConeSlack - point_->cosines[i];
      if (gradients == nullptr) continue;
      HandVector row = HandVector::Zero();
      AddDirectionGradient(terms_.hand, point_->pose, contact.link,
                           point_->pose.R_WL[contact.link].col(2), contact.nhat_W, &row);
      Store(row, gradients + at * kMaxHandDofs);
    }
  }

 private:
  // From the left rotation at the point, in SI units, to x.
  void Store(HandVector row, double* out) const {
    row.segment<3>(3) = (rotation_.transpose() * row.segment<3>(3)).eval();
    Eigen::Map<HandVector>(out, kMaxHandDofs) = row.cwiseProduct(units_);
  }

  const IkTerms& terms_;
  const HandVector units_;
  const HandConfiguration start_;
  IkPoint* point_;
  double least_cost_;
  HandConfiguration best_;
  HandVector x_ = HandVector::Zero();
  Matrix3 rotation_ = Matrix3::Identity();
  int evaluations_ = 0;
};

double Objective(unsigned /*n*/, const double* x, double* gradient, void* data) {
  auto* program = static_cast<Program*>(data);
  program->MoveTo(x);
  return program->CalcObjective(gradient);
}

void Equalities(unsigned /*m*/, double* values, unsigned /*n*/, const double* x, double* gradients,
                void* data) {
  auto* program = static_cast<Program*>(data);
  program->MoveTo(x);
  program->CalcEqualities(values, gradients);
}

void Inequalities(unsigned /*m*/, double* values, unsigned /*n*/, const double* x,
                  double* gradients, void* data) {
  auto* program = static_cast<Program*>(data);
  program->MoveTo(x);
  program->CalcInequalities(values, gradients);
}

}  // namespace

int SolveSlsqp(const IkTerms& terms, IkPoint* point, IkPoint* scratch, bool* improved) {
  *improved = false;
  Program program(terms, *point, scratch);
  const HandVector units = HandUnits();
  const HandJoints& q = point->configuration.q;
  std::vector<double> x(kMaxHandDofs, 0.0);
  // Wrist steps beyond these bounds would be another solution, which a fresh start finds better.
  std::vector<double> lower(kMaxHandDofs, -2.0);
  std::vector<double> upper(kMaxHandDofs, 2.0);
  for (int j = 0; j < kMaxHandJoints; ++j) {
    lower[6 + j] = std::min(0.0, (terms.hand.q_lower[j] - q[j]) / units[6 + j]);
    upper[6 + j] = std::max(0.0, (terms.hand.q_upper[j] - q[j]) / units[6 + j]);
  }
  nlopt::opt optimizer(nlopt::LD_SLSQP, kMaxHandDofs);
  optimizer.set_lower_bounds(lower);
  optimizer.set_upper_bounds(upper);
  optimizer.set_min_objective(Objective, &program);
  if (program.num_equalities() > 0) {
    optimizer.add_equality_mconstraint(Equalities, &program,
                                       std::vector<double>(program.num_equalities(), 1e-3));
  }
  optimizer.add_inequality_mconstraint(Inequalities, &program,
                                       std::vector<double>(program.num_inequalities(), 1e-4));
  optimizer.set_maxeval(terms.config.slsqp_evaluations);
  optimizer.set_xtol_abs(1e-7);
  double cost = 0.0;
  try {
    optimizer.optimize(x, cost);
  } catch (const nlopt::forced_stop&) {
    // a solution
  } catch (const nlopt::roundoff_limited&) {
    // as far as it gets
  } catch (const std::runtime_error&) {
    // inconsistent linearised constraints: the best point seen stands
  }
  if (program.evaluations() == 0) return 0;
  scratch->configuration = program.best();
  scratch->configuration.q =
      scratch->configuration.q.cwiseMax(terms.hand.q_lower).cwiseMin(terms.hand.q_upper);
  EvaluatePoint(terms, terms.config.influence, scratch);
  if (IsSolution(terms, *scratch, terms.config.tip_target) ||
      scratch->task_cost < point->task_cost) {
    std::swap(*point, *scratch);
    *improved = true;
  }
  return program.evaluations();
}

}  // namespace pregrasp::internal
