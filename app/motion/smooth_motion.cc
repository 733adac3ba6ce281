#include "app/motion/smooth_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/core/check.h"
#include "app/core/interrupt.h"
#include "app/hand/hand_kinematics.h"
#include "app/hand/ik_residuals.h"

namespace pregrasp {
namespace {

// A tip within 0.2 mm of its contact weighs as much as a millimetre of room: contacts are met, room
// is had where there is some.
constexpr double kContactWeight = 25.0;

constexpr double kFirstDamping = 1e-3;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e6;
constexpr double kProgress = 1e-3;  // relative decrease of the cost that counts as progress
constexpr int kPatience = 3;        // iterations without progress that are the end

// Symmetric and positive definite, blocks of two frames, each coupled with the next: a frame is
// coupled with the two after it.
class BandedSystem {
 public:
  static constexpr int kSize = 2 * kMaxHandDofs;
  using Block = Eigen::Matrix<double, kSize, kSize>;
  using Part = Eigen::Matrix<double, kSize, 1>;

  explicit BandedSystem(int frames)
      : frames_(frames),
        diagonal_((frames + 1) / 2),
        lower_((frames + 1) / 2),
        b_((frames + 1) / 2) {}

  void SetZero() {
    for (std::size_t k = 0; k < diagonal_.size(); ++k) {
      diagonal_[k].setZero();
      lower_[k].setZero();
      b_[k].setZero();
    }
    if (frames_ % 2 == 1) diagonal_.back().diagonal().tail<kMaxHandDofs>().setOnes();
  }

  // The entry of rows of frame j and columns of frame i, i <= j <= i + 2. Of i == j the lower half
  // counts.
  auto At(int j, int i) {
    Block& block = j / 2 == i / 2 ? diagonal_[j / 2] : lower_[j / 2];
    return block.block<kMaxHandDofs, kMaxHandDofs>(j % 2 * kMaxHandDofs, i % 2 * kMaxHandDofs);
  }
  auto RightSide(int i) { return b_[i / 2].segment<kMaxHandDofs>(i % 2 * kMaxHandDofs); }

  // Adds the damping, holds unknown d of frame i at zero where asked for, and solves. False where
  // it is not positive definite.
  bool Solve(const HandVector& damping, const std::vector<std::array<bool, kMaxHandDofs>>& held,
             std::vector<HandVector>* solution) const {
    std::vector<Block> factor = diagonal_;
    std::vector<Block> below = lower_;
    std::vector<Part> x = b_;
    for (int i = 0; i < frames_; ++i) {
      const int k = i / 2;
      for (int d = 0; d < kMaxHandDofs; ++d) {
        const int row = i % 2 * kMaxHandDofs + d;
        factor[k](row, row) += damping[d];
        if (!held[i][d]) continue;
        factor[k].row(row).setZero();
        factor[k].col(row).setZero();
        factor[k](row, row) = 1.0;
        below[k].row(row).setZero();
        if (k + 1 < static_cast<int>(below.size())) below[k + 1].col(row).setZero();
        x[k][row] = 0.0;
      }
    }
    for (std::size_t k = 0; k < factor.size(); ++k) {
      if (k > 0) {
        // L = below U^-1 with the factor before; then the Schur complement.
        factor[k - 1].triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(
            below[k]);
        factor[k].selfadjointView<Eigen::Lower>().rankUpdate(below[k], -1.0);
        x[k].noalias() -= below[k] * x[k - 1];
      }
      const Eigen::LLT<Eigen::Ref<Block>> llt(factor[k]);  // in place
      if (llt.info() != Eigen::Success) return false;
      factor[k].triangularView<Eigen::Lower>().solveInPlace(x[k]);
    }
    for (int k = static_cast<int>(factor.size()) - 1; k >= 0; --k) {
      if (k + 1 < static_cast<int>(factor.size())) {
        x[k].noalias() -= below[k + 1].transpose() * x[k + 1];
      }
      factor[k].triangularView<Eigen::Lower>().transpose().solveInPlace(x[k]);
    }
    solution->resize(frames_);
    for (int i = 0; i < frames_; ++i) {
      (*solution)[i] = x[i / 2].segment<kMaxHandDofs>(i % 2 * kMaxHandDofs);
    }
    return true;
  }

 private:
  int frames_;
  std::vector<Block> diagonal_, lower_;  // lower_[k] couples block k with block k - 1
  std::vector<Part> b_;
};

class Smoother {
 public:
  Smoother(const IkSolver& solver, const std::vector<HandDemand>& demands,
           const std::vector<HandDemand>& ways, const HandLimits& limits, double fps,
           const SmoothingConfig& config)
      : hand_(solver.hand()),
        config_(config),
        count_(static_cast<int>(demands.size())),
        system_(count_ - 1) {
    for (const HandDemand& demand : demands) {
      frames_.emplace_back(solver, demand.config, demand.problem, kContactWeight);
    }
    for (const HandDemand& way : ways) middles_.emplace_back(solver, way.config, way.problem);
    const double step = config.limit_share / fps;
    const double bend = step / fps;
    groups_.push_back({0, 3, step * limits.wrist_speed, bend * limits.wrist_acceleration});
    groups_.push_back(
        {3, 3, step * limits.wrist_turn_speed, bend * limits.wrist_turn_acceleration});
    for (int j = 0; j < hand_.num_joints; ++j) {
      groups_.push_back(
          {6 + j, 1, step * hand_.joints[j].max_speed, bend * limits.joint_acceleration});
    }
  }

  SmoothingResult Run(std::vector<HandConfiguration>* motion) {
    SmoothingResult result;
    double cost = CalcCost(*motion);
    result.cost_before = cost;
    double damping = kFirstDamping;
    int idle = 0;
    bool moved = true;
    const HandVector scale = HandUnits().cwiseInverse().cwiseAbs2();
    while (result.iterations < config_.iterations && idle < kPatience && damping < kMostDamping) {
      ThrowIfInterrupted();
      if (moved) Linearize(*motion);
      ++result.iterations;
      moved = false;
      std::vector<HandVector> steps;
      if (system_.Solve(damping * scale, held_, &steps)) {
        std::vector<HandConfiguration> trial = *motion;
        for (int i = 1; i < count_; ++i) {
          trial[i] = Advance((*motion)[i], steps[i - 1]);
          trial[i].q = trial[i].q.cwiseMax(hand_.q_lower).cwiseMin(hand_.q_upper);
        }
        const double trial_cost = CalcCost(trial);
        moved = trial_cost < cost;
        if (moved) {
          idle = trial_cost > (1.0 - kProgress) * cost ? idle + 1 : 0;
          *motion = std::move(trial);
          cost = trial_cost;
        }
      }
      damping = moved ? std::max(kLeastDamping, 0.2 * damping) : 8.0 * damping;
    }
    result.cost_after = cost;
    return result;
  }

 private:
  // Degrees of freedom that are limited by their length together, and these limits by frame.
  struct Group {
    int first, size;
    double step, bend;
  };

  static HandConfiguration Middle(const HandConfiguration& a, const HandConfiguration& b) {
    return Advance(a, HandVector(0.5 * CalcStep(a, b)));
  }

  // The step into frame i, zero before the first and after the last.
  HandVector StepInto(const std::vector<HandConfiguration>& motion, int i) const {
    if (i <= 0 || i >= count_) return HandVector::Zero();
    return CalcStep(motion[i - 1], motion[i]);
  }

  double Excess(const Group& group, const HandVector& value, double limit) const {
    const double length = value.segment(group.first, group.size).norm();
    return config_.limit_weight * std::max(0.0, length / limit - 1.0);
  }

  double CalcCost(const std::vector<HandConfiguration>& motion) {
    const HandVector weight = HandUnits().cwiseInverse();
    double cost = 0.0;
    HandVector before = HandVector::Zero();
    for (int i = 0; i < count_; ++i) {
      if (i > 0) cost += frames_[i].Evaluate(motion[i]);
      if (i + 1 < count_) cost += middles_[i].Evaluate(Middle(motion[i], motion[i + 1]));
      const HandVector after = StepInto(motion, i + 1);
      const HandVector bend = after - before;
      cost += (config_.step_weight * weight.cwiseProduct(before)).squaredNorm() +
              (config_.bend_weight * weight.cwiseProduct(bend)).squaredNorm();
      for (const Group& group : groups_) {
        const double speeding = Excess(group, before, group.step);
        const double jerking = Excess(group, bend, group.bend);
        cost += speeding * speeding + jerking * jerking;
      }
      before = after;
    }
    return cost;
  }

  // Residuals about `value`, a sum of the frames from `first` on by `shares`: its length, weighted,
  // and by how much it exceeds the limits.
  template <std::size_t kCount>
  void AddSum(int first, const std::array<double, kCount>& shares, const HandVector& value,
              double weight, double Group::*limit) {
    const HandVector units = HandUnits();
    for (const Group& group : groups_) {
      const auto part = value.segment(group.first, group.size);
      const double square = weight * weight / (units[group.first] * units[group.first]);
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> M =
          square * Eigen::MatrixXd::Identity(group.size, group.size);
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> g = square * part;
      if (const double excess = Excess(group, value, group.*limit); excess > 0.0) {
        const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> row =
            config_.limit_weight / (group.*limit) * part.normalized();
        M += row * row.transpose();
        g += excess * row;
      }
      for (std::size_t a = 0; a < kCount; ++a) {
        const int i = first + static_cast<int>(a);
        if (i < 1 || i >= count_) continue;
        system_.RightSide(i - 1).segment(group.first, group.size) -= shares[a] * g;
        for (std::size_t b = 0; b <= a; ++b) {
          const int k = first + static_cast<int>(b);
          if (k < 1) continue;
          system_.At(i - 1, k - 1).block(group.first, group.first, group.size, group.size) +=
              shares[a] * shares[b] * M;
        }
      }
    }
  }

  void AddDemands() {
    for (int i = 1; i < count_; ++i) {
      HandMatrix A = HandMatrix::Zero();
      HandVector b = HandVector::Zero();
      frames_[i].AddNormalEquations(&A, &b);
      system_.At(i - 1, i - 1) += A;
      system_.RightSide(i - 1) -= b;
    }
    for (int i = 0; i + 1 < count_; ++i) {
      HandMatrix A = HandMatrix::Zero();
      HandVector b = HandVector::Zero();
      middles_[i].AddNormalEquations(&A, &b);
      if (b.isZero(0.0)) continue;
      A.triangularView<Eigen::StrictlyUpper>() = A.transpose();
      system_.At(i, i) += 0.25 * A;
      system_.RightSide(i) -= 0.5 * b;
      if (i == 0) continue;
      system_.At(i, i - 1) += 0.25 * A;
      system_.At(i - 1, i - 1) += 0.25 * A;
      system_.RightSide(i - 1) -= 0.5 * b;
    }
  }

  // About `motion`, where the cost was calculated last.
  void Linearize(const std::vector<HandConfiguration>& motion) {
    system_.SetZero();
    AddDemands();
    for (int i = 0; i < count_; ++i) {
      const HandVector before = StepInto(motion, i);
      const HandVector bend = StepInto(motion, i + 1) - before;
      if (i > 0) {
        AddSum<2>(i - 1, {-1.0, 1.0}, before, config_.step_weight, &Group::step);
      }
      // At rest before the first frame and after the last, a step is missing there.
      if (i == 0) {
        AddSum<2>(0, {-1.0, 1.0}, bend, config_.bend_weight, &Group::bend);
      } else if (i + 1 == count_) {
        AddSum<2>(i - 1, {1.0, -1.0}, bend, config_.bend_weight, &Group::bend);
      } else {
        AddSum<3>(i - 1, {1.0, -2.0, 1.0}, bend, config_.bend_weight, &Group::bend);
      }
    }
    held_.assign(count_ - 1, {});
    for (int i = 1; i < count_; ++i) {
      const auto descent = system_.RightSide(i - 1);
      for (int j = 0; j < kMaxHandJoints; ++j) {
        const double q = motion[i].q[j];
        held_[i - 1][6 + j] = j >= hand_.num_joints ||  // no joint of this hand
                              (q <= hand_.q_lower[j] && descent[6 + j] < 0.0) ||
                              (q >= hand_.q_upper[j] && descent[6 + j] > 0.0);
      }
    }
  }

  const HandModel& hand_;
  const SmoothingConfig& config_;
  int count_;
  std::vector<IkResiduals> frames_, middles_;
  std::vector<Group> groups_;
  BandedSystem system_;
  std::vector<std::array<bool, kMaxHandDofs>> held_;
};

}  // namespace

SmoothingResult SmoothMotion(const IkSolver& solver, const std::vector<HandDemand>& demands,
                             const std::vector<HandDemand>& ways, const HandLimits& limits,
                             double fps, const SmoothingConfig& config,
                             std::vector<HandConfiguration>* motion) {
  PREGRASP_CHECK(
      demands.size() >= 2 && ways.size() + 1 == demands.size() && motion->size() == demands.size(),
      demands.size(), ways.size(), motion->size());
  return Smoother(solver, demands, ways, limits, fps, config).Run(motion);
}

}  // namespace pregrasp
