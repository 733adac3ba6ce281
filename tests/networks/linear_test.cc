#include "app/networks/linear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "app/core/error.h"
#include "app/core/rng.h"

namespace pregrasp {
namespace {

std::vector<float> RandomValues(Rng& rng, std::size_t count) {
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(rng.Normal());
  return values;
}

Rows RandomRows(Rng& rng, int rows, int columns) {
  Rows result;
  result.Resize(rows, columns);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) result.row(r)[c] = static_cast<float>(rng.Normal());
  }
  return result;
}

TEST(LinearKernelTest, EveryInstructionSetGivesTheSameBits) {
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    Rng rng(3, RngStream::kTest, trial);
    const int rows = 1 + static_cast<int>(rng.UniformInt(40));
    const int depth = 1 + static_cast<int>(rng.UniformInt(70));
    const int panels = 1 + static_cast<int>(rng.UniformInt(4));
    const auto in = RandomValues(rng, rows * depth);
    const auto weights = RandomValues(rng, depth * panels * kPanel);
    const auto bias = RandomValues(rng, panels * kPanel);
    // The definition, summed in the documented order.
    std::vector<float> expected(rows * panels * kPanel);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < panels * kPanel; ++c) {
        volatile float sum = bias[c];
        for (int k = 0; k < depth; ++k) {
          const float* panel = &weights[(c / kPanel) * depth * kPanel];
          volatile const float product = in[r * depth + k] * panel[k * kPanel + c % kPanel];
          sum = sum + product;
        }
        expected[r * panels * kPanel + c] = sum;
      }
    }
    for (const KernelIsa isa : {KernelIsa::kBaseline, KernelIsa::kAvx2, KernelIsa::kAvx512}) {
      if (!KernelIsaSupported(isa)) continue;
      std::vector<float> out(expected.size());
      MultiplyRows(isa, in.data(), rows, depth, depth, weights.data(), bias.data(), panels,
                   out.data(), panels * kPanel);
      EXPECT_EQ(std::memcmp(out.data(), expected.data(), out.size() * sizeof(float)), 0)
          << KernelIsaName(isa) << " trial " << trial;
    }
  }
}

TEST(LinearTest, IsTheAffineMapOfItsWeights) {
  Rng rng(5);
  const int inputs = 19, outputs = 21;
  const auto weight = RandomValues(rng, inputs * outputs);
  const auto bias = RandomValues(rng, outputs);
  const Linear layer(inputs, outputs, weight, bias);
  const Rows in = RandomRows(rng, 7, inputs);
  Rows out, rectified;
  layer.Apply(in, Activation::kNone, out);
  layer.Apply(in, Activation::kRelu, rectified);
  for (int r = 0; r < 7; ++r) {
    for (int o = 0; o < outputs; ++o) {
      double sum = bias[o];
      for (int i = 0; i < inputs; ++i) sum += double{weight[o * inputs + i]} * in.row(r)[i];
      EXPECT_NEAR(out.row(r)[o], sum, 1e-5);
      EXPECT_EQ(rectified.row(r)[o], std::max(out.row(r)[o], 0.0F));
    }
  }
}

TEST(LinearTest, ARowDoesNotDependOnTheOthers) {
  Rng rng(6);
  const Linear layer(33, 48, RandomValues(rng, 33 * 48), RandomValues(rng, 48));
  const Rows many = RandomRows(rng, 50, 33);
  Rows all, one, single;
  layer.Apply(many, Activation::kRelu, all);
  for (int r = 0; r < 50; ++r) {
    single.Resize(1, 33);
    std::copy_n(many.row(r), 33, single.row(0));
    layer.Apply(single, Activation::kRelu, one);
    EXPECT_EQ(std::memcmp(one.row(0), all.row(r), 48 * sizeof(float)), 0);
  }
}

TEST(LinearTest, WeightsOfAnotherShapeAreRefused) {
  TensorFile file;
  file.tensors["fc.weight"] = MakeTensor<float>({2, 3}, std::vector<float>(6, 1.0F));
  file.tensors["fc.bias"] = MakeTensor<float>({3}, std::vector<float>(3, 1.0F));
  EXPECT_THROW(Linear::Load(file, "fc", 3, 2), InputError);  // its bias
  EXPECT_THROW(Linear::Load(file, "fc", 2, 3), InputError);
  EXPECT_THROW(Linear::Load(file, "fd", 3, 2), InputError);
}

}  // namespace
}  // namespace pregrasp
