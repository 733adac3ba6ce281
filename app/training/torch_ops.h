#pragma once

#include <torch/torch.h>

namespace pregrasp {

/// Operations of the trainer that libtorch lacks or is slow at on a CPU; each with its gradient.
/// All tensors are contiguous single precision unless said otherwise; all run on one thread and
/// sum in a fixed order.

/// rows W^T + bias, forward and backward through MultiplyRows: 20 times the reference BLAS that
/// Debian's libtorch finds by default, and the same bits on every x86 processor.
/// @param rows    #rows x inputs.
/// @param weight  outputs x inputs.
/// @param bias    outputs.
torch::Tensor ApplyLinear(const torch::Tensor& rows, const torch::Tensor& weight,
                          const torch::Tensor& bias);

/// The edges of one level of grouping, sorted by target: edge e goes from source[e] to the target t
/// with begin[t] <= e < begin[t + 1].
struct Edges {
  torch::Tensor source;  ///< #edges, 32-bit
  torch::Tensor begin;   ///< #targets + 1, 32-bit

  std::int64_t size() const { return source.size(0); }
  std::int64_t targets() const { return begin.size(0) - 1; }
};

/// point[source[e]] - center[target of e] for every edge (#edges x width).
torch::Tensor EdgeDifference(const torch::Tensor& point, const torch::Tensor& center,
                             const Edges& edges);

/// The largest value over each target's edges, column by column (#targets x width); 0 for a target
/// without edges.
torch::Tensor SegmentMax(const torch::Tensor& values, const torch::Tensor& begin);

}  // namespace pregrasp
