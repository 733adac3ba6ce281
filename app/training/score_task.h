#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/training/torch_networks.h"
#include "app/training/training_data.h"
#include "app/training/training_run.h"

namespace pregrasp {

/// What is trained: the design's score function, or one of its ablations.
enum class ScoreVariant { kFull, kNoSdf, kNoShape, kFrozenEncoder };

/// "full", "no-sdf", "no-shape", "frozen-encoder". @throws InputError for another name.
ScoreVariant ParseScoreVariant(const std::string& name);
const char* ScoreVariantName(ScoreVariant variant);

/// Whose labels are learned.
enum class LabelSource {
  /// TruthRecord: progress and lifted; and the other candidate for progress, which nobody asks for,
  /// because what is learned for it helps both.
  kSearch,
  kCompletions,  ///< LabelRecord: the paper's share of feasible completions, one output
};

/// "search", "completions". @throws InputError for another name.
LabelSource ParseLabelSource(const std::string& name);
const char* LabelSourceName(LabelSource source);

/// Which of TruthRecord's values stands for progress.
enum class ProgressKind { kRelief, kRoom };
/// "relief", "room". @throws InputError for another name.
ProgressKind ParseProgressKind(const std::string& name);
const char* ProgressKindName(ProgressKind kind);

struct ScoreTaskConfig {
  SetEncoderConfig encoder;
  ContactFeatureConfig contacts;
  std::vector<int> hidden_widths = {256, 256};
  LabelSource source = LabelSource::kSearch;
  ProgressKind progress = ProgressKind::kRelief;
  ScoreVariant variant = ScoreVariant::kFull;
  /// Half of the states are learned mirrored, all but `lifted`, which is a right hand's.
  bool mirror = false;
  int contexts_per_step = 16;
  int labels_per_context = 16;
  std::uint64_t seed = 1;
};

/// The score function and its labels. Loss: the sum of the outputs' cross entropies; a label is a
/// share, or yes or no.
class ScoreTask : public TrainingTask {
 public:
  ScoreTask(const std::shared_ptr<const Dataset>& dataset,
            const std::vector<std::string>& validation_families, const ScoreTaskConfig& config);

  torch::nn::Module& module() override { return *module_; }
  torch::Tensor CalcLoss(std::int64_t step) override;
  nlohmann::ordered_json Evaluate() override;
  /// The same for the mean of all training labels as the only answer.
  nlohmann::ordered_json EvaluateConstant() const;
  std::string Describe() const override;

  /// The weights as ScoreFunction loads them.
  TensorFile Export() const;

  /// Predictions for all labels of some contexts, in order; and the labels.
  struct Predictions {
    std::vector<double> truth, prediction;          ///< of progress
    std::vector<double> lifted, lifted_prediction;  ///< empty for LabelSource::kCompletions
    std::vector<const TrainingContext*> context;
  };
  Predictions Predict(const std::vector<TrainingContext>& contexts);

  const TrainingData& data() const { return data_; }

 private:
  struct Model;
  static constexpr int kOutputs = 3;  // progress, lifted, and the other candidate for progress
  // Contacts with what is to be predicted of them.
  struct Label {
    const PlanningContacts* contacts = nullptr;
    std::array<float, kOutputs> values{};  // by ScoreOutput, then what is only trained beside
  };
  std::vector<Label> LabelsOf(const TrainingContext& context) const;
  int num_outputs() const { return config_.source == LabelSource::kSearch ? kOutputs : 1; }
  std::vector<int> head_widths() const;
  // #labels x num_outputs().
  torch::Tensor CalcLogits(const std::vector<TrainingState>& states,
                           const std::vector<std::vector<Label>>& labels);
  nlohmann::ordered_json EvaluateAll(const Predictions& all) const;
  nlohmann::ordered_json EvaluateSome(
      const Predictions& all, const std::function<bool(const TrainingContext&)>& keep) const;

  ScoreTaskConfig config_;
  std::vector<std::string> validation_families_;
  TrainingData data_;
  BatchOrder order_;
  std::shared_ptr<Model> model_;
  std::shared_ptr<torch::nn::Module> module_;
};

}  // namespace pregrasp
