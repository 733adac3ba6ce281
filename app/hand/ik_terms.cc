#include "app/hand/ik_terms.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp::internal {
namespace {

constexpr double kConeMargin = 0.02;  // of the cosine, so that a solution is not on the boundary
constexpr double kPadMargin = 0.1;    // the contact lies at least this far to the palmar side

double Square(double x) { return x * x; }

double ConeResidual(const IkTerms& terms, double cosine) {
  return std::max(0.0, terms.least_cosine + kConeMargin - cosine) / kSigmaCone;
}

// How far a contact lies on a finger's nail side: the contact's direction from the tip is -n, the
// palmar side -y.
double PadResidual(double dorsal) { return std::max(0.0, dorsal + kPadMargin) / kSigmaPad; }

double Dorsal(const IkTerms::Contact& contact, const HandPose& pose) {
  return -contact.nhat_W.dot(pose.R_WL[contact.link].col(1));
}

double DistanceResidual(const IkTerms& terms, const HandDistance& near) {
  const double required = near.touch ? -terms.touch.depth : terms.config.min_clearance;
  return std::max(0.0, required + terms.config.clearance_buffer - near.distance) / kSigmaLength;
}

HandVector CalcDeviation(const IkTerms& terms, const HandConfiguration& configuration) {
  if (terms.has_reference) return CalcStep(terms.reference, configuration);
  HandVector deviation = HandVector::Zero();
  deviation.tail<kMaxHandJoints>() = configuration.q - terms.reference.q;
  return deviation;
}

void AddRow(const HandVector& gradient, double residual, HandMatrix* JtJ, HandVector* Jtr) {
  JtJ->selfadjointView<Eigen::Lower>().rankUpdate(gradient);
  *Jtr += residual * gradient;
}

}  // namespace

IkTerms::IkTerms(const HandModel& hand_in, const HandObstacles* obstacles_in,
                 const IkConfig& config_in, const IkProblem& problem)
    : hand(hand_in), obstacles(obstacles_in), config(config_in) {
  PREGRASP_CHECK(problem.contacts.size() <= kNumFingers, problem.contacts.size());
  if (obstacles != nullptr) placed = obstacles->Place(problem.X_WB);
  touch.depth = config.contact_depth;
  least_cosine = std::cos(DegToRad(config.max_cone_deg));
  for (const IkContact& contact : problem.contacts) {
    const int f = static_cast<int>(contact.finger);
    PREGRASP_CHECK(f < hand.num_fingers && !touch.touching[f], FingerName(contact.finger));
    touch.touching[f] = true;
    const Fingertip& tip = hand.tips[f];
    contacts[num_contacts++] = {contact.finger, tip.link, tip.p_LT,
                                contact.p_WC + tip.radius * contact.nhat_W, contact.nhat_W};
  }
  for (int f = 0; f < kNumFingers; ++f) touch.touching[f] |= problem.may_touch[f];
  has_reference = problem.reference.has_value();
  if (has_reference) {
    reference = *problem.reference;
    reference_weights = problem.reference_weight * HandUnits().cwiseInverse().cwiseAbs2();
    return;
  }
  reference.q = hand.posture;
  reference_weights.setZero();
  for (int f = 0; f < hand.num_fingers; ++f) {
    const double sigma = touch.touching[f] ? kSigmaPostureUsed : kSigmaPosture;
    reference_weights.segment(6 + hand.fingers[f].first, hand.fingers[f].count)
        .setConstant(1.0 / Square(sigma));
  }
}

double CalcContactCost(const IkTerms& terms, IkPoint* point) {
  const HandPose& pose = point->pose;
  CalcHandPose(terms.hand, point->configuration.X_WH, point->configuration.q, &point->pose);
  point->max_tip_error = 0.0;
  point->min_cosine = 1.0;
  double task = 0.0;
  double preference = 0.0;
  for (int i = 0; i < terms.num_contacts; ++i) {
    const IkTerms::Contact& contact = terms.contacts[i];
    const double error = (pose.CalcPoint(contact.link, contact.p_LT) - contact.p_WTarget).norm();
    const double cosine = -contact.nhat_W.dot(pose.R_WL[contact.link].col(2));
    point->tip_errors[i] = error;
    point->cosines[i] = cosine;
    point->max_tip_error = std::max(point->max_tip_error, error);
    point->min_cosine = std::min(point->min_cosine, cosine);
    task +=
        terms.contact_weight * (Square(error / kSigmaLength) + Square(ConeResidual(terms, cosine)));
    preference += Square(PadResidual(Dorsal(contact, pose)));
  }
  const HandVector deviation = CalcDeviation(terms, point->configuration);
  preference += deviation.cwiseAbs2().dot(terms.reference_weights);
  point->task_cost = task;
  point->cost = task + preference;
  return point->cost;
}

void CalcDistances(const IkTerms& terms, double influence, IkPoint* point) {
  point->near.clear();
  point->clearance = influence;
  point->contact_overlap = 0.0;
  if (!terms.config.collision) return;
  CapsuleEnds ends;
  CalcCapsuleEnds(terms.hand, point->pose, &ends);
  FindNearSelf(terms.hand, ends, influence, &point->near);
  if (terms.obstacles != nullptr) {
    terms.obstacles->FindNear(terms.hand, ends, terms.placed, terms.touch, influence, &point->near);
  }
  double task = 0.0;
  for (const HandDistance& near : point->near) {
    if (near.touch) {
      point->contact_overlap = std::max(point->contact_overlap, -near.distance);
    } else {
      point->clearance = std::min(point->clearance, near.distance);
    }
    task += Square(DistanceResidual(terms, near));
  }
  point->task_cost += task;
  point->cost += task;
}

void EvaluatePoint(const IkTerms& terms, double influence, IkPoint* point) {
  CalcContactCost(terms, point);
  CalcDistances(terms, influence, point);
}

void CalcNormalEquations(const IkTerms& terms, const IkPoint& point, HandMatrix* JtJ,
                         HandVector* Jtr) {
  const HandPose& pose = point.pose;
  JtJ->setZero();
  JtJ->diagonal() = terms.reference_weights;
  *Jtr = terms.reference_weights.cwiseProduct(CalcDeviation(terms, point.configuration));
  HandVector row;
  const double sharpness = std::sqrt(terms.contact_weight);
  for (int i = 0; i < terms.num_contacts; ++i) {
    const IkTerms::Contact& contact = terms.contacts[i];
    const Vector3 p_WT = pose.CalcPoint(contact.link, contact.p_LT);
    const double per_length = sharpness / kSigmaLength;
    const Vector3 residual = per_length * (p_WT - contact.p_WTarget);
    for (int k = 0; k < 3; ++k) {
      row.setZero();
      AddPointGradient(terms.hand, pose, contact.link, p_WT, per_length * Vector3::Unit(k), &row);
      AddRow(row, residual[k], JtJ, Jtr);
    }
    if (const double cone = ConeResidual(terms, point.cosines[i]); cone > 0.0) {
      row.setZero();
      AddDirectionGradient(terms.hand, pose, contact.link, pose.R_WL[contact.link].col(2),
                           sharpness / kSigmaCone * contact.nhat_W, &row);
      AddRow(row, sharpness * cone, JtJ, Jtr);
    }
    if (const double pad = PadResidual(Dorsal(contact, pose)); pad > 0.0) {
      row.setZero();
      AddDirectionGradient(terms.hand, pose, contact.link, pose.R_WL[contact.link].col(1),
                           -contact.nhat_W / kSigmaPad, &row);
      AddRow(row, pad, JtJ, Jtr);
    }
  }
  for (const HandDistance& near : point.near) {
    const double residual = DistanceResidual(terms, near);
    if (residual <= 0.0) continue;
    row.setZero();
    AddDistanceGradient(terms.hand, pose, near, -1.0 / kSigmaLength, &row);
    AddRow(row, residual, JtJ, Jtr);
  }
}

bool IsSolution(const IkTerms& terms, const IkPoint& point, double tip_error) {
  return point.max_tip_error <= tip_error && point.min_cosine >= terms.least_cosine &&
         point.clearance >= terms.config.min_clearance + kStrictly &&
         point.contact_overlap <= terms.touch.depth - kStrictly;
}

}  // namespace pregrasp::internal
