#include "app/networks/linear.h"

#include <algorithm>

#include "app/core/check.h"

namespace pregrasp {
namespace {

KernelIsa ActiveIsa() {
  static const KernelIsa isa = BestKernelIsa();
  return isa;
}

}  // namespace

Linear::Linear(int inputs, int outputs, const std::vector<float>& weight,
               const std::vector<float>& bias)
    : inputs_(inputs), outputs_(outputs) {
  PREGRASP_CHECK(inputs > 0 && outputs > 0, inputs, outputs);
  PREGRASP_CHECK(weight.size() == static_cast<std::size_t>(inputs) * outputs, weight.size());
  PREGRASP_CHECK(bias.size() == static_cast<std::size_t>(outputs), bias.size());
  const int padded = PaddedColumns(outputs);
  bias_.assign(padded, 0.0F);
  std::copy(bias.begin(), bias.end(), bias_.begin());
  panels_.assign(static_cast<std::size_t>(padded) * inputs, 0.0F);
  for (int o = 0; o < outputs; ++o) {
    float* panel = panels_.data() + static_cast<std::size_t>(o / kPanel) * inputs * kPanel;
    for (int i = 0; i < inputs; ++i) {
      panel[i * kPanel + o % kPanel] = weight[static_cast<std::size_t>(o) * inputs + i];
    }
  }
}

Linear Linear::Load(const TensorFile& file, const std::string& name, int inputs, int outputs) {
  return {inputs, outputs, file.Get<float>(name + ".weight", {outputs, inputs}),
          file.Get<float>(name + ".bias", {outputs})};
}

void Linear::Apply(const Rows& in, Activation activation, Rows& out) const {
  PREGRASP_CHECK(&in != &out && in.stride() >= inputs_, in.stride(), inputs_);
  out.Resize(in.rows(), outputs_);
  if (in.rows() == 0) return;
  MultiplyRows(ActiveIsa(), in.row(0), in.rows(), in.stride(), inputs_, panels_.data(),
               bias_.data(), PaddedColumns(outputs_) / kPanel, out.row(0), out.stride());
  if (activation == Activation::kRelu) {
    float* values = out.row(0);
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(out.rows()) * out.stride();
    for (std::ptrdiff_t i = 0; i < count; ++i) values[i] = std::max(values[i], 0.0F);
  }
}

Perceptron Perceptron::Load(const TensorFile& file, const std::string& name, int inputs,
                            const std::vector<int>& widths, Activation last, int first) {
  PREGRASP_CHECK(!widths.empty());
  Perceptron perceptron;
  perceptron.last_ = last;
  for (const int width : widths) {
    perceptron.layers_.push_back(
        Linear::Load(file, name + "." + std::to_string(first++), inputs, width));
    inputs = width;
  }
  return perceptron;
}

const Rows& Perceptron::Apply(const Rows& in, Rows& a, Rows& b) const {
  const Rows* source = &in;
  for (const Linear& layer : layers_) {
    Rows& target = source == &a ? b : a;
    layer.Apply(*source, &layer == &layers_.back() ? last_ : Activation::kRelu, target);
    source = &target;
  }
  return *source;
}

}  // namespace pregrasp
