#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace pregrasp {

/// How a network is trained: AdamW (Loshchilov and Hutter 2019), the learning rate rising linearly
/// over `warm_up` steps and falling as a cosine over the rest. Counted in steps, never in seconds.
struct TrainingConfig {
  std::int64_t steps = 10'000;
  double learning_rate = 2e-3;
  double weight_decay = 1e-3;
  std::int64_t warm_up = 100;
  double final_share = 0.02;  ///< of the learning rate, at the last step
  double max_gradient = 5.0;  ///< the gradient's norm is cut to this
  std::uint64_t seed = 1;
  std::int64_t evaluate_every = 1000;
  std::int64_t checkpoint_every = 500;
  std::filesystem::path checkpoint;  ///< empty: none

  /// @throws InputError.
  void Validate() const;
  /// What of this decides the weights.
  nlohmann::ordered_json ToJson() const;
};

double CalcLearningRate(const TrainingConfig& config, std::int64_t step);

/// A network with its data.
class TrainingTask {
 public:
  virtual ~TrainingTask() = default;

  virtual torch::nn::Module& module() = 0;
  /// The loss of step `step`: a pure function of it, of the seed and of the module's parameters.
  virtual torch::Tensor CalcLoss(std::int64_t step) = 0;
  /// Metrics on the validation set, with the module in evaluation mode and without gradients.
  virtual nlohmann::ordered_json Evaluate() = 0;
  /// JSON of everything besides TrainingConfig that decides the weights.
  virtual std::string Describe() const = 0;
};

struct TrainingProgress {
  std::int64_t step = 0, steps = 0;
  double loss = 0.0;                      ///< mean since the last report
  const nlohmann::ordered_json* metrics;  ///< at an evaluation, else null
};

/// Trains from the start, or from the checkpoint if there is one: cut off at any moment and
/// continued, the weights are the same to the last bit. Uses the calling thread only.
/// @return the history: a list of {step, loss, metrics}.
/// @throws InputError if the checkpoint is of another task or configuration; Interrupted, after
/// writing a checkpoint.
nlohmann::ordered_json RunTraining(TrainingTask& task, const TrainingConfig& config,
                                   const std::function<void(const TrainingProgress&)>& report);

/// Settings of libtorch and of memory allocation that training relies on; once, before any tensor.
void PrepareTorch();

}  // namespace pregrasp
