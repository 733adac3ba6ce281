#pragma once

#include <string>
#include <vector>

#include "app/networks/linear_kernel.h"
#include "app/networks/safetensors.h"

namespace pregrasp {

/// `columns` rounded up to whole panels.
inline constexpr int PaddedColumns(int columns) { return (columns + kPanel - 1) / kPanel * kPanel; }

/// Rows of numbers, each row padded to whole panels. Resizing keeps the memory, so that a buffer
/// that is used again and again is allocated once; it leaves the content undefined.
class Rows {
 public:
  void Resize(int rows, int columns) {
    rows_ = rows;
    stride_ = PaddedColumns(columns);
    if (data_.size() < static_cast<std::size_t>(rows) * stride_) {
      data_.resize(static_cast<std::size_t>(rows) * stride_);
    }
  }
  int rows() const { return rows_; }
  int stride() const { return stride_; }
  float* row(int r) { return data_.data() + static_cast<std::size_t>(r) * stride_; }
  const float* row(int r) const { return data_.data() + static_cast<std::size_t>(r) * stride_; }

 private:
  std::vector<float> data_;
  int rows_ = 0, stride_ = 0;
};

enum class Activation { kNone, kRelu };

/// A dense layer y = act(W x + b), any normalisation already folded into W and b.
class Linear {
 public:
  Linear() = default;
  /// @param weight  outputs x inputs, row-major (PyTorch's order).
  /// @param bias    outputs.
  Linear(int inputs, int outputs, const std::vector<float>& weight, const std::vector<float>& bias);

  /// Reads NAME.weight and NAME.bias. @throws InputError if they are absent or of another shape.
  static Linear Load(const TensorFile& file, const std::string& name, int inputs, int outputs);

  int inputs() const { return inputs_; }
  int outputs() const { return outputs_; }

  /// Rows of `in` to rows of `out`, which is resized. Columns of `out` beyond outputs() are
  /// padding. Each row's bits are the same whatever other rows are computed with it.
  void Apply(const Rows& in, Activation activation, Rows& out) const;

 private:
  int inputs_ = 0, outputs_ = 0;
  std::vector<float> panels_, bias_;
};

/// Layers one after another, each with the rectifier, except that the last one's is `last`.
class Perceptron {
 public:
  /// Reads NAME.<first>, NAME.<first + 1>, .. for `widths` outputs each.
  static Perceptron Load(const TensorFile& file, const std::string& name, int inputs,
                         const std::vector<int>& widths, Activation last, int first = 0);

  /// The result lies in `a` or `b`; both are scratch otherwise. `in` may be `a`.
  const Rows& Apply(const Rows& in, Rows& a, Rows& b) const;

  int inputs() const { return layers_.front().inputs(); }
  int outputs() const { return layers_.back().outputs(); }

 private:
  std::vector<Linear> layers_;
  Activation last_ = Activation::kRelu;
};

}  // namespace pregrasp
