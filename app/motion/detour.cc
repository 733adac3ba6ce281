#include "app/motion/detour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/hand/hand_kinematics.h"

namespace pregrasp {
namespace {

using Points = std::vector<HandConfiguration>;

// With contacts kept, the hand is put on them anew this often, in units of a step.
constexpr double kContactSpacing = 0.4;
constexpr double kPointSpacing = 0.5;  // of the points between which a way is shortened

// In units of 5 cm and half a radian.
double CalcLength(const HandConfiguration& a, const HandConfiguration& b) {
  return CalcStep(a, b).cwiseQuotient(HandUnits()).norm();
}

struct Tree {
  Points nodes;
  std::vector<int> parents;

  int Add(const HandConfiguration& node, int parent) {
    nodes.push_back(node);
    parents.push_back(parent);
    return static_cast<int>(nodes.size()) - 1;
  }

  int FindNearest(const HandConfiguration& goal) const {
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double length = CalcLength(nodes[i], goal);
      if (length >= least) continue;
      least = length;
      nearest = static_cast<int>(i);
    }
    return nearest;
  }

  // From a node to the root.
  Points WayToRoot(int node) const {
    Points points;
    for (; node >= 0; node = parents[node]) points.push_back(nodes[node]);
    return points;
  }
};

class DetourFinder {
 public:
  DetourFinder(const IkSolver& solver, const IkConfig& ik, const DetourConfig& config,
               const DetourProblem& problem, const Rng& rng)
      : solver_(solver), config_(config), problem_(problem), ik_(ik), rng_(rng) {
    ik_.max_starts = ik_.warm_starts = 1;
    ik_.reason_starts = 0;
    for (const IkContact& contact : problem.from_contacts) Touch(contact);
    for (const IkContact& contact : problem.to_contacts) Touch(contact);
    for (const IkContact& a : problem.from_contacts) {
      for (const IkContact& b : problem.to_contacts) {
        const bool same = a.finger == b.finger && (a.p_WC - b.p_WC).norm() < kSameContact;
        if (same) kept_.push_back(b);
      }
    }
  }

  DetourResult Find() {
    DetourResult result;
    if (const auto straight = FindLeg(problem_.from, problem_.to)) {
      result.kind = DetourKind::kStraight;
      result.points = *straight;
      return result;
    }
    const Points away = FindRetreat(problem_.from, problem_.from_contacts);
    Points back = FindRetreat(problem_.to, problem_.to_contacts);
    std::reverse(back.begin(), back.end());
    result.kind = DetourKind::kRetreat;
    std::optional<Points> middle = FindLeg(away.back(), back.front());
    if (!middle) {
      result.kind = DetourKind::kSearch;
      middle = Search(away.back(), back.front(), &result.tries);
    }
    if (!middle) {
      result.kind = DetourKind::kBlocked;
      middle = {away.back(), back.front()};
    }
    Append(away, &result.points);
    Append(*middle, &result.points);
    Append(back, &result.points);
    if (result.kind != DetourKind::kBlocked) Shorten(&result.points);
    return result;
  }

 private:
  void Touch(const IkContact& contact) { touch_.touching[static_cast<int>(contact.finger)] = true; }

  static void Append(const Points& more, Points* points) {
    for (const HandConfiguration& point : more) {
      if (points->empty() || CalcLength(points->back(), point) > 0.0) points->push_back(point);
    }
  }

  bool IsClear(const HandConfiguration& a, const HandConfiguration& b) const {
    HandWay way;
    way.from = a;
    way.to = b;
    way.X_WB = {problem_.X_WB};
    way.touch = touch_;
    way.touch.depth = ik_.contact_depth;
    way.min_clearance = ik_.min_clearance;
    return solver_.CheckWay(way).clear;
  }

  // The configuration nearest to this one that keeps the contacts that are kept.
  std::optional<HandConfiguration> Keep(const HandConfiguration& at) const {
    IkProblem problem;
    problem.contacts = kept_;
    problem.may_touch = touch_.touching;
    problem.X_WB = problem_.X_WB;
    problem.warm_start = problem.reference = at;
    const IkResult result = solver_.Solve(ik_, problem, rng_);
    if (!result.solved()) return std::nullopt;
    return result.configuration();
  }

  // The straight way, put on the kept contacts all along; if it is clear.
  std::optional<Points> FindLeg(const HandConfiguration& a, const HandConfiguration& b) const {
    Points points{a};
    if (!kept_.empty()) {
      const int count = static_cast<int>(std::ceil(CalcLength(a, b) / kContactSpacing));
      for (int i = 1; i < count; ++i) {
        const auto kept = Keep(Interpolate(a, b, static_cast<double>(i) / count));
        if (!kept || !IsClear(points.back(), *kept)) return std::nullopt;
        points.push_back(*kept);
      }
    }
    if (!IsClear(points.back(), b)) return std::nullopt;
    points.push_back(b);
    return points;
  }

  bool IsKept(Finger finger) const {
    return std::any_of(kept_.begin(), kept_.end(),
                       [finger](const IkContact& contact) { return contact.finger == finger; });
  }

  // From a configuration in contact to one off its contacts, as far as one of some ways goes: the
  // configuration alone if none does.
  Points FindRetreat(const HandConfiguration& at, const std::vector<IkContact>& contacts) const {
    Points best{at};
    if (contacts.size() == kept_.size()) return best;
    for (const double share : {1.0, 0.5, 0.25}) {
      for (const HandConfiguration& off : RetreatsFrom(at, contacts, share * config_.retreat)) {
        if (const auto leg = FindLeg(at, off)) return *leg;
      }
    }
    return best;
  }

  Points RetreatsFrom(const HandConfiguration& at, const std::vector<IkContact>& contacts,
                      double length) const {
    Points places;
    IkProblem problem;
    problem.X_WB = problem_.X_WB;
    problem.may_touch = touch_.touching;
    problem.warm_start = problem.reference = at;
    for (IkContact contact : contacts) {
      if (!IsKept(contact.finger)) contact.p_WC += length * contact.nhat_W;
      problem.contacts.push_back(contact);
    }
    IkConfig loose = ik_;
    loose.tip_tolerance = std::max(ik_.tip_tolerance, 0.2 * length);
    loose.max_cone_deg = 180.0;
    const IkResult open = solver_.Solve(loose, problem, rng_);
    if (open.solved()) places.push_back(open.configuration());
    if (!kept_.empty()) return places;
    // The whole hand back along the forearm, off the palm's back, up, and between them.
    const Matrix3& R_WH = at.X_WH.linear();
    const Vector3 back = -R_WH.col(2), dorsal = R_WH.col(1), up = problem_.up_W;
    for (const Vector3& direction : {Vector3(back), Vector3(dorsal), Vector3(up),
                                     Vector3(back + dorsal), Vector3(back + up)}) {
      HandConfiguration moved = at;
      moved.X_WH.translation() += 2.0 * length * direction.normalized();
      places.push_back(moved);
    }
    return places;
  }

  // RRT-Connect.
  std::optional<Points> Search(const HandConfiguration& from, const HandConfiguration& to,
                               int* tries) {
    Tree trees[2];
    trees[0].Add(from, -1);
    trees[1].Add(to, -1);
    for (int i = 0; i < config_.max_tries; ++i) {
      ThrowIfInterrupted();
      ++*tries;
      Tree &grown = trees[i % 2], &other = trees[1 - i % 2];
      // One sample in five is the other tree's root.
      const bool straight = rng_.Uniform() < 0.2;
      const double spread = i % 4 < 2 ? 1.0 : 2.0;  // each for both trees
      const HandConfiguration sample = straight ? other.nodes.front() : Sample(from, to, spread);
      const int node = Extend(&grown, grown.FindNearest(sample), sample);
      if (node < 0) continue;
      const HandConfiguration goal = grown.nodes[node];
      int near = other.FindNearest(goal);
      for (int next = near; next >= 0 && CalcLength(other.nodes[near], goal) > 1e-9;) {
        next = Extend(&other, near, goal);
        if (next >= 0) near = next;
      }
      if (CalcLength(other.nodes[near], goal) > kJoin) continue;
      if (!IsClear(other.nodes[near], goal)) continue;
      Points points = trees[0].WayToRoot(i % 2 == 0 ? node : near);
      std::reverse(points.begin(), points.end());
      Append(trees[1].WayToRoot(i % 2 == 0 ? near : node), &points);
      return points;
    }
    return std::nullopt;
  }

  // A new node from an old one towards a goal, at most max_edge away and less near obstacles; -1 if
  // the way is blocked.
  int Extend(Tree* tree, int node, const HandConfiguration& goal) const {
    const HandConfiguration start = tree->nodes[node];
    const double length = CalcLength(start, goal);
    if (!(length > 0.0)) return -1;
    for (const double part : {1.0, 0.4, 0.15}) {
      const double edge = part * config_.max_edge;
      if (edge > length && part < 1.0) continue;
      HandConfiguration next = edge < length ? Interpolate(start, goal, edge / length) : goal;
      if (!kept_.empty() && edge < length) {
        const auto kept = Keep(next);
        // Projected back to where it came from, it would not end.
        if (!kept || CalcLength(start, *kept) < 0.3 * edge) continue;
        next = *kept;
      }
      if (IsClear(start, next)) return tree->Add(next, node);
    }
    return -1;
  }

  HandConfiguration Sample(const HandConfiguration& from, const HandConfiguration& to,
                           double spread) {
    const HandConfiguration base = Interpolate(from, to, rng_.Uniform());
    HandVector step = HandVector::Zero();
    if (!kept_.empty()) spread *= 0.3;
    for (int i = 0; i < 3; ++i) {
      step[i] = spread * rng_.Uniform(-config_.spread, config_.spread);
      step[3 + i] = spread * rng_.Uniform(-config_.spread_angle, config_.spread_angle);
    }
    HandConfiguration sample = Advance(base, step);
    const HandJoints& open = solver_.hand().posture;
    for (int f = 0; f < solver_.hand().num_fingers; ++f) {
      const auto [first, count] = solver_.hand().fingers[f];
      if (IsKept(static_cast<Finger>(f))) continue;
      const double ease = rng_.Uniform();
      for (int j = first; j < first + count; ++j) {
        const double q = base.q[j] + ease * (open[j] - base.q[j]) + rng_.Uniform(-0.3, 0.3);
        sample.q[j] = std::clamp(q, solver_.hand().q_lower[j], solver_.hand().q_upper[j]);
      }
    }
    if (kept_.empty()) return sample;
    const auto kept = Keep(sample);
    return kept ? *kept : sample;
  }

  // Leaves out what lies between two points where the straight way between them is free. Points
  // are set all along it first, so that corners are cut as well as passed by.
  void Shorten(Points* points) {
    Points dense;
    for (std::size_t i = 0; i + 1 < points->size(); ++i) {
      dense.push_back((*points)[i]);
      if (!kept_.empty()) continue;  // only its points keep the contacts
      const int count =
          static_cast<int>(std::ceil(CalcLength((*points)[i], (*points)[i + 1]) / kPointSpacing));
      for (int k = 1; k < count; ++k) {
        dense.push_back(
            Interpolate((*points)[i], (*points)[i + 1], static_cast<double>(k) / count));
      }
    }
    dense.push_back(points->back());
    for (int i = 0; i < config_.shortcuts && dense.size() > 2; ++i) {
      const auto count = static_cast<std::uint32_t>(dense.size());
      const std::uint32_t one = rng_.UniformInt(count), two = rng_.UniformInt(count);
      const std::uint32_t a = std::min(one, two), b = std::max(one, two);
      if (b - a < 2) continue;
      const auto leg = FindLeg(dense[a], dense[b]);
      if (!leg) continue;
      Points shorter(dense.begin(), dense.begin() + a);
      Append(*leg, &shorter);
      Append(Points(dense.begin() + b, dense.end()), &shorter);
      if (CalcWhole(shorter) < CalcWhole(dense)) dense = std::move(shorter);
    }
    // Points on a straight line between their neighbours only slow the hand down.
    points->clear();
    for (std::size_t i = 0; i < dense.size(); ++i) {
      if (i > 0 && i + 1 < dense.size()) {
        const double through = CalcLength(points->back(), dense[i + 1]);
        const double both =
            CalcLength(points->back(), dense[i]) + CalcLength(dense[i], dense[i + 1]);
        if (both < (1.0 + 1e-9) * through) continue;
      }
      points->push_back(dense[i]);
    }
  }

  static double CalcWhole(const Points& points) {
    double length = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) length += CalcLength(points[i - 1], points[i]);
    return length;
  }

  static constexpr double kJoin = 0.5;  // two trees are joined over a last way this long

  const IkSolver& solver_;
  const DetourConfig& config_;
  const DetourProblem& problem_;
  IkConfig ik_;
  Rng rng_;
  TouchRule touch_;
  std::vector<IkContact> kept_;
};

}  // namespace

const char* DetourKindName(DetourKind kind) {
  constexpr const char* kNames[] = {"straight", "retreat", "search", "blocked"};
  return kNames[static_cast<int>(kind)];
}

DetourResult FindDetour(const IkSolver& solver, const IkConfig& ik, const DetourConfig& config,
                        const DetourProblem& problem, Rng rng) {
  return DetourFinder(solver, ik, config, problem, rng).Find();
}

}  // namespace pregrasp
