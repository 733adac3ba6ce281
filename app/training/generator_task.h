#pragma once

#include <array>

#include "app/networks/grasp_generator.h"
#include "app/training/torch_networks.h"
#include "app/training/training_data.h"
#include "app/training/training_run.h"

namespace pregrasp {

struct GeneratorTaskConfig {
  SetEncoderConfig encoder;
  ContactFeatureConfig contacts;
  std::vector<int> hidden_widths = {256, 256};  ///< of the three decoders and recognition networks
  int latent_size = 8;
  double kl_weight = 0.05;  ///< of the divergence from the standard normal; at the paper's 0.01
                            ///< half as many completions of held-out objects are feasible
  int contexts_per_step = 16;
  int grasps_per_context = 16;
  std::uint64_t seed = 1;
};

/// The three grasp generators as conditional variational autoencoders (Sohn et al. 2015) on one
/// shared encoder. Loss: the mean distance of the predicted contacts, in units of 10 cm, over the
/// fingers that the grasp uses, plus the weighted divergence.
class GeneratorTask : public TrainingTask {
 public:
  GeneratorTask(const std::shared_ptr<const Dataset>& dataset,
                const std::vector<std::string>& validation_families,
                const GeneratorTaskConfig& config);

  torch::nn::Module& module() override { return *module_; }
  torch::Tensor CalcLoss(std::int64_t step) override;
  /// By generator: the mean error of reconstruction, and of the nearest of 20 samples [mm].
  nlohmann::ordered_json Evaluate() override;
  std::string Describe() const override;

  /// The weights as GraspGenerator loads them.
  TensorFile Export() const;

  /// What GraspGenerator::Decode answers in `context`, by the network under training.
  std::vector<GraspPoints> Decode(const TrainingContext& context, const PlanningContacts& contacts,
                                  const std::vector<float>& latent);

  const TrainingData& data() const { return data_; }

 private:
  struct Model;
  struct Case;
  std::array<Case, 3> BuildCases(const EncoderBatch& batch,
                                 const std::vector<TrainingState>& states,
                                 const std::vector<std::vector<const GraspRecord*>>& grasps) const;

  GeneratorTaskConfig config_;
  std::vector<std::string> validation_families_;
  TrainingData data_;
  BatchOrder order_;
  std::shared_ptr<Model> model_;
  std::shared_ptr<torch::nn::Module> module_;
};

}  // namespace pregrasp
