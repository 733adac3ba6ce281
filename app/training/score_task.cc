#include "app/training/score_task.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/networks/score_function.h"
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

std::function<bool(const TrainingContext&)> HasLabels(LabelSource source) {
  return [source](const TrainingContext& context) {
    return source == LabelSource::kSearch ? !context.truths.empty() : !context.labels.empty();
  };
}

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

LabelSource ParseLabelSource(const std::string& name) {
  for (const LabelSource source : {LabelSource::kSearch, LabelSource::kCompletions}) {
    if (name == LabelSourceName(source)) return source;
  }
  throw InputError("", "source", "search or completions", name);
}

const char* LabelSourceName(LabelSource source) {
  return source == LabelSource::kSearch ? "search" : "completions";
}

ProgressKind ParseProgressKind(const std::string& name) {
  for (const ProgressKind kind : {ProgressKind::kRelief, ProgressKind::kRoom}) {
    if (name == ProgressKindName(kind)) return kind;
  }
  throw InputError("", "progress", "relief or room", name);
}

const char* ProgressKindName(ProgressKind kind) {
  return kind == ProgressKind::kRelief ? "relief" : "room";
}

struct ScoreTask::Model : torch::nn::Module {
  Model(const SetEncoderConfig& encoder_config, const ScoreTaskConfig& config,
        const std::vector<int>& widths, Rng rng) {
    encoder = register_module("encoder", std::make_shared<TrainableEncoder>(encoder_config, rng));
    head = register_module("head", std::make_shared<TrainableHead>(
                                       encoder_config.code_size() +
                                           ContactFeatureCount(config.contacts, encoder_config),
                                       widths, rng));
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
      data_(PrepareTrainingData(dataset, config.encoder.levels, validation_families,
                                HasLabels(config.source))),
      order_(static_cast<std::int64_t>(data_.training.size()), config.seed) {
  config_.encoder = EncoderOf(config);
  model_ = std::make_shared<Model>(config_.encoder, config_, head_widths(),
                                   Rng(config.seed, RngStream::kInitialWeights));
  module_ = model_;
}

std::vector<int> ScoreTask::head_widths() const {
  std::vector<int> widths = config_.hidden_widths;
  widths.push_back(num_outputs());
  return widths;
}

std::vector<ScoreTask::Label> ScoreTask::LabelsOf(const TrainingContext& context) const {
  std::vector<Label> labels;
  if (config_.source == LabelSource::kCompletions) {
    for (const LabelRecord* label : context.labels) {
      labels.push_back({&label->contacts, {static_cast<float>(label->Value())}});
    }
    return labels;
  }
  for (const TruthRecord* truth : context.truths) {
    auto progress = static_cast<float>(truth->relief), other = static_cast<float>(truth->room);
    if (config_.progress == ProgressKind::kRoom) std::swap(progress, other);
    labels.push_back({&truth->contacts, {progress, truth->lifted ? 1.0F : 0.0F, other}});
  }
  return labels;
}

torch::Tensor ScoreTask::CalcLogits(const std::vector<TrainingState>& states,
                                    const std::vector<std::vector<Label>>& labels) {
  const EncoderBatch batch = BuildEncoderBatch(config_.encoder, states);
  QueryBatchBuilder queries(config_.encoder, config_.contacts);
  for (std::size_t s = 0; s < states.size(); ++s) {
    for (const Label& label : labels[s]) {
      queries.Add(batch, static_cast<int>(s), states[s], *label.contacts);
    }
  }
  return model_->head->Apply(
      GatherHeadInputs(model_->encoder->Apply(batch), queries.Build(), config_.contacts));
}

torch::Tensor ScoreTask::CalcLoss(std::int64_t step) {
  std::vector<TrainingState> states;
  std::vector<std::vector<Label>> labels;
  std::vector<float> values, weights;
  Rng rng(config_.seed, RngStream::kBatchNoise, step);
  for (const std::int64_t number : order_.Draw(step, config_.contexts_per_step)) {
    const TrainingContext& context = data_.training[number];
    const double heading = rng.Uniform(0.0, 2.0 * kPi);
    const bool mirrored = config_.mirror && rng.UniformInt(2) == 1;
    Matrix3 R_GO = CalcTrainingFrame(context.context->X_WO.linear(), heading);
    if (mirrored) R_GO = Vector3(-1.0, 1.0, 1.0).asDiagonal() * R_GO;
    states.push_back({context.structure, &context.context->phi, &context.context->occluded, R_GO});
    const std::vector<Label> all = LabelsOf(context);
    labels.emplace_back();
    for (const int i : DrawSubset(static_cast<int>(all.size()), config_.labels_per_context, rng)) {
      labels.back().push_back(all[i]);
      values.insert(values.end(), all[i].values.begin(), all[i].values.begin() + num_outputs());
      for (int k = 0; k < num_outputs(); ++k) {
        weights.push_back(mirrored && k == static_cast<int>(ScoreOutput::kLifted) ? 0.0F : 1.0F);
      }
    }
  }
  const torch::Tensor target = torch::tensor(values).view({-1, num_outputs()});
  return num_outputs() *
         torch::binary_cross_entropy_with_logits(CalcLogits(states, labels), target,
                                                 torch::tensor(weights).view_as(target));
}

ScoreTask::Predictions ScoreTask::Predict(const std::vector<TrainingContext>& contexts) {
  Predictions result;
  constexpr std::size_t kBatch = 32;
  for (std::size_t first = 0; first < contexts.size(); first += kBatch) {
    std::vector<TrainingState> states;
    std::vector<std::vector<Label>> labels;
    for (std::size_t c = first; c < std::min(contexts.size(), first + kBatch); ++c) {
      const TrainingContext& context = contexts[c];
      states.push_back({context.structure, &context.context->phi, &context.context->occluded,
                        CalcTrainingFrame(context.context->X_WO.linear(), 0.0)});
      labels.push_back(LabelsOf(context));
      for (const Label& label : labels.back()) {
        result.truth.push_back(label.values[0]);
        if (num_outputs() > 1) result.lifted.push_back(label.values[1]);
        result.context.push_back(&context);
      }
    }
    const torch::Tensor scores = torch::sigmoid(CalcLogits(states, labels)).contiguous();
    const float* values = scores.data_ptr<float>();
    for (std::int64_t i = 0; i < scores.size(0); ++i, values += num_outputs()) {
      result.prediction.push_back(values[0]);
      if (num_outputs() > 1) result.lifted_prediction.push_back(values[1]);
    }
  }
  return result;
}

Json ScoreTask::EvaluateSome(const Predictions& all,
                             const std::function<bool(const TrainingContext&)>& keep) const {
  std::vector<double> truth, prediction, lifted, lifted_prediction;
  for (std::size_t i = 0; i < all.truth.size(); ++i) {
    if (!keep(*all.context[i])) continue;
    truth.push_back(all.truth[i]);
    prediction.push_back(all.prediction[i]);
    if (all.lifted.empty()) continue;
    lifted.push_back(all.lifted[i]);
    lifted_prediction.push_back(all.lifted_prediction[i]);
  }
  Json metrics{{"labels", truth.size()},
               {"r2", CalcR2(truth, prediction)},
               {"rank_correlation", CalcRankCorrelation(truth, prediction)}};
  if (all.lifted.empty()) return metrics;
  metrics["lifted_share"] = lifted.empty() ? 0.0
                                           : std::accumulate(lifted.begin(), lifted.end(), 0.0) /
                                                 static_cast<double>(lifted.size());
  metrics["auc"] = CalcAuc(lifted, lifted_prediction);
  metrics["calibration_error"] = CalcCalibrationError(lifted, lifted_prediction);
  return metrics;
}

Json ScoreTask::Evaluate() { return EvaluateAll(Predict(data_.validation)); }

Json ScoreTask::EvaluateConstant() const {
  std::array<double, kOutputs> sum{};
  double count = 0.0;
  for (const TrainingContext& context : data_.training) {
    for (const Label& label : LabelsOf(context)) {
      for (int i = 0; i < num_outputs(); ++i) sum[i] += label.values[i];
      count += 1.0;
    }
  }
  Predictions all;
  for (const TrainingContext& context : data_.validation) {
    for (const Label& label : LabelsOf(context)) {
      all.truth.push_back(label.values[0]);
      all.prediction.push_back(sum[0] / count);
      all.context.push_back(&context);
      if (num_outputs() == 1) continue;
      all.lifted.push_back(label.values[1]);
      all.lifted_prediction.push_back(sum[1] / count);
    }
  }
  return EvaluateAll(all);
}

Json ScoreTask::EvaluateAll(const Predictions& all) const {
  Json metrics = EvaluateSome(all, [](const TrainingContext&) { return true; });
  std::set<std::string> families;
  for (const TrainingContext* context : all.context) families.insert(context->item->family);
  for (const std::string& family : families) {
    metrics["families"][family] = EvaluateSome(
        all, [&](const TrainingContext& context) { return context.item->family == family; });
  }
  for (const bool held : {true, false}) {
    metrics[held ? "held" : "not_held"] = EvaluateSome(all, [&](const TrainingContext& context) {
      return (context.context->kind.find("held") != std::string::npos) == held;
    });
  }
  metrics["calibration"] = Json::array();
  const bool two = !all.lifted.empty();
  for (const CalibrationBin& bin : CalcCalibration(two ? all.lifted : all.truth,
                                                   two ? all.lifted_prediction : all.prediction)) {
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
              {"head", head_widths()},
              {"labels", LabelSourceName(config_.source)},
              {"progress", ProgressKindName(config_.progress)},
              {"mirror", config_.mirror},
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
