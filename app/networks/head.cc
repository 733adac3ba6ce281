#include "app/networks/head.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

Head Head::Load(const TensorFile& file, const std::string& name, int code, int others,
                const std::vector<int>& widths) {
  PREGRASP_CHECK(widths.size() >= 2, widths.size());
  const int inputs = code + others, outputs = widths[0];
  const auto weight = file.Get<float>(name + ".0.weight", {outputs, inputs});
  std::vector<float> code_weight, others_weight;
  for (int o = 0; o < outputs; ++o) {
    const auto row = weight.begin() + static_cast<std::ptrdiff_t>(o) * inputs;
    code_weight.insert(code_weight.end(), row, row + code);
    others_weight.insert(others_weight.end(), row + code, row + inputs);
  }
  Head head;
  head.code_ = Linear(code, outputs, code_weight, file.Get<float>(name + ".0.bias", {outputs}));
  head.others_ = Linear(others, outputs, others_weight, std::vector<float>(outputs, 0.0F));
  head.rest_ = Perceptron::Load(file, name, outputs, {widths.begin() + 1, widths.end()},
                                Activation::kNone, 1);
  return head;
}

std::vector<float> Head::CalcCodeShare(const std::vector<float>& code) const {
  PREGRASP_CHECK(static_cast<int>(code.size()) == code_.inputs(), code.size(), code_.inputs());
  Rows in, out;
  in.Resize(1, code_.inputs());
  std::copy(code.begin(), code.end(), in.row(0));
  code_.Apply(in, Activation::kNone, out);
  return {out.row(0), out.row(0) + out.stride()};
}

const Rows& Head::Apply(const std::vector<float>& share, const Rows& others, Rows& a,
                        Rows& b) const {
  others_.Apply(others, Activation::kNone, a);
  for (int r = 0; r < a.rows(); ++r) {
    float* row = a.row(r);
    for (int c = 0; c < a.stride(); ++c) row[c] = std::max(row[c] + share[c], 0.0F);
  }
  return rest_.Apply(a, a, b);
}

std::vector<int> ReadHeadWidths(const TensorFile& file, const std::string& key) {
  const std::string& text = file.metadata_at(key);
  std::vector<int> widths;
  try {
    widths = nlohmann::json::parse(text).get<std::vector<int>>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(file.where, key, "a list of widths", text);
  }
  const bool plausible = widths.size() >= 2 && widths.size() <= 16 &&
                         std::all_of(widths.begin(), widths.end(),
                                     [](int width) { return width >= 1 && width <= 4096; });
  if (!plausible) throw InputError(file.where, key, "2 to 16 widths of 1 to 4096", text);
  return widths;
}

}  // namespace pregrasp
