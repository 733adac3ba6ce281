#include <algorithm>
#include <cmath>
#include <utility>

#include "app/hand/ik_terms.h"

namespace pregrasp::internal {
namespace {

// The largest step of one iteration: beyond it the linearisation of a finger means nothing.
constexpr double kMaxStepPosition = 0.06;  // [m]
constexpr double kMaxStepRotation = 0.5;   // [rad]
constexpr double kMaxStepJoint = 0.6;      // [rad]

constexpr double kFirstDamping = 1e-2;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e7;  // steps are below a nanometre from here on
constexpr double kProgress = 1e-3;    // relative decrease of the cost that counts as progress
constexpr int kPatience = 4;          // iterations without progress that are a stall

void LimitStep(HandVector* step) {
  const double excess = std::max(
      {step->head<3>().norm() / kMaxStepPosition, step->segment<3>(3).norm() / kMaxStepRotation,
       step->tail<kMaxHandJoints>().cwiseAbs().maxCoeff() / kMaxStepJoint});
  if (excess > 1.0) *step /= excess;
}

// The damped step, with joints held that stand at a limit and would leave it.
HandVector CalcStep(const IkTerms& terms, const IkPoint& point, const HandMatrix& JtJ,
                    const HandVector& Jtr, const HandVector& damping) {
  HandMatrix A = JtJ;
  A.diagonal() += damping;
  HandVector b = -Jtr;
  const HandJoints& q = point.configuration.q;
  for (int j = 0; j < kMaxHandJoints; ++j) {
    const double descent = -Jtr[6 + j];
    const bool held = (q[j] <= terms.hand.q_lower[j] && descent < 0.0) ||
                      (q[j] >= terms.hand.q_upper[j] && descent > 0.0);
    if (!held) continue;
    A.row(6 + j).setZero();
    A.col(6 + j).setZero();
    A(6 + j, 6 + j) = 1.0;
    b[6 + j] = 0.0;
  }
  const Eigen::LLT<Eigen::Ref<HandMatrix>> factor(A);  // in place
  return factor.solve(b);
}

}  // namespace

int SolveLeastSquares(const IkTerms& terms, IkPoint* point, IkPoint* scratch) {
  const HandVector scale = HandUnits().cwiseInverse().cwiseAbs2();
  const double influence = LeastSquaresInfluence(terms);
  point->configuration.q =
      point->configuration.q.cwiseMax(terms.hand.q_lower).cwiseMin(terms.hand.q_upper);
  EvaluatePoint(terms, influence, point);
  HandMatrix JtJ;
  HandVector Jtr;
  double damping = kFirstDamping;
  int idle = 0;
  bool moved = true;
  int iteration = 0;
  while (iteration < terms.config.max_iterations && idle < kPatience && damping < kMostDamping) {
    if (IsSolution(terms, *point, terms.config.tip_target)) break;
    if (moved) CalcNormalEquations(terms, *point, &JtJ, &Jtr);
    ++iteration;
    HandVector step = CalcStep(terms, *point, JtJ, Jtr, damping * scale);
    LimitStep(&step);
    scratch->configuration = Advance(point->configuration, step);
    scratch->configuration.q =
        scratch->configuration.q.cwiseMax(terms.hand.q_lower).cwiseMin(terms.hand.q_upper);
    EvaluatePoint(terms, influence, scratch);
    moved = scratch->cost < point->cost;
    if (moved) {
      idle = scratch->cost > (1.0 - kProgress) * point->cost ? idle + 1 : 0;
      std::swap(*point, *scratch);
      damping = std::max(kLeastDamping, 0.2 * damping);
    } else {
      damping *= 5.0;
    }
  }
  return iteration;
}

}  // namespace pregrasp::internal
