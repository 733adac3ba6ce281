#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "app/core/rng.h"
#include "app/networks/contact_features.h"
#include "app/networks/head.h"

namespace pregrasp {

/// Five contact points in the object's frame, by Finger.
using GraspPoints = std::array<Vector3, kNumFingers>;

/// The three grasp generators of the paper (section "Grasp generator and score function"): decoders
/// of conditional variational autoencoders that complete a grasp from the thumb's contact, the
/// index finger's, or both. They share one encoder, so that a cloud is encoded once; latent samples
/// are rows of one multiplication. Immutable, safe to share between threads.
class GraspGenerator {
 public:
  /// @throws InputError if the file is not the weights of grasp generators.
  static GraspGenerator Load(const std::filesystem::path& file);
  static GraspGenerator FromTensors(const TensorFile& file);

  const SetEncoder& encoder() const { return encoder_; }
  int latent_size() const { return latent_size_; }

  /// Once per object. @param R_WO0 its orientation at the start.
  CloudStructure BuildStructure(const MatrixX3& P_O, const Matrix3& R_WO0) const {
    return encoder_.BuildStructure(P_O, R_WO0);
  }

  EncodedState Encode(const CloudStructure& structure, const ObjectState& state) const;

  /// `count` grasps from standard normal latent samples. The given contacts are kept as they are;
  /// the other points lie near the surface, not on it: the grasp stage projects and refines them.
  /// @param contacts  at least one.
  std::vector<GraspPoints> Sample(const CloudStructure& structure, const EncodedState& encoded,
                                  const PlanningContacts& contacts, int count, Rng rng) const;

  /// The same for given latent samples (#samples x latent_size(), row-major).
  std::vector<GraspPoints> Decode(const CloudStructure& structure, const EncodedState& encoded,
                                  const PlanningContacts& contacts,
                                  const std::vector<float>& latent) const;

 private:
  SetEncoder encoder_;
  ContactFeatureConfig contacts_;
  int latent_size_ = 0;
  std::array<Head, 3> heads_;  // thumb, index, both
};

/// Which of the three generators completes `contacts`: 0 thumb, 1 index, 2 both.
int GeneratorOf(const PlanningContacts& contacts);
inline constexpr std::array<const char*, 3> kGeneratorNames{"thumb", "index", "both"};

/// The fingers that generator `which` predicts, in order.
std::vector<Finger> PredictedFingers(int which);

/// Where generated points are measured from: the mean of the given contacts.
Vector3 CalcAnchor(const PlanningContacts& contacts);

}  // namespace pregrasp
