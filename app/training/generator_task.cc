#include "app/training/generator_task.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;
using torch::Tensor;

// Softens the distance's corner at 0: 1 mm in units of 10 cm.
constexpr double kSoftening = 1e-4;

bool HasGrasps(const TrainingContext& context) { return !context.grasps.empty(); }

PlanningContact ContactOf(const GraspRecord& grasp, int finger) {
  return {grasp.p_OC[finger], grasp.nhat_O[finger], grasp.phi[finger]};
}

Tensor DrawNormal(std::int64_t rows, std::int64_t columns, Rng& rng) {
  std::vector<float> values(static_cast<std::size_t>(rows * columns));
  for (float& value : values) value = static_cast<float>(rng.Normal());
  return torch::tensor(values).reshape({rows, columns});
}

// Distances between points (.. x 3).
Tensor CalcDistances(const Tensor& points, const Tensor& target) {
  return ((points - target).pow(2).sum(-1) + kSoftening).sqrt();
}

// Rows of WriteTimeNumbers.
Tensor TimeNumbers(const std::vector<double>& times) {
  std::vector<float> numbers(times.size() * kTimeNumbers);
  for (std::size_t i = 0; i < times.size(); ++i) {
    WriteTimeNumbers(times[i], &numbers[i * kTimeNumbers]);
  }
  return torch::tensor(numbers).reshape({-1, kTimeNumbers});
}

// How often the grasps use which fingers, in FlowConfig's order.
std::array<double, 4> CountFingerSets(const std::vector<TrainingContext>& contexts) {
  std::array<double, 4> counts{};
  double all = 0.0;
  for (const TrainingContext& context : contexts) {
    for (const GraspRecord* grasp : context.grasps) {
      const bool ring = grasp->used[static_cast<int>(Finger::kRing)];
      const bool little = grasp->used[static_cast<int>(Finger::kLittle)];
      ++counts[(little ? 0 : 1) + (ring ? 0 : 2)];
      ++all;
    }
  }
  for (double& count : counts) count /= std::max(1.0, all);
  return counts;
}

}  // namespace

GeneratorDecoder ParseGeneratorDecoder(const std::string& name) {
  for (const auto decoder : {GeneratorDecoder::kFlow, GeneratorDecoder::kAutoencoder}) {
    if (name == GeneratorDecoderName(decoder)) return decoder;
  }
  throw InputError("", "decoder", "flow or autoencoder", name);
}

const char* GeneratorDecoderName(GeneratorDecoder decoder) {
  return decoder == GeneratorDecoder::kFlow ? "flow" : "autoencoder";
}

// What one generator learns from: conditions, and the other fingers' points in frame G from the
// anchor, in units of 1 / position_scale.
struct GeneratorTask::Case {
  QueryBatch queries;
  Tensor target;  // #grasps x fingers x 3
  Tensor mask;    // #grasps x fingers
};

struct GeneratorTask::Model : torch::nn::Module {
  Model(const GeneratorTaskConfig& config, Rng rng) {
    encoder = register_module("encoder", std::make_shared<TrainableEncoder>(config.encoder, rng));
    const int condition =
        config.encoder.code_size() + ContactFeatureCount(config.contacts, config.encoder);
    for (int which = 0; which < 3; ++which) {
      const int fingers = static_cast<int>(PredictedFingers(which).size());
      std::vector<int> widths = config.hidden_widths;
      const bool flow = config.decoder == GeneratorDecoder::kFlow;
      widths.push_back(2 * config.latent_size);
      if (!flow) {
        recognizers[which] =
            register_module(std::string("recognizer_") + kGeneratorNames[which],
                            std::make_shared<TrainableHead>(condition + 4 * fingers, widths, rng));
      }
      widths.back() = 3 * fingers;
      const int taken = flow ? FlowInputCount(fingers) : config.latent_size;
      decoders[which] =
          register_module(std::string("decoder_") + kGeneratorNames[which],
                          std::make_shared<TrainableHead>(condition + taken, widths, rng));
    }
  }

  // A flow's velocity at `points` and `time` (#rows x kTimeNumbers).
  Tensor CalcVelocity(int which, const Tensor& condition, const Tensor& points, const Tensor& mask,
                      const Tensor& time) {
    const Tensor used = points * mask.unsqueeze(2);
    const Tensor out =
        decoders[which]->Apply(torch::cat({condition, used.flatten(1), mask, time}, 1));
    return out.reshape({out.size(0), -1, 3});
  }

  Tensor Decode(int which, const Tensor& condition, const Tensor& latent) {
    const Tensor out = decoders[which]->Apply(torch::cat({condition, latent}, 1));
    return out.reshape({out.size(0), -1, 3});
  }

  // Mean and logarithm of the variance of the latent sample that stands for a grasp.
  std::pair<Tensor, Tensor> Recognize(int which, const Tensor& condition, const Case& sample) {
    const Tensor masked = sample.target * sample.mask.unsqueeze(2);
    const Tensor out =
        recognizers[which]->Apply(torch::cat({condition, masked.flatten(1), sample.mask}, 1));
    const std::int64_t latent = out.size(1) / 2;
    return {out.narrow(1, 0, latent), out.narrow(1, latent, latent).clamp(-12.0, 8.0)};
  }

  std::shared_ptr<TrainableEncoder> encoder;
  std::array<std::shared_ptr<TrainableHead>, 3> recognizers, decoders;
};

GeneratorTask::GeneratorTask(const std::shared_ptr<const Dataset>& dataset,
                             const std::vector<std::string>& validation_families,
                             const GeneratorTaskConfig& config)
    : config_(config),
      validation_families_(validation_families),
      data_(PrepareTrainingData(dataset, config.encoder.levels, validation_families, HasGrasps)),
      order_(static_cast<std::int64_t>(data_.training.size()), config.seed) {
  config_.flow.finger_sets = CountFingerSets(data_.training);
  model_ = std::make_shared<Model>(config_, Rng(config.seed, RngStream::kInitialWeights));
  module_ = model_;
}

std::array<GeneratorTask::Case, 3> GeneratorTask::BuildCases(
    const EncoderBatch& batch, const std::vector<TrainingState>& states,
    const std::vector<std::vector<const GraspRecord*>>& grasps) const {
  std::array<Case, 3> cases;
  for (int which = 0; which < 3; ++which) {
    const std::vector<Finger> fingers = PredictedFingers(which);
    QueryBatchBuilder queries(config_.encoder, config_.contacts);
    std::vector<float> target, mask;
    for (std::size_t s = 0; s < states.size(); ++s) {
      for (const GraspRecord* grasp : grasps[s]) {
        if ((which != 1 && !grasp->used[0]) || (which != 0 && !grasp->used[1])) continue;
        PlanningContacts given;
        if (which != 1) given[0] = ContactOf(*grasp, 0);
        if (which != 0) given[1] = ContactOf(*grasp, 1);
        queries.Add(batch, static_cast<int>(s), states[s], given);
        const Vector3 anchor = CalcAnchor(given);
        for (const Finger finger : fingers) {
          const int f = static_cast<int>(finger);
          const Vector3 p =
              config_.contacts.position_scale * (states[s].R_GO * (grasp->p_OC[f] - anchor));
          for (int axis = 0; axis < 3; ++axis) {
            target.push_back(grasp->used[f] ? static_cast<float>(p[axis]) : 0.0F);
          }
          mask.push_back(grasp->used[f] ? 1.0F : 0.0F);
        }
      }
    }
    const auto width = static_cast<std::int64_t>(fingers.size());
    const std::int64_t n = static_cast<std::int64_t>(mask.size()) / width;
    cases[which] = {queries.Build(), torch::tensor(target).reshape({n, width, 3}),
                    torch::tensor(mask).reshape({n, width})};
  }
  return cases;
}

Tensor GeneratorTask::CalcTipOverlap(int which, const Tensor& points, const Case& sample) const {
  const std::vector<Finger> fingers = PredictedFingers(which);
  const TipSpheres tips;  // of the hand that the data sets are of
  Tensor overlap = torch::zeros({});
  for (std::size_t k = 1; k < fingers.size(); ++k) {
    const auto i = static_cast<std::int64_t>(k);
    if (fingers[k - 1] == Finger::kThumb) continue;  // on the other side of what is held
    const double width =
        config_.contacts.position_scale * (tips.radius(fingers[k - 1]) + tips.radius(fingers[k]));
    const Tensor apart = CalcDistances(points.select(1, i - 1), points.select(1, i));
    const Tensor both = sample.mask.select(1, i - 1) * sample.mask.select(1, i);
    overlap = overlap + ((width - apart).clamp_min(0.0) * both).mean();
  }
  return overlap;
}

Tensor GeneratorTask::CalcLoss(std::int64_t step) {
  std::vector<TrainingState> states;
  std::vector<std::vector<const GraspRecord*>> grasps;
  Rng rng(config_.seed, RngStream::kBatchNoise, step);
  for (const std::int64_t number : order_.Draw(step, config_.contexts_per_step)) {
    const TrainingContext& context = data_.training[number];
    const double heading = rng.Uniform(0.0, 2.0 * kPi);
    states.push_back({context.structure, &context.context->phi, &context.context->occluded,
                      CalcTrainingFrame(context.context->X_WO.linear(), heading)});
    grasps.emplace_back();
    const int count = static_cast<int>(context.grasps.size());
    for (const int i : DrawSubset(count, config_.grasps_per_context, rng)) {
      grasps.back().push_back(context.grasps[i]);
    }
  }
  const EncoderBatch batch = BuildEncoderBatch(config_.encoder, states);
  const TrainableEncoder::Result encoded = model_->encoder->Apply(batch);
  const std::array<Case, 3> cases = BuildCases(batch, states, grasps);
  Tensor loss = torch::zeros({});
  for (int which = 0; which < 3; ++which) {
    const Case& sample = cases[which];
    if (sample.mask.size(0) == 0) continue;
    const Tensor condition = GatherHeadInputs(encoded, sample.queries, config_.contacts);
    loss = loss + (is_flow() ? CalcFlowLoss(which, condition, sample, rng)
                             : CalcAutoencoderLoss(which, condition, sample, rng));
  }
  return loss;
}

Tensor GeneratorTask::CalcAutoencoderLoss(int which, const Tensor& condition, const Case& sample,
                                          Rng& rng) const {
  const auto [mean, log_variance] = model_->Recognize(which, condition, sample);
  const Tensor noise = DrawNormal(mean.size(0), mean.size(1), rng);
  const Tensor points = model_->Decode(which, condition, mean + noise * (0.5 * log_variance).exp());
  const Tensor error =
      (CalcDistances(points, sample.target) * sample.mask).sum() / sample.mask.sum();
  const Tensor divergence =
      0.5 * (mean.pow(2) + log_variance.exp() - 1.0 - log_variance).sum(1).mean();
  return error + config_.kl_weight * divergence +
         config_.spacing_weight * CalcTipOverlap(which, points, sample);
}

Tensor GeneratorTask::CalcFlowLoss(int which, const Tensor& condition, const Case& sample,
                                   Rng& rng) const {
  const std::int64_t n = sample.mask.size(0), width = sample.mask.size(1);
  Tensor loss = torch::zeros({});
  for (int draw = 0; draw < config_.flow_times; ++draw) {
    std::vector<double> times(static_cast<std::size_t>(n));
    for (double& t : times) t = rng.Uniform();
    const Tensor time = TimeNumbers(times);
    const Tensor noise = config_.flow.noise * DrawNormal(n, 3 * width, rng).reshape({n, width, 3});
    const Tensor way = sample.target - noise;
    const Tensor points = noise + time.narrow(1, 0, 1).unsqueeze(2) * way;
    const Tensor velocity = model_->CalcVelocity(which, condition, points, sample.mask, time);
    loss = loss + ((velocity - way).pow(2).sum(2) * sample.mask).sum() / sample.mask.sum();
  }
  return loss / config_.flow_times;
}

Tensor GeneratorTask::DecodeFlow(int which, const Tensor& condition, const Tensor& mask,
                                 const Tensor& noise) const {
  Tensor points = config_.flow.noise * noise * mask.unsqueeze(2);
  for (int step = 0; step < config_.flow.steps; ++step) {
    const std::vector<double> times(static_cast<std::size_t>(mask.size(0)),
                                    static_cast<double>(step) / config_.flow.steps);
    points = points + model_->CalcVelocity(which, condition, points, mask, TimeNumbers(times)) *
                          mask.unsqueeze(2) / config_.flow.steps;
  }
  return points;
}

Tensor GeneratorTask::DrawPoints(int which, const Tensor& condition, const Tensor& mask,
                                 Rng& rng) const {
  const std::int64_t n = mask.size(0), width = mask.size(1);
  if (!is_flow()) return model_->Decode(which, condition, DrawNormal(n, config_.latent_size, rng));
  return DecodeFlow(which, condition, mask, DrawNormal(n, 3 * width, rng).reshape({n, width, 3}));
}

Json GeneratorTask::Evaluate() {
  constexpr std::size_t kBatch = 16;
  constexpr int kSamples = 20;
  std::array<double, 3> reconstruction{}, nearest{}, spread{};
  std::array<double, 3> count{};
  const double unit = 1e3 / config_.contacts.position_scale;
  Rng rng(config_.seed, RngStream::kEvaluationNoise);
  for (std::size_t first = 0; first < data_.validation.size(); first += kBatch) {
    std::vector<TrainingState> states;
    std::vector<std::vector<const GraspRecord*>> grasps;
    for (std::size_t c = first; c < std::min(data_.validation.size(), first + kBatch); ++c) {
      const TrainingContext& context = data_.validation[c];
      states.push_back({context.structure, &context.context->phi, &context.context->occluded,
                        CalcTrainingFrame(context.context->X_WO.linear(), 0.0)});
      grasps.push_back(context.grasps);
      if (grasps.back().size() > 8) grasps.back().resize(8);
    }
    const EncoderBatch batch = BuildEncoderBatch(config_.encoder, states);
    const TrainableEncoder::Result encoded = model_->encoder->Apply(batch);
    const std::array<Case, 3> cases = BuildCases(batch, states, grasps);
    for (int which = 0; which < 3; ++which) {
      const Case& sample = cases[which];
      const std::int64_t n = sample.mask.size(0);
      if (n == 0) continue;
      const Tensor condition = GatherHeadInputs(encoded, sample.queries, config_.contacts);
      const auto mean_error = [&](const Tensor& points) {
        return ((points - sample.target).norm(2, 2) * sample.mask).sum(1) /
               sample.mask.sum(1).clamp_min(1.0);
      };
      if (!is_flow()) {
        const Tensor mean = model_->Recognize(which, condition, sample).first;
        reconstruction[which] +=
            unit * mean_error(model_->Decode(which, condition, mean)).sum().item<double>();
      }
      Tensor best, sum = torch::zeros_like(sample.target),
                   squares = torch::zeros_like(sample.target);
      for (int k = 0; k < kSamples; ++k) {
        const Tensor points = DrawPoints(which, condition, sample.mask, rng);
        const Tensor error = mean_error(points);
        best = k == 0 ? error : torch::minimum(best, error);
        sum += points;
        squares += points.pow(2);
      }
      nearest[which] += unit * best.sum().item<double>();
      const Tensor variance = (squares / kSamples - (sum / kSamples).pow(2)).sum(2).clamp_min(0.0);
      spread[which] += unit * variance.sqrt().mean(1).sum().item<double>();
      count[which] += static_cast<double>(n);
    }
  }
  Json metrics;
  for (int which = 0; which < 3; ++which) {
    const double n = std::max(1.0, count[which]);
    Json& record = metrics[kGeneratorNames[which]];
    record = {{"grasps", count[which]},
              {"nearest_of_20_mm", nearest[which] / n},
              {"spread_mm", spread[which] / n}};
    if (!is_flow()) record["reconstruction_mm"] = reconstruction[which] / n;
  }
  return metrics;
}

std::vector<GraspPoints> GeneratorTask::Decode(const TrainingContext& context,
                                               const PlanningContacts& contacts,
                                               const std::vector<float>& latent) {
  const std::int64_t numbers = is_flow() ? kFlowLatentSize : config_.latent_size;
  const std::int64_t count = static_cast<std::int64_t>(latent.size()) / numbers;
  const TrainingState state{context.structure, &context.context->phi, &context.context->occluded,
                            CalcTrainingFrame(context.context->X_WO.linear(), 0.0)};
  const EncoderBatch batch = BuildEncoderBatch(config_.encoder, {state});
  QueryBatchBuilder queries(config_.encoder, config_.contacts);
  for (std::int64_t i = 0; i < count; ++i) queries.Add(batch, 0, state, contacts);
  const Tensor condition =
      GatherHeadInputs(model_->encoder->Apply(batch), queries.Build(), config_.contacts);
  const int which = GeneratorOf(contacts);
  const std::vector<Finger> fingers = PredictedFingers(which);
  const auto width = static_cast<std::int64_t>(fingers.size());
  const Tensor rows = torch::tensor(latent).reshape({count, numbers});
  std::vector<float> used;
  Tensor points;
  if (is_flow()) {
    for (std::int64_t i = 0; i < count; ++i) {
      const float choice = latent[(i + 1) * numbers - 1];
      for (const float u : ChooseFingers(config_.flow, static_cast<int>(width), choice)) {
        used.push_back(u);
      }
    }
    points = DecodeFlow(which, condition, torch::tensor(used).reshape({count, width}),
                        rows.narrow(1, 0, 3 * width).reshape({count, width, 3}));
  } else {
    used.assign(count * width, 1.0F);
    points = model_->Decode(which, condition, rows);
  }
  points = points.contiguous();
  const Matrix3 R_OG = state.R_GO.transpose() / config_.contacts.position_scale;
  std::vector<GraspPoints> grasps(count);
  const float* p = points.data_ptr<float>();
  const float* u = used.data();
  for (GraspPoints& grasp : grasps) {
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (contacts[f]) grasp[f] = contacts[f]->p_OC;
    }
    for (const Finger finger : fingers) {
      grasp[static_cast<int>(finger)] =
          *u++ > 0.0F ? Vector3(CalcAnchor(contacts) + R_OG * Vector3(p[0], p[1], p[2]))
                      : Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
      p += 3;
    }
  }
  return grasps;
}

std::string GeneratorTask::Describe() const {
  return Json{{"task", "generator"},
              {"dataset", data_.dataset->hash},
              {"validation", validation_families_},
              {"encoder", Json::parse(config_.encoder.ToJson())},
              {"contacts", Json::parse(config_.contacts.ToJson())},
              {"hidden", config_.hidden_widths},
              {"decoder", GeneratorDecoderName(config_.decoder)},
              {"flow", is_flow() ? Json::parse(config_.flow.ToJson()) : Json()},
              {"flow_times", config_.flow_times},
              {"latent_size", config_.latent_size},
              {"kl_weight", config_.kl_weight},
              {"spacing_weight", config_.spacing_weight},
              {"contexts_per_step", config_.contexts_per_step},
              {"grasps_per_context", config_.grasps_per_context},
              {"seed", config_.seed}}
      .dump();
}

TensorFile GeneratorTask::Export() const {
  TensorFile file;
  file.metadata["network"] = "pregrasp grasp generators";
  file.metadata["training"] = Describe();
  file.metadata["contacts"] = config_.contacts.ToJson();
  if (is_flow()) {
    file.metadata["flow"] = config_.flow.ToJson();
  } else {
    file.metadata["latent_size"] = std::to_string(config_.latent_size);
  }
  model_->encoder->Export(file);
  for (int which = 0; which < 3; ++which) {
    model_->decoders[which]->Export(kGeneratorNames[which], file);
  }
  return file;
}

}  // namespace pregrasp
