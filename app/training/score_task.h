#pragma once

#include "app/training/torch_networks.h"
#include "app/training/training_data.h"
#include "app/training/training_run.h"

namespace pregrasp {

/// What is trained: the design's score function, or one of its ablations.
enum class ScoreVariant { kFull, kNoSdf, kNoShape, kFrozenEncoder };

/// "full", "no-sdf", "no-shape", "frozen-encoder". @throws InputError for another name.
ScoreVariant ParseScoreVariant(const std::string& name);
const char* ScoreVariantName(ScoreVariant variant);

struct ScoreTaskConfig {
  SetEncoderConfig encoder;
  ContactFeatureConfig contacts;
  std::vector<int> head_widths = {256, 256, 1};
  ScoreVariant variant = ScoreVariant::kFull;
  int contexts_per_step = 16;
  int labels_per_context = 16;
  std::uint64_t seed = 1;
};

/// The score function and its labels. Loss: cross entropy of the label, which is a share.
class ScoreTask : public TrainingTask {
 public:
  ScoreTask(const std::shared_ptr<const Dataset>& dataset,
            const std::vector<std::string>& validation_families, const ScoreTaskConfig& config);

  torch::nn::Module& module() override { return *module_; }
  torch::Tensor CalcLoss(std::int64_t step) override;
  nlohmann::ordered_json Evaluate() override;
  std::string Describe() const override;

  /// The weights as ScoreFunction loads them.
  TensorFile Export() const;

  /// Predictions for all labels of some contexts, in order; and the labels.
  struct Predictions {
    std::vector<double> truth, prediction;
    std::vector<const DatasetItem*> item;
  };
  Predictions Predict(const std::vector<TrainingContext>& contexts);

  const TrainingData& data() const { return data_; }

 private:
  struct Model;
  torch::Tensor CalcLogits(const std::vector<TrainingState>& states,
                           const std::vector<std::vector<const LabelRecord*>>& labels);

  ScoreTaskConfig config_;
  std::vector<std::string> validation_families_;
  TrainingData data_;
  BatchOrder order_;
  std::shared_ptr<Model> model_;
  std::shared_ptr<torch::nn::Module> module_;
};

}  // namespace pregrasp
