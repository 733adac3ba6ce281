#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/core/rng.h"
#include "app/networks/contact_features.h"
#include "app/networks/head.h"

namespace pregrasp {

/// Five contact points in the object's frame, by Finger. Ring and little may be left out, if not
/// finite.
using GraspPoints = std::array<Vector3, kNumFingers>;

/// A decoder that integrates a learned velocity from noise to contact points (flow matching, Lipman
/// et al. 2023), in place of the paper's single step from a latent sample. Kept with its weights.
struct FlowConfig {
  int steps = 10;      ///< of Euler's method
  double noise = 0.5;  ///< deviation of the points at time 0, in units of 1 / position_scale
  /// How often grasps use all fingers, all but the little one, all but the ring one, neither.
  std::array<double, 4> finger_sets{0.25, 0.25, 0.25, 0.25};

  std::string ToJson() const;
  static FlowConfig FromJson(const std::string& text, const std::string& where);
};

/// The time from 0 to 1 as the velocity takes it.
inline constexpr int kTimeNumbers = 3;
void WriteTimeNumbers(double t, float* out);
/// What the velocity takes beside the condition: points, which fingers are used, time.
int FlowInputCount(int fingers);
/// 1 for each of the fingers predicted that is used, 0 for ring and little if left out. @param
/// number  standard normal.
std::vector<float> ChooseFingers(const FlowConfig& flow, int fingers, float number);
/// Of a row of latent numbers: noise of all points, and one that chooses the fingers.
inline constexpr int kFlowLatentSize = 3 * (kNumFingers - 1) + 1;

/// The three grasp generators of the paper (section "Grasp generator and score function"), which
/// complete a grasp from the thumb's contact, the index finger's, or both: decoders of conditional
/// variational autoencoders, as there, or flows. They share one encoder, so that a cloud is encoded
/// once; latent samples are rows of one multiplication. Immutable, safe to share between threads.
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
  // Numbers behind the condition to points in frame G from the anchor, a row each.
  std::vector<std::vector<float>> DecodeOnce(const Head& head, const std::vector<float>& share,
                                             const std::vector<float>& condition,
                                             const std::vector<std::vector<float>>& rows) const;
  std::vector<std::vector<float>> Flow(const Head& head, const std::vector<float>& share,
                                       const std::vector<float>& condition, int which,
                                       const std::vector<float>& latent) const;

  SetEncoder encoder_;
  ContactFeatureConfig contacts_;
  std::optional<FlowConfig> flow_;
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
