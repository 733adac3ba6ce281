#include "app/training/torch_networks.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {
namespace {

using torch::Tensor;

Tensor ToTensor(const std::vector<std::int32_t>& values) {
  return torch::tensor(values, torch::kInt);
}
Tensor ToTensor(const std::vector<std::int64_t>& values) {
  return torch::tensor(values, torch::kLong);
}
Tensor ToTensor(const std::vector<float>& values, std::vector<std::int64_t> shape) {
  return torch::tensor(values, torch::kFloat).reshape(shape);
}

std::vector<float> ToVector(const Tensor& tensor) {
  const Tensor flat = tensor.detach().contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

std::shared_ptr<TrainableLayer> AddLayer(torch::nn::Module& module, const std::string& name,
                                         int inputs, int outputs, bool normalized, Rng& rng) {
  return module.register_module(name,
                                std::make_shared<TrainableLayer>(inputs, outputs, normalized, rng));
}

// Index lists of one level under construction.
struct EdgeLists {
  std::vector<std::int32_t> source, begin{0};
  std::vector<std::int64_t> centers;

  void Close() { begin.push_back(static_cast<std::int32_t>(source.size())); }
  Edges Build() const { return {ToTensor(source), ToTensor(begin)}; }
};

}  // namespace

TrainableLayer::TrainableLayer(int inputs, int outputs, bool normalized, Rng& rng) {
  std::vector<float> values(static_cast<std::size_t>(inputs) * outputs);
  for (float& value : values) value = static_cast<float>(rng.Normal() * std::sqrt(2.0 / inputs));
  weight_ = register_parameter("weight", ToTensor(values, {outputs, inputs}));
  if (normalized) {
    norm_ = register_module("norm", torch::nn::BatchNorm1d(outputs));
    bias_ = torch::zeros({outputs});
  } else {
    bias_ = register_parameter("bias", torch::zeros({outputs}));
  }
}

Tensor TrainableLayer::Apply(const Tensor& rows) {
  const Tensor product = ApplyLinear(rows, weight_, bias_);
  return norm_ ? norm_(product) : product;
}

Tensor TrainableLayer::Finish(const Tensor& product) {
  return norm_ ? norm_(product) : product + bias_;
}

void TrainableLayer::Export(const std::string& name, TensorFile& file) const {
  Tensor weight = weight_.detach().to(torch::kDouble), bias = bias_.detach().to(torch::kDouble);
  if (norm_) {
    const Tensor variance = norm_->running_var.to(torch::kDouble);
    const Tensor scale =
        norm_->weight.detach().to(torch::kDouble) / (variance + norm_->options.eps()).sqrt();
    weight = weight * scale.unsqueeze(1);
    bias = norm_->bias.detach().to(torch::kDouble) - norm_->running_mean.to(torch::kDouble) * scale;
  }
  file.tensors[name + ".weight"] =
      MakeTensor<float>({weight.size(0), weight.size(1)}, ToVector(weight.to(torch::kFloat)));
  file.tensors[name + ".bias"] =
      MakeTensor<float>({bias.size(0)}, ToVector(bias.to(torch::kFloat)));
}

EncoderBatch BuildEncoderBatch(const SetEncoderConfig& config,
                               const std::vector<TrainingState>& states) {
  const std::size_t num_levels = config.levels.size();
  EncoderBatch batch;
  batch.first_level_size = config.levels.front().centroids;
  std::vector<float> points;
  std::vector<EdgeLists> lists(num_levels);
  EdgeLists global;
  std::int32_t first_point = 0;
  for (std::size_t s = 0; s < states.size(); ++s) {
    const TrainingState& state = states[s];
    const CloudStructure& structure = *state.structure;
    const Matrix3 R = config.position_scale * state.R_GO;
    std::vector<bool> present(structure.size());
    for (int i = 0; i < structure.size(); ++i) {
      const Vector3 p = R * (structure.P_O.row(i).transpose() - structure.p_OC);
      for (int axis = 0; axis < 3; ++axis) points.push_back(static_cast<float>(p[axis]));
      points.push_back(config.ScaledDistance(state.phi->size() ? (*state.phi)[i] : config.phi_max));
      present[i] = state.occluded->empty() || !(*state.occluded)[i];
    }
    // Rows of the level before start at `first`.
    auto first = first_point;
    for (std::size_t l = 0; l < num_levels; ++l) {
      const SetLevel& level = structure.levels[l];
      const auto count = static_cast<int>(level.centroids.size());
      std::vector<bool> next(count, false);
      for (int c = 0; c < count; ++c) {
        for (int e = level.begin[c]; e < level.begin[c + 1]; ++e) {
          if (!present[level.neighbors[e]]) continue;
          lists[l].source.push_back(first + level.neighbors[e]);
          next[c] = true;
        }
        lists[l].Close();
        lists[l].centers.push_back(first + level.centroids[c]);
      }
      present = next;
      first = static_cast<std::int32_t>(s) * count;
      if (l == 0) {
        batch.present.emplace_back();
        for (int c = 0; c < count; ++c) {
          if (present[c]) batch.present.back().push_back(c);
        }
      }
    }
    for (std::size_t c = 0; c < present.size(); ++c) {
      if (present[c]) global.source.push_back(first + static_cast<std::int32_t>(c));
    }
    global.Close();
    first_point += structure.size();
  }
  batch.points = ToTensor(points, {first_point, 4});
  for (const EdgeLists& list : lists) {
    batch.levels.push_back(list.Build());
    batch.centers.push_back(ToTensor(list.centers));
  }
  batch.global = global.Build();
  return batch;
}

TrainableEncoder::TrainableEncoder(const SetEncoderConfig& config, Rng& rng) : config_(config) {
  int features = 1;
  for (std::size_t l = 0; l < config.levels.size(); ++l) {
    levels_.emplace_back();
    int inputs = 3 + features;
    for (const int width : config.levels[l].widths) {
      levels_.back().push_back(
          AddLayer(*this, "level" + std::to_string(l) + "_" + std::to_string(levels_.back().size()),
                   inputs, width, true, rng));
      inputs = width;
    }
    features = inputs;
  }
  int inputs = 3 + features;
  for (const int width : config.global_widths) {
    global_.push_back(
        AddLayer(*this, "global_" + std::to_string(global_.size()), inputs, width, true, rng));
    inputs = width;
  }
  // Few rows: normalising over them would be noise.
  for (const int width : config.code_widths) {
    code_.push_back(
        AddLayer(*this, "code_" + std::to_string(code_.size()), inputs, width, false, rng));
    inputs = width;
  }
}

TrainableEncoder::Result TrainableEncoder::Apply(const EncoderBatch& batch) {
  Result result;
  Tensor position = batch.points.narrow(1, 0, 3).contiguous();
  Tensor features = batch.points.narrow(1, 3, 1);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    TrainableLayer& first = *levels_[l].front();
    const Tensor weight = first.weight();
    const Tensor zero = torch::zeros({weight.size(0)});
    const Tensor centers = position.index_select(0, batch.centers[l]);
    const Tensor point = ApplyLinear(torch::cat({position, features}, 1), weight, zero);
    const Tensor shift = ApplyLinear(centers, weight.narrow(1, 0, 3).contiguous(), zero);
    Tensor edge = torch::relu(first.Finish(EdgeDifference(point, shift, batch.levels[l])));
    for (std::size_t i = 1; i < levels_[l].size(); ++i) {
      edge = torch::relu(levels_[l][i]->Apply(edge));
    }
    features = SegmentMax(edge, batch.levels[l].begin);
    position = centers;
    if (l == 0) result.local = features;
  }
  const Tensor last = torch::cat({position, features}, 1);
  Tensor rows = last.index_select(0, batch.global.source.to(torch::kLong));
  for (const auto& layer : global_) rows = torch::relu(layer->Apply(rows));
  Tensor code = SegmentMax(rows, batch.global.begin);
  for (const auto& layer : code_) code = torch::relu(layer->Apply(code));
  result.code = code;
  return result;
}

void TrainableEncoder::Export(TensorFile& file) const {
  file.metadata["encoder"] = config_.ToJson();
  const auto export_all = [&](const std::string& name, const auto& layers) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      layers[i]->Export("encoder." + name + "." + std::to_string(i), file);
    }
  };
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    export_all("level" + std::to_string(l), levels_[l]);
  }
  export_all("global", global_);
  export_all("code", code_);
}

TrainableHead::TrainableHead(int inputs, const std::vector<int>& widths, Rng& rng)
    : widths_(widths) {
  for (const int width : widths) {
    layers_.push_back(AddLayer(*this, std::to_string(layers_.size()), inputs, width, false, rng));
    inputs = width;
  }
}

Tensor TrainableHead::Apply(Tensor rows) {
  for (const auto& layer : layers_) {
    rows = layer->Apply(rows);
    if (layer != layers_.back()) rows = torch::relu(rows);
  }
  return rows;
}

void TrainableHead::Export(const std::string& name, TensorFile& file) const {
  std::string list = "[";
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    layers_[i]->Export(name + "." + std::to_string(i), file);
    list += (i ? "," : "") + std::to_string(widths_[i]);
  }
  file.metadata[name] = list + "]";
}

void QueryBatchBuilder::Add(const EncoderBatch& batch, int state, const TrainingState& geometry,
                            const PlanningContacts& contacts) {
  constexpr int kNumbers = kNumPlanningFingers * kContactNumbers + kPairNumbers;
  state_.push_back(state);
  numbers_.resize(numbers_.size() + kNumbers);
  WriteContactNumbers(*geometry.structure, geometry.R_GO, encoder_, config_, contacts,
                      &numbers_[numbers_.size() - kNumbers]);
  for (const auto& contact : contacts) {
    std::vector<std::pair<int, float>> near;
    if (contact) {
      near = CalcLocalWeights(*geometry.structure, batch.present[state], contact->p_OC,
                              config_.local_neighbors);
    }
    near.resize(config_.local_neighbors, {0, 0.0F});
    for (const auto& [centroid, weight] : near) {
      index_.push_back(static_cast<std::int64_t>(state) * batch.first_level_size + centroid);
      weight_.push_back(weight);
    }
  }
}

QueryBatch QueryBatchBuilder::Build() const {
  const auto n = static_cast<std::int64_t>(state_.size());
  return {ToTensor(state_), ToTensor(numbers_, {n, -1}), ToTensor(index_),
          ToTensor(weight_, {n, kNumPlanningFingers, config_.local_neighbors})};
}

Tensor GatherHeadInputs(const TrainableEncoder::Result& encoded, const QueryBatch& queries,
                        const ContactFeatureConfig& config) {
  const Tensor code = encoded.code.index_select(0, queries.state);
  if (config.local_neighbors == 0) return torch::cat({code, queries.numbers}, 1);
  const std::int64_t n = queries.state.size(0), width = encoded.local.size(1);
  const Tensor local = encoded.local.index_select(0, queries.local_index)
                           .reshape({n, kNumPlanningFingers, config.local_neighbors, width});
  const Tensor mixed = (local * queries.local_weight.unsqueeze(3)).sum(2);
  return torch::cat({code, queries.numbers, mixed.reshape({n, kNumPlanningFingers * width})}, 1);
}

Matrix3 CalcTrainingFrame(const Matrix3& R_WO, double heading) {
  return Eigen::AngleAxisd(heading, Vector3::UnitZ()).toRotationMatrix() * R_WO;
}

}  // namespace pregrasp
