#pragma once

#include <filesystem>
#include <vector>

#include "app/networks/contact_features.h"
#include "app/networks/head.h"

namespace pregrasp {

/// The learned score f(p1, p2, S, O) of the paper (section "Grasp generator and score function"):
/// how likely a situation with these contacts leads to a feasible five-finger grasp. What its label
/// is stands in app/training. In [0, 1]; without any contact 0, by definition. Immutable, safe to
/// share between threads.
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
                        const std::vector<PlanningContacts>& contacts, ThreadPool& pool) const;

  /// The same on the calling thread alone.
  VectorX ScoreContacts(const CloudStructure& structure, const ObjectState& state,
                        const std::vector<PlanningContacts>& contacts) const;

  /// Scores of many states with one choice of contacts each, as rollouts ask for them (#states).
  VectorX ScoreStates(const CloudStructure& structure, const std::vector<ObjectState>& states,
                      const std::vector<PlanningContacts>& contacts, ThreadPool& pool) const;

 private:
  void ScoreRange(const CloudStructure& structure, const EncodedState& encoded,
                  const std::vector<float>& share, const PlanningContacts* contacts, int count,
                  double* scores) const;

  SetEncoder encoder_;
  ContactFeatureConfig contacts_;
  Head head_;
};

}  // namespace pregrasp
