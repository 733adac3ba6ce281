#pragma once

#include <filesystem>
#include <vector>

#include "app/networks/contact_features.h"
#include "app/networks/head.h"

namespace pregrasp {

/// What is asked of the score.
enum class ScoreOutput {
  kProgress,  ///< how far a situation is on its way to a grasp: what paths and MPPI climb
  kLifted,    ///< the probability that there is a grasp with these contacts that lifts the object
};

/// The learned score f(p1, p2, S, O) of the paper (section "Grasp generator and score function"):
/// how likely a situation with these contacts leads to a feasible five-finger grasp, as two numbers
/// (ScoreOutput). What their labels are stands in app/training. In [0, 1]; without any contact 0,
/// by definition. Weights with a single output, the paper's, give it for both; further outputs than
/// two are not asked for. Immutable, safe to share between threads.
class ScoreFunction {
 public:
  /// @throws InputError if the file is not the weights of a score function.
  static ScoreFunction Load(const std::filesystem::path& file);
  static ScoreFunction FromTensors(const TensorFile& file);

  const SetEncoder& encoder() const { return encoder_; }

  /// Once per object. @param R_WO0 its orientation at the start.
  CloudStructure BuildStructure(const MatrixX3& P_O, const Matrix3& R_WO0) const {
    return encoder_.BuildStructure(P_O, R_WO0);
  }

  /// Scores of many contacts in one state, as a contact graph asks for them (#contacts).
  VectorX ScoreContacts(const CloudStructure& structure, const ObjectState& state,
                        const std::vector<PlanningContacts>& contacts, ScoreOutput output,
                        ThreadPool& pool) const;

  /// The same on the calling thread alone.
  VectorX ScoreContacts(const CloudStructure& structure, const ObjectState& state,
                        const std::vector<PlanningContacts>& contacts, ScoreOutput output) const;

  /// Progress of many states with one choice of contacts each, as rollouts ask for it (#states).
  VectorX ScoreStates(const CloudStructure& structure, const std::vector<ObjectState>& states,
                      const std::vector<PlanningContacts>& contacts, ThreadPool& pool) const;

 private:
  void ScoreRange(const CloudStructure& structure, const EncodedState& encoded,
                  const std::vector<float>& share, const PlanningContacts* contacts, int count,
                  ScoreOutput output, double* scores) const;

  SetEncoder encoder_;
  ContactFeatureConfig contacts_;
  Head head_;
  int num_outputs_ = 1;
};

}  // namespace pregrasp
