#include "app/networks/set_encoder.h"

#include <algorithm>

#include "app/core/check.h"

namespace pregrasp {
namespace {

// States a task encodes together, for the sake of the layers after the maximum.
constexpr int kChunk = 16;
// Edges that go through a level's layers together; they stay in the cache.
constexpr int kEdgeBlock = 1024;
constexpr int kAxes = 3;

std::string LayerName(const std::string& prefix, std::size_t level, std::size_t layer) {
  return prefix + ".level" + std::to_string(level) + "." + std::to_string(layer);
}

// out[c] = max(out[c], values[c]) from out = 0: the maximum and the rectifier in one.
void TakeMaximum(const float* values, int columns, float* out) {
  for (int c = 0; c < columns; ++c) out[c] = std::max(out[c], values[c]);
}

}  // namespace

// Buffers of one task. The points of the level at hand are rows of (position, features).
struct SetEncoder::Workspace {
  Rows points, next;
  std::vector<char> present, next_present;
  Rows point, centers, shift;    // first layer: per point, and per centroid
  Rows edges, a, b;              // a block of edges
  std::vector<int> edge_center;  // whose edges they are
  int position_stride = 0;
};

SetEncoder SetEncoder::Load(const TensorFile& file, const std::string& prefix) {
  SetEncoder encoder;
  encoder.config_ = SetEncoderConfig::FromJson(file.metadata_at(prefix), file.where);
  int features = 1;  // the signed distance
  for (std::size_t l = 0; l < encoder.config_.levels.size(); ++l) {
    const std::vector<int>& widths = encoder.config_.levels[l].widths;
    const int inputs = kAxes + features;
    const std::string first = LayerName(prefix, l, 0);
    const auto weight = file.Get<float>(first + ".weight", {widths[0], inputs});
    std::vector<float> shift;
    for (std::ptrdiff_t o = 0; o < widths[0]; ++o) {
      const auto row = weight.begin() + o * inputs;
      shift.insert(shift.end(), row, row + kAxes);
    }
    Level level{Linear(inputs, widths[0], weight, file.Get<float>(first + ".bias", {widths[0]})),
                Linear(kAxes, widths[0], shift, std::vector<float>(widths[0], 0.0F)),
                {}};
    for (std::size_t i = 1; i < widths.size(); ++i) {
      level.rest.push_back(Linear::Load(file, LayerName(prefix, l, i), widths[i - 1], widths[i]));
    }
    encoder.levels_.push_back(std::move(level));
    features = widths.back();
  }
  const SetEncoderConfig& config = encoder.config_;
  encoder.global_ = Perceptron::Load(file, prefix + ".global", kAxes + features,
                                     config.global_widths, Activation::kNone);
  encoder.code_ = Perceptron::Load(file, prefix + ".code", config.global_widths.back(),
                                   config.code_widths, Activation::kRelu);
  return encoder;
}

void SetEncoder::ApplyLevel(const Level& level, const SetLevel& graph, Workspace& work) {
  const int count = static_cast<int>(graph.centroids.size());
  const int width = level.point.outputs();
  const int out_width = level.rest.empty() ? width : level.rest.back().outputs();
  level.point.Apply(work.points, Activation::kNone, work.point);
  work.centers.Resize(count, kAxes);
  work.next.Resize(count, kAxes + out_width);
  work.next_present.assign(count, 0);
  for (int i = 0; i < count; ++i) {
    const float* position = work.points.row(graph.centroids[i]);
    std::copy_n(position, kAxes, work.centers.row(i));
    std::copy_n(position, kAxes, work.next.row(i));
    std::fill_n(work.next.row(i) + kAxes, out_width, 0.0F);
  }
  level.shift.Apply(work.centers, Activation::kNone, work.shift);

  int i = 0;
  while (i < count) {
    work.edge_center.clear();
    const int first = i;
    while (i < count && (i == first || static_cast<int>(work.edge_center.size()) < kEdgeBlock)) {
      for (int e = graph.begin[i]; e < graph.begin[i + 1]; ++e) {
        if (work.present[graph.neighbors[e]]) work.edge_center.push_back(i);
      }
      ++i;
    }
    work.edges.Resize(static_cast<int>(work.edge_center.size()), width);
    int row = 0;
    for (int c = first; c < i; ++c) {
      const float* shift = work.shift.row(c);
      for (int e = graph.begin[c]; e < graph.begin[c + 1]; ++e) {
        if (!work.present[graph.neighbors[e]]) continue;
        const float* point = work.point.row(graph.neighbors[e]);
        float* edge = work.edges.row(row++);
        for (int k = 0; k < work.edges.stride(); ++k) edge[k] = std::max(point[k] - shift[k], 0.0F);
      }
    }
    const Rows* out = &work.edges;
    for (const Linear& layer : level.rest) {
      Rows& target = out == &work.a ? work.b : work.a;
      // The last layer's rectifier follows the maximum.
      layer.Apply(*out, &layer == &level.rest.back() ? Activation::kNone : Activation::kRelu,
                  target);
      out = &target;
    }
    for (int e = 0; e < row; ++e) {
      const int center = work.edge_center[e];
      TakeMaximum(out->row(e), out_width, work.next.row(center) + kAxes);
      work.next_present[center] = 1;
    }
  }
  std::swap(work.points, work.next);
  std::swap(work.present, work.next_present);
}

void SetEncoder::EncodeLevels(const CloudStructure& structure, const ObjectState& state,
                              EncodedState& encoded, Workspace& work, float* global) const {
  const int n = structure.size();
  PREGRASP_CHECK(state.phi.size() == 0 || state.phi.size() == n, state.phi.size(), n);
  PREGRASP_CHECK(state.occluded.empty() || static_cast<int>(state.occluded.size()) == n,
                 state.occluded.size(), n);
  PREGRASP_CHECK(structure.levels.size() == levels_.size(), structure.levels.size());
  encoded.R_GO = structure.CalcUprightFrame(state.up_O);
  const Matrix3 R = config_.position_scale * encoded.R_GO;
  work.points.Resize(n, kAxes + 1);
  work.present.assign(n, 1);
  for (int i = 0; i < n; ++i) {
    const Vector3 p = R * (structure.P_O.row(i).transpose() - structure.p_OC);
    float* row = work.points.row(i);
    for (int axis = 0; axis < kAxes; ++axis) row[axis] = static_cast<float>(p[axis]);
    row[kAxes] = config_.ScaledDistance(state.phi.size() ? state.phi[i] : config_.phi_max);
    if (!state.occluded.empty() && state.occluded[i]) work.present[i] = 0;
  }
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    ApplyLevel(levels_[l], structure.levels[l], work);
    if (l > 0) continue;
    encoded.local.Resize(work.points.rows(), config_.local_size());
    encoded.present.clear();
    for (int i = 0; i < work.points.rows(); ++i) {
      std::copy_n(work.points.row(i) + kAxes, config_.local_size(), encoded.local.row(i));
      if (work.present[i]) encoded.present.push_back(i);
    }
  }
  work.edges.Resize(work.points.rows(), global_.inputs());
  int rows = 0;
  for (int i = 0; i < work.points.rows(); ++i) {
    if (work.present[i]) std::copy_n(work.points.row(i), global_.inputs(), work.edges.row(rows++));
  }
  work.edges.Resize(rows, global_.inputs());
  const Rows& out = global_.Apply(work.edges, work.a, work.b);
  std::fill_n(global, global_.outputs(), 0.0F);
  for (int i = 0; i < rows; ++i) TakeMaximum(out.row(i), global_.outputs(), global);
}

void SetEncoder::EncodeChunk(const CloudStructure& structure, const ObjectState* states, int count,
                             EncodedState* encoded) const {
  Workspace work;
  Rows global, a, b;
  global.Resize(count, global_.outputs());
  for (int i = 0; i < count; ++i) {
    EncodeLevels(structure, states[i], encoded[i], work, global.row(i));
  }
  const Rows& code = code_.Apply(global, a, b);
  for (int i = 0; i < count; ++i) {
    encoded[i].code.assign(code.row(i), code.row(i) + config_.code_size());
  }
}

std::vector<EncodedState> SetEncoder::Encode(const CloudStructure& structure,
                                             const std::vector<ObjectState>& states,
                                             ThreadPool& pool) const {
  const int count = static_cast<int>(states.size());
  std::vector<EncodedState> encoded(count);
  pool.ParallelFor((count + kChunk - 1) / kChunk, [&](int chunk, int) {
    const int first = chunk * kChunk;
    EncodeChunk(structure, &states[first], std::min(kChunk, count - first), &encoded[first]);
  });
  return encoded;
}

}  // namespace pregrasp
