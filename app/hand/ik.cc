#include "app/hand/ik.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/text.h"
#include "app/hand/certificate.h"
#include "app/hand/ik_residuals.h"
#include "app/hand/ik_terms.h"

namespace pregrasp {
namespace {

using internal::IkPoint;
using internal::IkTerms;

// SLSQP is worth its time where least squares ends this near to a solution: the square root of its
// residual sum, in millimetres. Farther away a fresh start is cheaper.
constexpr double kStallReach = 3.0;

void Require(bool condition, const char* field, const char* expected, double got) {
  if (!condition) throw InputError("ik", field, expected, FormatDouble(got));
}

// Of the point as it stands: everything in a result but the search's counts.
IkResult Describe(const IkTerms& terms, const IkPoint& point) {
  IkResult result;
  result.X_WH = point.configuration.X_WH;
  result.q = point.configuration.q;
  for (int i = 0; i < terms.num_contacts; ++i) {
    const int f = static_cast<int>(terms.contacts[i].finger);
    result.tip_errors[f] = point.tip_errors[i];
    result.cone_angles[f] = std::acos(std::clamp(point.cosines[i], -1.0, 1.0));
    result.cone_angle = std::max(result.cone_angle, result.cone_angles[f]);
  }
  result.tip_error = point.max_tip_error;
  result.clearance = point.clearance;
  result.contact_overlap = point.contact_overlap;
  for (const HandDistance& near : point.near) {
    std::optional<HandDistance>& least = near.touch ? result.deepest_contact : result.closest;
    if (!least || near.distance < least->distance) least = near;
  }
  return result;
}

// How a search went, and its best point.
struct Search {
  bool solved = false;
  IkPoint best;
  IkMethod method = IkMethod::kNone;
  int starts = 0, iterations = 0, evaluations = 0, denied = 0;
};

class Searcher {
 public:
  Searcher(const IkTerms& terms, const IkProblem& problem, const HandCertificate* certificate)
      : terms_(terms), problem_(problem), certificate_(certificate) {}

  Search Run(Rng& rng) {
    Search search;
    while (search.starts < terms_.config.max_starts && !search.solved) {
      ThrowIfInterrupted();
      point_.configuration = NextStart(search.starts++, rng);
      Attempt(&search);
    }
    return search;
  }

 private:
  HandConfiguration NextStart(int index, Rng& rng) {
    if (problem_.warm_start && index < terms_.config.warm_starts) {
      if (index == 0) return *problem_.warm_start;
      return internal::SampleNear(terms_.hand, *problem_.warm_start, rng);
    }
    return internal::SampleStart(terms_, rng, &scratch_);
  }

  void Attempt(Search* search) {
    const IkConfig& config = terms_.config;
    search->iterations += internal::SolveLeastSquares(terms_, &point_, &scratch_);
    IkMethod method = IkMethod::kLeastSquares;
    const bool exact = internal::IsSolution(terms_, point_, config.tip_target);
    if (!exact && config.slsqp && point_.task_cost < kStallReach * kStallReach) {
      bool improved = false;
      search->evaluations += internal::SolveSlsqp(terms_, &point_, &scratch_, &improved);
      if (improved) method = IkMethod::kSlsqp;
    }
    bool solved = internal::IsSolution(terms_, point_, config.tip_tolerance);
    if (solved && certificate_ != nullptr &&
        !certificate_->FindCollisions(point_.configuration, problem_.X_WB, terms_.touch, true)
             .empty()) {
      ++search->denied;
      solved = false;
    }
    if (solved || search->method == IkMethod::kNone || point_.task_cost < search->best.task_cost) {
      search->best = point_;
      search->method = method;
      search->solved = solved;
    }
  }

  const IkTerms& terms_;
  const IkProblem& problem_;
  const HandCertificate* certificate_;
  IkPoint point_, scratch_;
};

// Which demand fails first: the search again without bodies, then without cones.
IkStatus FindReason(const HandModel& hand, const IkConfig& config, const IkProblem& problem,
                    Rng& rng) {
  IkConfig plain = config;
  plain.collision = false;
  plain.max_starts = std::min(config.max_starts, config.reason_starts);
  const auto solves = [&] {
    const IkTerms terms(hand, nullptr, plain, problem);
    return Searcher(terms, problem, nullptr).Run(rng).solved;
  };
  if (config.collision && solves()) return IkStatus::kCollision;
  plain.max_cone_deg = 180.0;
  return solves() ? IkStatus::kCone : IkStatus::kTipError;
}

// The first demand that a configuration within its joint limits misses, without a certificate.
IkStatus FindMiss(const IkTerms& terms, const IkPoint& point) {
  if (internal::IsSolution(terms, point, terms.config.tip_tolerance)) return IkStatus::kSolved;
  if (!(point.max_tip_error <= terms.config.tip_tolerance)) return IkStatus::kTipError;
  return point.min_cosine >= terms.least_cosine ? IkStatus::kCollision : IkStatus::kCone;
}

std::vector<const Shape*> ShapesOf(const Scene& scene) {
  std::vector<const Shape*> shapes;
  for (const Body& body : scene.bodies) shapes.push_back(&body.shape);
  return shapes;
}

}  // namespace

void IkConfig::Validate() const {
  Require(tip_target > 0.0 && tip_target <= tip_tolerance, "tip_target",
          "a length above 0, at most tip_tolerance", tip_target);
  Require(tip_tolerance <= 0.05, "tip_tolerance", "a length of at most 0.05 m", tip_tolerance);
  Require(max_cone_deg > 0.0 && max_cone_deg <= 180.0, "max_cone_deg", "an angle from 0 to 180",
          max_cone_deg);
  Require(contact_depth >= 0.0 && contact_depth <= 0.01, "contact_depth",
          "a length from 0 to 0.01 m", contact_depth);
  Require(std::abs(min_clearance) <= 0.02, "min_clearance", "a length within 0.02 m",
          min_clearance);
  Require(clearance_buffer >= 0.0, "clearance_buffer", "a length of at least 0", clearance_buffer);
  Require(influence > std::max(0.0, min_clearance + clearance_buffer), "influence",
          "a length above min_clearance + clearance_buffer", influence);
  Require(max_starts >= 1, "max_starts", "at least 1", max_starts);
  Require(start_candidates >= 1, "start_candidates", "at least 1", start_candidates);
  Require(max_iterations >= 1, "max_iterations", "at least 1", max_iterations);
  Require(slsqp_evaluations >= 1, "slsqp_evaluations", "at least 1", slsqp_evaluations);
  Require(reason_starts >= 0, "reason_starts", "no negative count", reason_starts);
  Require(warm_starts >= 1, "warm_starts", "at least 1", warm_starts);
}

const char* IkStatusName(IkStatus status) {
  constexpr const char* kNames[] = {"solved",    "tip_error",     "cone",
                                    "collision", "not_certified", "joint_limits"};
  return kNames[static_cast<int>(status)];
}

const char* IkMethodName(IkMethod method) {
  constexpr const char* kNames[] = {"none", "least_squares", "slsqp"};
  return kNames[static_cast<int>(method)];
}

struct IkSolver::Impl {
  Impl(const HandModel& hand_in, const std::vector<const Shape*>& shapes)
      : hand(hand_in), reach(hand_in), obstacles(shapes), certificate(hand_in, shapes) {}

  const HandObstacles* bodies() const { return obstacles.num_bodies() > 0 ? &obstacles : nullptr; }

  HandModel hand;
  HandReach reach;
  HandObstacles obstacles;
  HandCertificate certificate;
};

IkSolver::IkSolver(const HandModel& hand) : IkSolver(hand, std::vector<const Shape*>{}) {}
IkSolver::IkSolver(const HandModel& hand, const Scene& scene) : IkSolver(hand, ShapesOf(scene)) {}
IkSolver::IkSolver(const HandModel& hand, const std::vector<const Shape*>& shapes)
    : impl_(std::make_unique<Impl>(hand, shapes)) {}
IkSolver::~IkSolver() = default;
IkSolver::IkSolver(IkSolver&&) noexcept = default;

const HandModel& IkSolver::hand() const { return impl_->hand; }

WayResult IkSolver::CheckWay(const HandWay& way) const {
  return pregrasp::CheckWay(impl_->hand, impl_->reach, impl_->bodies(), way);
}

IkResult IkSolver::Solve(const IkConfig& config, const IkProblem& problem, Rng rng) const {
  config.Validate();
  const IkTerms terms(impl_->hand, config.collision ? impl_->bodies() : nullptr, config, problem);
  const bool certify = config.collision && config.certify;
  Search search = Searcher(terms, problem, certify ? &impl_->certificate : nullptr).Run(rng);
  internal::EvaluatePoint(terms, kClearanceSeen, &search.best);
  IkResult result = Describe(terms, search.best);
  if (search.solved) {
    result.status = IkStatus::kSolved;
  } else if (search.denied > 0) {
    result.status = IkStatus::kNotCertified;
  } else {
    result.status = config.reason_starts > 0 ? FindReason(impl_->hand, config, problem, rng)
                                             : FindMiss(terms, search.best);
  }
  result.method = search.method;
  result.starts = search.starts;
  result.iterations = search.iterations;
  result.evaluations = search.evaluations;
  result.denied = search.denied;
  return result;
}

IkResult IkSolver::Evaluate(const IkConfig& config, const IkProblem& problem,
                            const HandConfiguration& configuration) const {
  config.Validate();
  const IkTerms terms(impl_->hand, config.collision ? impl_->bodies() : nullptr, config, problem);
  IkPoint point;
  point.configuration = configuration;
  internal::EvaluatePoint(terms, kClearanceSeen, &point);
  IkResult result = Describe(terms, point);
  if ((configuration.q.array() < terms.hand.q_lower.array()).any() ||
      (configuration.q.array() > terms.hand.q_upper.array()).any()) {
    result.status = IkStatus::kJointLimits;
  } else {
    result.status = FindMiss(terms, point);
    const bool denied =
        result.solved() && config.collision && config.certify &&
        !impl_->certificate.FindCollisions(configuration, problem.X_WB, terms.touch, true).empty();
    if (denied) result.status = IkStatus::kNotCertified;
  }
  return result;
}

struct IkResiduals::Impl {
  Impl(const HandModel& hand, const HandObstacles* obstacles, const IkConfig& config_in,
       const IkProblem& problem, double contact_weight)
      : config(config_in), terms(hand, obstacles, config, problem) {
    terms.contact_weight = contact_weight;
  }

  IkConfig config;  // that `terms` refers to
  IkTerms terms;
  IkPoint point;
};

IkResiduals::IkResiduals(const IkSolver& solver, const IkConfig& config, const IkProblem& problem,
                         double contact_weight)
    : impl_(std::make_unique<Impl>(solver.impl_->hand,
                                   config.collision ? solver.impl_->bodies() : nullptr, config,
                                   problem, contact_weight)) {}
IkResiduals::~IkResiduals() = default;
IkResiduals::IkResiduals(IkResiduals&&) noexcept = default;

double IkResiduals::Evaluate(const HandConfiguration& configuration) {
  impl_->point.configuration = configuration;
  internal::EvaluatePoint(impl_->terms, internal::LeastSquaresInfluence(impl_->terms),
                          &impl_->point);
  return impl_->point.cost;
}

void IkResiduals::AddNormalEquations(HandMatrix* JtJ, HandVector* Jtr) const {
  HandMatrix A;
  HandVector b;
  internal::CalcNormalEquations(impl_->terms, impl_->point, &A, &b);
  *JtJ += A;
  *Jtr += b;
}

}  // namespace pregrasp
