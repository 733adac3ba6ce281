#pragma once

#include <torch/torch.h>

#include <string>
#include <utility>
#include <vector>

#include "app/core/rng.h"
#include "app/networks/contact_features.h"
#include "app/networks/safetensors.h"
#include "app/networks/set_encoder.h"
#include "app/training/torch_ops.h"

namespace pregrasp {

/// A dense layer that learns: with batch normalisation (Ioffe and Szegedy 2015) over its rows or
/// with a bias.
class TrainableLayer : public torch::nn::Module {
 public:
  /// He initialisation from `rng`.
  TrainableLayer(int inputs, int outputs, bool normalized, Rng& rng);

  /// Before the activation.
  torch::Tensor Apply(const torch::Tensor& rows);
  /// Normalisation or bias alone, for a layer whose product was computed by other means.
  torch::Tensor Finish(const torch::Tensor& product);
  const torch::Tensor& weight() const { return weight_; }

  /// Adds NAME.weight and NAME.bias, normalisation folded in.
  void Export(const std::string& name, TensorFile& file) const;

 private:
  torch::Tensor weight_, bias_;
  torch::nn::BatchNorm1d norm_{nullptr};
};

/// A state as the trainer sees it: like ObjectState with its frame given, so that the heading can
/// be varied.
struct TrainingState {
  const CloudStructure* structure = nullptr;
  const VectorX* phi = nullptr;
  const std::vector<bool>* occluded = nullptr;
  Matrix3 R_GO = Matrix3::Identity();
};

/// The geometry of several states of any objects, as index lists over all of them.
struct EncoderBatch {
  torch::Tensor points;                ///< all states' points (position, signed distance), scaled
  std::vector<Edges> levels;           ///< one an encoder's level, masked points left out
  std::vector<torch::Tensor> centers;  ///< rows of the level before that are centroids, 64-bit
  Edges global;                        ///< from the last level's centroids to the states
  std::vector<std::vector<int>> present;  ///< by state: EncodedState's
  int first_level_size = 0;               ///< centroids of the first level of one state
};

EncoderBatch BuildEncoderBatch(const SetEncoderConfig& config,
                               const std::vector<TrainingState>& states);

/// SetEncoder, trainable.
class TrainableEncoder : public torch::nn::Module {
 public:
  TrainableEncoder(const SetEncoderConfig& config, Rng& rng);

  struct Result {
    torch::Tensor code;   ///< #states x code_size
    torch::Tensor local;  ///< (#states * first level's centroids) x local_size
  };
  Result Apply(const EncoderBatch& batch);

  const SetEncoderConfig& config() const { return config_; }
  void Export(TensorFile& file) const;

 private:
  SetEncoderConfig config_;
  std::vector<std::vector<std::shared_ptr<TrainableLayer>>> levels_;
  std::vector<std::shared_ptr<TrainableLayer>> global_, code_;
};

/// Head, trainable: rectified layers without normalisation.
class TrainableHead : public torch::nn::Module {
 public:
  TrainableHead(int inputs, const std::vector<int>& widths, Rng& rng);

  torch::Tensor Apply(torch::Tensor rows);
  void Export(const std::string& name, TensorFile& file) const;

 private:
  std::vector<int> widths_;
  std::vector<std::shared_ptr<TrainableLayer>> layers_;
};

/// Questions about contacts in the states of a batch, ready for a head.
struct QueryBatch {
  torch::Tensor state;         ///< #queries, 64-bit
  torch::Tensor numbers;       ///< #queries x what WriteContactNumbers writes
  torch::Tensor local_index;   ///< (#queries * fingers * neighbors), 64-bit
  torch::Tensor local_weight;  ///< #queries x fingers x neighbors; 0 for what is absent
};

/// Collects queries one by one.
class QueryBatchBuilder {
 public:
  QueryBatchBuilder(SetEncoderConfig encoder, const ContactFeatureConfig& config)
      : encoder_(std::move(encoder)), config_(config) {}

  /// @param state  the state's number in `batch`.
  void Add(const EncoderBatch& batch, int state, const TrainingState& geometry,
           const PlanningContacts& contacts);
  QueryBatch Build() const;

 private:
  SetEncoderConfig encoder_;
  ContactFeatureConfig config_;
  std::vector<std::int64_t> state_, index_;
  std::vector<float> numbers_, weight_;
};

/// (code, contact numbers, local features) of every query, in the order that Head takes them.
torch::Tensor GatherHeadInputs(const TrainableEncoder::Result& encoded, const QueryBatch& queries,
                               const ContactFeatureConfig& config);

/// The rotation of frame G for training: upright at X_WO, turned by `heading` [rad].
Matrix3 CalcTrainingFrame(const Matrix3& R_WO, double heading);

}  // namespace pregrasp
