#include "app/training/torch_ops.h"

#include <algorithm>
#include <vector>

#include "app/core/check.h"
#include "app/networks/linear.h"

namespace pregrasp {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::Function;
using torch::autograd::variable_list;

// Panels of the matrix whose entry (k, c) is data[k * depth_stride + c * column_stride].
std::vector<float> PackPanels(const float* data, std::int64_t depth, std::int64_t columns,
                              std::int64_t depth_stride, std::int64_t column_stride) {
  const std::int64_t panels = (columns + kPanel - 1) / kPanel;
  std::vector<float> packed(static_cast<std::size_t>(panels * depth * kPanel), 0.0F);
  for (std::int64_t p = 0; p < panels; ++p) {
    const std::int64_t width = std::min<std::int64_t>(kPanel, columns - p * kPanel);
    float* panel = packed.data() + p * depth * kPanel;
    for (std::int64_t k = 0; k < depth; ++k) {
      const float* row = data + k * depth_stride + p * kPanel * column_stride;
      for (std::int64_t c = 0; c < width; ++c) panel[k * kPanel + c] = row[c * column_stride];
    }
  }
  return packed;
}

// in (#rows x depth) times the packed matrix, plus the bias if any: #rows x columns.
Tensor Multiply(const Tensor& in, const std::vector<float>& panels, const float* bias,
                std::int64_t columns) {
  static const KernelIsa isa = BestKernelIsa();
  const int padded = PaddedColumns(static_cast<int>(columns));
  std::vector<float> padded_bias(padded, 0.0F);
  if (bias != nullptr) std::copy_n(bias, columns, padded_bias.begin());
  Tensor out = torch::empty({in.size(0), padded});
  const int depth = static_cast<int>(in.size(1));
  MultiplyRows(isa, in.data_ptr<float>(), static_cast<int>(in.size(0)), depth, depth, panels.data(),
               padded_bias.data(), padded / kPanel, out.data_ptr<float>(), padded);
  return columns == padded ? out : out.narrow(1, 0, columns).contiguous();
}

struct LinearFunction : Function<LinearFunction> {
  static Tensor forward(AutogradContext* context, const Tensor& rows, const Tensor& weight,
                        const Tensor& bias) {
    context->save_for_backward({rows, weight});
    const std::int64_t outputs = weight.size(0), inputs = weight.size(1);
    PREGRASP_CHECK(rows.is_contiguous() && rows.size(1) == inputs, rows.size(1), inputs);
    const auto panels = PackPanels(weight.data_ptr<float>(), inputs, outputs, 1, inputs);
    return Multiply(rows, panels, bias.data_ptr<float>(), outputs);
  }

  static variable_list backward(AutogradContext* context, const variable_list& gradients) {
    const Tensor gradient = gradients[0].contiguous();
    const Tensor rows = context->get_saved_variables()[0];
    const Tensor weight = context->get_saved_variables()[1];
    const std::int64_t outputs = weight.size(0), inputs = weight.size(1), n = rows.size(0);
    Tensor to_rows;
    if (context->needs_input_grad(0)) {
      to_rows = Multiply(gradient, PackPanels(weight.data_ptr<float>(), outputs, inputs, inputs, 1),
                         nullptr, inputs);
    }
    const Tensor to_weight =
        Multiply(gradient.t().contiguous(),
                 PackPanels(rows.data_ptr<float>(), n, inputs, inputs, 1), nullptr, inputs);
    return {to_rows, to_weight, gradient.sum(0)};
  }
};

struct EdgeDifferenceFunction : Function<EdgeDifferenceFunction> {
  static Tensor forward(AutogradContext* context, const Tensor& point, const Tensor& center,
                        const Tensor& source, const Tensor& begin) {
    context->save_for_backward({source, begin});
    context->saved_data["points"] = point.size(0);
    const std::int64_t width = point.size(1);
    PREGRASP_CHECK(point.is_contiguous() && center.is_contiguous());
    Tensor out = torch::empty({source.size(0), width});
    const auto* from = source.data_ptr<std::int32_t>();
    const auto* first = begin.data_ptr<std::int32_t>();
    for (std::int64_t t = 0; t + 1 < begin.size(0); ++t) {
      const float* c = center.data_ptr<float>() + t * width;
      for (std::int64_t e = first[t]; e < first[t + 1]; ++e) {
        const float* p = point.data_ptr<float>() + from[e] * width;
        float* o = out.data_ptr<float>() + e * width;
        for (std::int64_t k = 0; k < width; ++k) o[k] = p[k] - c[k];
      }
    }
    return out;
  }

  static variable_list backward(AutogradContext* context, const variable_list& gradients) {
    const Tensor gradient = gradients[0].contiguous();
    const Tensor source = context->get_saved_variables()[0];
    const Tensor begin = context->get_saved_variables()[1];
    const std::int64_t width = gradient.size(1);
    Tensor to_point = torch::zeros({context->saved_data["points"].toInt(), width});
    Tensor to_center = torch::zeros({begin.size(0) - 1, width});
    const auto* from = source.data_ptr<std::int32_t>();
    const auto* first = begin.data_ptr<std::int32_t>();
    for (std::int64_t t = 0; t + 1 < begin.size(0); ++t) {
      float* c = to_center.data_ptr<float>() + t * width;
      for (std::int64_t e = first[t]; e < first[t + 1]; ++e) {
        const float* g = gradient.data_ptr<float>() + e * width;
        float* p = to_point.data_ptr<float>() + from[e] * width;
        for (std::int64_t k = 0; k < width; ++k) {
          p[k] += g[k];
          c[k] -= g[k];
        }
      }
    }
    return {to_point, to_center, Tensor(), Tensor()};
  }
};

struct SegmentMaxFunction : Function<SegmentMaxFunction> {
  static Tensor forward(AutogradContext* context, const Tensor& values, const Tensor& begin) {
    const std::int64_t targets = begin.size(0) - 1, width = values.size(1);
    PREGRASP_CHECK(values.is_contiguous());
    Tensor out = torch::zeros({targets, width});
    Tensor which = torch::full({targets, width}, -1, torch::kInt);
    const auto* first = begin.data_ptr<std::int32_t>();
    for (std::int64_t t = 0; t < targets; ++t) {
      float* o = out.data_ptr<float>() + t * width;
      auto* w = which.data_ptr<std::int32_t>() + t * width;
      for (std::int32_t e = first[t]; e < first[t + 1]; ++e) {
        const float* v = values.data_ptr<float>() + e * width;
        for (std::int64_t k = 0; k < width; ++k) {
          const bool better = e == first[t] || v[k] > o[k];
          o[k] = better ? v[k] : o[k];
          w[k] = better ? e : w[k];
        }
      }
    }
    context->save_for_backward({which});
    context->saved_data["rows"] = values.size(0);
    return out;
  }

  static variable_list backward(AutogradContext* context, const variable_list& gradients) {
    const Tensor gradient = gradients[0].contiguous();
    const Tensor which = context->get_saved_variables()[0];
    const std::int64_t width = gradient.size(1);
    Tensor to_values = torch::zeros({context->saved_data["rows"].toInt(), width});
    for (std::int64_t t = 0; t < gradient.size(0); ++t) {
      const float* g = gradient.data_ptr<float>() + t * width;
      const auto* w = which.data_ptr<std::int32_t>() + t * width;
      for (std::int64_t k = 0; k < width; ++k) {
        if (w[k] >= 0) to_values.data_ptr<float>()[w[k] * width + k] += g[k];
      }
    }
    return {to_values, Tensor()};
  }
};

}  // namespace

Tensor ApplyLinear(const Tensor& rows, const Tensor& weight, const Tensor& bias) {
  return LinearFunction::apply(rows.contiguous(), weight, bias);
}

Tensor EdgeDifference(const Tensor& point, const Tensor& center, const Edges& edges) {
  return EdgeDifferenceFunction::apply(point.contiguous(), center.contiguous(), edges.source,
                                       edges.begin);
}

Tensor SegmentMax(const Tensor& values, const Tensor& begin) {
  return SegmentMaxFunction::apply(values.contiguous(), begin);
}

}  // namespace pregrasp
