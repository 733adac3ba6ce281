#include "app/training/training_run.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "app/core/error.h"
#include "app/core/interrupt.h"
#include "app/core/math.h"
#include "app/networks/safetensors.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;

StoredTensor ToFile(const torch::Tensor& tensor) {
  const torch::Tensor flat = tensor.detach().contiguous();
  std::vector<std::int64_t> shape(flat.sizes().begin(), flat.sizes().end());
  if (flat.scalar_type() == torch::kLong) {
    return MakeTensor<std::int64_t>(
        shape, {flat.data_ptr<std::int64_t>(), flat.data_ptr<std::int64_t>() + flat.numel()});
  }
  return MakeTensor<float>(shape, {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()});
}

void FromFile(const TensorFile& file, const std::string& name, const torch::Tensor& target) {
  const torch::NoGradGuard guard;
  const std::vector<std::int64_t> shape(target.sizes().begin(), target.sizes().end());
  if (target.scalar_type() == torch::kLong) {
    const auto values = file.Get<std::int64_t>(name, shape);
    target.copy_(torch::tensor(values, torch::kLong).reshape(target.sizes()));
  } else {
    const auto values = file.Get<float>(name, shape);
    target.copy_(torch::tensor(values, torch::kFloat).reshape(target.sizes()));
  }
}

// The optimiser's two moments of a parameter; made if it has none yet.
torch::optim::AdamWParamState& StateOf(torch::optim::AdamW& optimizer,
                                       const torch::Tensor& parameter) {
  auto& state = optimizer.state()[c10::guts::to_string(parameter.unsafeGetTensorImpl())];
  if (!state) {
    auto fresh = std::make_unique<torch::optim::AdamWParamState>();
    fresh->step(0);
    fresh->exp_avg(torch::zeros_like(parameter));
    fresh->exp_avg_sq(torch::zeros_like(parameter));
    state = std::move(fresh);
  }
  return static_cast<torch::optim::AdamWParamState&>(*state);
}

// A training under way, and its file.
struct Run {
  TrainingTask& task;
  const TrainingConfig& config;
  std::vector<torch::Tensor> parameters;  // those that are trained
  torch::optim::AdamW optimizer;
  std::int64_t step = 0;
  double loss_sum = 0.0;  // since the last evaluation
  std::int64_t loss_count = 0;
  Json history = Json::array();

  std::string Description() const {
    return Json{{"task", Json::parse(task.Describe())}, {"training", config.ToJson()}}.dump();
  }

  void Save() {
    TensorFile file;
    file.metadata["description"] = Description();
    file.metadata["step"] = std::to_string(step);
    file.metadata["history"] = history.dump();
    file.tensors["loss_sum"] = MakeTensor<double>({}, {loss_sum});
    file.tensors["loss_count"] = MakeTensor<std::int64_t>({}, {loss_count});
    for (const auto& parameter : task.module().named_parameters()) {
      file.tensors["parameter." + parameter.key()] = ToFile(parameter.value());
      if (!parameter.value().requires_grad()) continue;
      const auto& state = StateOf(optimizer, parameter.value());
      file.tensors["moment1." + parameter.key()] = ToFile(state.exp_avg());
      file.tensors["moment2." + parameter.key()] = ToFile(state.exp_avg_sq());
    }
    for (const auto& buffer : task.module().named_buffers()) {
      file.tensors["buffer." + buffer.key()] = ToFile(buffer.value());
    }
    WriteTensors(config.checkpoint, file);
  }

  void Load() {
    const TensorFile file = ReadTensors(config.checkpoint);
    if (file.metadata_at("description") != Description()) {
      throw InputError(config.checkpoint.string(), "", "a checkpoint of this training",
                       "one of another task, data set or configuration");
    }
    step = std::stoll(file.metadata_at("step"));
    history = Json::parse(file.metadata_at("history"));
    loss_sum = file.Get<double>("loss_sum", {})[0];
    loss_count = file.Get<std::int64_t>("loss_count", {})[0];
    for (const auto& parameter : task.module().named_parameters()) {
      FromFile(file, "parameter." + parameter.key(), parameter.value());
      if (!parameter.value().requires_grad()) continue;
      auto& state = StateOf(optimizer, parameter.value());
      state.step(step);
      FromFile(file, "moment1." + parameter.key(), state.exp_avg());
      FromFile(file, "moment2." + parameter.key(), state.exp_avg_sq());
    }
    for (const auto& buffer : task.module().named_buffers()) {
      FromFile(file, "buffer." + buffer.key(), buffer.value());
    }
  }

  double Step() {
    for (auto& group : optimizer.param_groups()) {
      static_cast<torch::optim::AdamWOptions&>(group.options()).lr(CalcLearningRate(config, step));
    }
    task.module().train();
    optimizer.zero_grad();
    const torch::Tensor loss = task.CalcLoss(step);
    loss.backward();
    torch::nn::utils::clip_grad_norm_(parameters, config.max_gradient);
    optimizer.step();
    ++step;
    return loss.item<double>();
  }

  Json Evaluate() {
    const torch::NoGradGuard guard;
    task.module().eval();
    return task.Evaluate();
  }
};

std::vector<torch::Tensor> TrainedParameters(const torch::nn::Module& module) {
  std::vector<torch::Tensor> parameters;
  for (const torch::Tensor& parameter : module.parameters()) {
    if (parameter.requires_grad()) parameters.push_back(parameter);
  }
  return parameters;
}

}  // namespace

void TrainingConfig::Validate() const {
  const auto check = [](bool holds, const char* field, const char* expected) {
    if (!holds) throw InputError("", field, expected, "");
  };
  check(steps >= 1, "steps", "at least 1");
  check(learning_rate > 0.0 && learning_rate <= 1.0, "learning_rate", "above 0, at most 1");
  check(weight_decay >= 0.0 && weight_decay <= 1.0, "weight_decay", "0 to 1");
  check(warm_up >= 0 && warm_up <= steps, "warm_up", "0 to the number of steps");
  check(final_share >= 0.0 && final_share <= 1.0, "final_share", "0 to 1");
  check(max_gradient > 0.0, "max_gradient", "above 0");
  check(evaluate_every >= 1 && checkpoint_every >= 1, "evaluate_every", "at least 1");
}

nlohmann::ordered_json TrainingConfig::ToJson() const {
  return {{"steps", steps},     {"learning_rate", learning_rate},  {"weight_decay", weight_decay},
          {"warm_up", warm_up}, {"final_share", final_share},      {"max_gradient", max_gradient},
          {"seed", seed},       {"evaluate_every", evaluate_every}};
}

double CalcLearningRate(const TrainingConfig& config, std::int64_t step) {
  if (step < config.warm_up) {
    return config.learning_rate * static_cast<double>(step + 1) /
           static_cast<double>(config.warm_up);
  }
  const double progress =
      static_cast<double>(step - config.warm_up) /
      static_cast<double>(std::max<std::int64_t>(1, config.steps - 1 - config.warm_up));
  const double cosine = 0.5 * (1.0 + std::cos(kPi * std::min(1.0, progress)));
  return config.learning_rate * (config.final_share + (1.0 - config.final_share) * cosine);
}

nlohmann::ordered_json RunTraining(TrainingTask& task, const TrainingConfig& config,
                                   const std::function<void(const TrainingProgress&)>& report) {
  config.Validate();
  const std::vector<torch::Tensor> parameters = TrainedParameters(task.module());
  const auto options =
      torch::optim::AdamWOptions(config.learning_rate).weight_decay(config.weight_decay);
  Run run{task, config, parameters, torch::optim::AdamW(parameters, options)};
  const bool checkpoints = !config.checkpoint.empty();
  if (checkpoints && std::filesystem::exists(config.checkpoint)) run.Load();
  while (run.step < config.steps) {
    run.loss_sum += run.Step();
    ++run.loss_count;
    const bool last = run.step == config.steps;
    TrainingProgress progress{run.step, config.steps,
                              run.loss_sum / static_cast<double>(run.loss_count), nullptr};
    if (last || run.step % config.evaluate_every == 0) {
      const Json metrics = run.Evaluate();
      run.history.push_back({{"step", run.step}, {"loss", progress.loss}, {"metrics", metrics}});
      run.loss_sum = 0.0;
      run.loss_count = 0;
      progress.metrics = &metrics;
      report(progress);
    } else {
      report(progress);
    }
    const bool stop = InterruptRequested();
    if (checkpoints && (last || stop || run.step % config.checkpoint_every == 0)) run.Save();
    if (stop && !last) throw Interrupted();
  }
  const torch::NoGradGuard guard;
  task.module().eval();
  return run.history;
}

void PrepareTorch() {
  // One thread: more are not deterministic, and cost more than they give at these sizes. Big blocks
  // are kept instead of going back to the system after every operation.
  at::set_num_threads(1);
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, 64 << 20);
}

}  // namespace pregrasp
