#include "app/training/score_task.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/training/metrics.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<ScoreVariant, const char*>, 4> kVariants{
    {{ScoreVariant::kFull, "full"},
     {ScoreVariant::kNoSdf, "no-sdf"},
     {ScoreVariant::kNoShape, "no-shape"},
     {ScoreVariant::kFrozenEncoder, "frozen-encoder"}}};

SetEncoderConfig EncoderOf(const ScoreTaskConfig& config) {
  SetEncoderConfig encoder = config.encoder;
  if (config.variant == ScoreVariant::kNoSdf) encoder.phi_scale = 0.0;
  if (config.variant == ScoreVariant::kNoShape) encoder.position_scale = 0.0;
  return encoder;
}

bool HasLabels(const TrainingContext& context) { return !context.labels.empty(); }

}  // namespace

ScoreVariant ParseScoreVariant(const std::string& name) {
  for (const auto& [variant, known] : kVariants) {
    if (name == known) return variant;
  }
  throw InputError("", "variant", "full, no-sdf, no-shape or frozen-encoder", name);
}

const char* ScoreVariantName(ScoreVariant variant) {
  return kVariants[static_cast<std::size_t>(variant)].second;
}

struct ScoreTask::Model : torch::nn::Module {
  Model(const SetEncoderConfig& encoder_config, const ScoreTaskConfig& config, Rng rng) {
    encoder = register_module("encoder", std::make_shared<TrainableEncoder>(encoder_config, rng));
    head = register_module("head", std::make_shared<TrainableHead>(
                                       encoder_config.code_size() +
                                           ContactFeatureCount(config.contacts, encoder_config),
                                       config.head_widths, rng));
    if (config.variant == ScoreVariant::kFrozenEncoder) {
      for (const torch::Tensor& parameter : encoder->parameters()) {
        torch::Tensor(parameter).set_requires_grad(false);
      }
    }
  }

  std::shared_ptr<TrainableEncoder> encoder;
  std::shared_ptr<TrainableHead> head;
};

ScoreTask::ScoreTask(const std::shared_ptr<const Dataset>& dataset,
                     const std::vector<std::string>& validation_families,
                     const ScoreTaskConfig& config)
    : config_(config),
      validation_families_(validation_families),
      data_(PrepareTrainingData(dataset, config.encoder.levels, validation_families, HasLabels)),
      order_(static_cast<std::int64_t>(data_.training.size()), config.seed) {
  config_.encoder = EncoderOf(config);
  model_ = std::make_shared<Model>(config_.encoder, config_,
                                   Rng(config.seed, RngStream::kInitialWeights));
  module_ = model_;
}

torch::Tensor ScoreTask::CalcLogits(const std::vector<TrainingState>& states,
                                    const std::vector<std::vector<const LabelRecord*>>& labels) {
  const EncoderBatch batch = BuildEncoderBatch(config_.encoder, states);
  QueryBatchBuilder queries(config_.encoder, config_.contacts);
  for (std::size_t s = 0; s < states.size(); ++s) {
    for (const LabelRecord* label : labels[s]) {
      queries.Add(batch, static_cast<int>(s), states[s], label->contacts);
    }
  }
  return model_->head
      ->Apply(GatherHeadInputs(model_->encoder->Apply(batch), queries.Build(), config_.contacts))
      .squeeze(1);
}

torch::Tensor ScoreTask::CalcLoss(std::int64_t step) {
  std::vector<TrainingState> states;
  std::vector<std::vector<const LabelRecord*>> labels;
  std::vector<float> values;
  Rng rng(config_.seed, RngStream::kBatchNoise, step);
  for (const std::int64_t number : order_.Draw(step, config_.contexts_per_step)) {
    const TrainingContext& context = data_.training[number];
    const double heading = rng.Uniform(0.0, 2.0 * kPi);
    states.push_back({context.structure, &context.context->phi, &context.context->occluded,
                      CalcTrainingFrame(context.context->X_WO.linear(), heading)});
    labels.emplace_back();
    const int count = static_cast<int>(context.labels.size());
    for (const int i : DrawSubset(count, config_.labels_per_context, rng)) {
      labels.back().push_back(context.labels[i]);
      values.push_back(static_cast<float>(context.labels[i]->Value()));
    }
  }
  return torch::binary_cross_entropy_with_logits(CalcLogits(states, labels), torch::tensor(values));
}

ScoreTask::Predictions ScoreTask::Predict(const std::vector<TrainingContext>& contexts) {
  Predictions result;
  constexpr std::size_t kBatch = 32;
  for (std::size_t first = 0; first < contexts.size(); first += kBatch) {
    std::vector<TrainingState> states;
    std::vector<std::vector<const LabelRecord*>> labels;
    for (std::size_t c = first; c < std::min(contexts.size(), first + kBatch); ++c) {
      const TrainingContext& context = contexts[c];
      states.push_back({context.structure, &context.context->phi, &context.context->occluded,
                        CalcTrainingFrame(context.context->X_WO.linear(), 0.0)});
      labels.push_back(context.labels);
      for (const LabelRecord* label : context.labels) {
        result.truth.push_back(label->Value());
        result.item.push_back(context.item);
      }
    }
    const torch::Tensor scores = torch::sigmoid(CalcLogits(states, labels)).contiguous();
    result.prediction.insert(result.prediction.end(), scores.data_ptr<float>(),
                             scores.data_ptr<float>() + scores.numel());
  }
  return result;
}

Json ScoreTask::Evaluate() {
  const Predictions all = Predict(data_.validation);
  Json metrics{{"labels", all.truth.size()},
               {"r2", CalcR2(all.truth, all.prediction)},
               {"rank_correlation", CalcRankCorrelation(all.truth, all.prediction)}};
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> families;
  for (std::size_t i = 0; i < all.truth.size(); ++i) {
    families[all.item[i]->family].first.push_back(all.truth[i]);
    families[all.item[i]->family].second.push_back(all.prediction[i]);
  }
  for (const auto& [family, pair] : families) {
    metrics["families"][family] = {
        {"labels", pair.first.size()},
        {"r2", CalcR2(pair.first, pair.second)},
        {"rank_correlation", CalcRankCorrelation(pair.first, pair.second)}};
  }
  metrics["calibration"] = Json::array();
  for (const CalibrationBin& bin : CalcCalibration(all.truth, all.prediction)) {
    metrics["calibration"].push_back({{"low", bin.low},
                                      {"high", bin.high},
                                      {"count", bin.count},
                                      {"prediction", bin.mean_prediction},
                                      {"truth", bin.mean_truth}});
  }
  return metrics;
}

std::string ScoreTask::Describe() const {
  return Json{{"task", "score"},
              {"variant", ScoreVariantName(config_.variant)},
              {"dataset", data_.dataset->hash},
              {"validation", validation_families_},
              {"encoder", Json::parse(config_.encoder.ToJson())},
              {"contacts", Json::parse(config_.contacts.ToJson())},
              {"head", config_.head_widths},
              {"contexts_per_step", config_.contexts_per_step},
              {"labels_per_context", config_.labels_per_context},
              {"seed", config_.seed}}
      .dump();
}

TensorFile ScoreTask::Export() const {
  TensorFile file;
  file.metadata["network"] = "pregrasp score function";
  file.metadata["training"] = Describe();
  file.metadata["contacts"] = config_.contacts.ToJson();
  model_->encoder->Export(file);
  model_->head->Export("score", file);
  return file;
}

}  // namespace pregrasp
