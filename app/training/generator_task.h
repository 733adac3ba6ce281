#pragma once

#include <array>

#include "app/networks/grasp_generator.h"
#include "app/training/torch_networks.h"
#include "app/training/training_data.h"
#include "app/training/training_run.h"

namespace pregrasp {

/// How contact points come from noise.
enum class GeneratorDecoder {
  kFlow,         ///< a velocity, integrated: flow matching (Lipman et al. 2023)
  kAutoencoder,  ///< the paper's: one step from a latent sample
};
/// "flow", "autoencoder". @throws InputError for another name.
GeneratorDecoder ParseGeneratorDecoder(const std::string& name);
const char* GeneratorDecoderName(GeneratorDecoder decoder);

struct GeneratorTaskConfig {
  SetEncoderConfig encoder;
  ContactFeatureConfig contacts;
  GeneratorDecoder decoder = GeneratorDecoder::kFlow;
  /// Of the three decoders, and of a variational autoencoder's recognition networks.
  std::vector<int> hidden_widths = {256, 256, 256};
  FlowConfig flow;     ///< but for finger_sets, which the data set's grasps decide
  int flow_times = 2;  ///< drawn for each grasp and step
  int latent_size = 8;
  double kl_weight = 0.05;  ///< of the divergence from the standard normal; at the paper's 0.01
                            ///< half as many completions of held-out objects are feasible
  /// The same's, of the mean overlap of neighbouring fingertips, so that samples do not collapse
  /// into one place: contacts nearer to each other than a tip is wide, in the loss's unit.
  double spacing_weight = 1.0;
  int contexts_per_step = 16;
  int grasps_per_context = 16;
  std::uint64_t seed = 1;
};

/// The three grasp generators on one shared encoder. Loss of an autoencoder (Sohn et al. 2015): the
/// mean distance of the predicted contacts, in units of 10 cm, over the fingers that the grasp
/// uses, plus the weighted divergence and overlap. Loss of a flow: the mean squared error of the
/// velocity on straight ways from noise to these contacts.
class GeneratorTask : public TrainingTask {
 public:
  GeneratorTask(const std::shared_ptr<const Dataset>& dataset,
                const std::vector<std::string>& validation_families,
                const GeneratorTaskConfig& config);

  torch::nn::Module& module() override { return *module_; }
  torch::Tensor CalcLoss(std::int64_t step) override;
  /// By generator: the mean error of the nearest of 20 samples, their spread, and of an autoencoder
  /// the error of reconstruction [mm].
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
  torch::Tensor CalcFlowLoss(int which, const torch::Tensor& condition, const Case& sample,
                             Rng& rng) const;
  torch::Tensor CalcAutoencoderLoss(int which, const torch::Tensor& condition, const Case& sample,
                                    Rng& rng) const;
  // Points of the fingers in `mask` from latent numbers.
  torch::Tensor DecodeFlow(int which, const torch::Tensor& condition, const torch::Tensor& mask,
                           const torch::Tensor& noise) const;
  torch::Tensor DrawPoints(int which, const torch::Tensor& condition, const torch::Tensor& mask,
                           Rng& rng) const;
  bool is_flow() const { return config_.decoder == GeneratorDecoder::kFlow; }
  // The mean, over grasps, of how far predicted tips of neighbouring fingers overlap, summed.
  torch::Tensor CalcTipOverlap(int which, const torch::Tensor& points, const Case& sample) const;
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
