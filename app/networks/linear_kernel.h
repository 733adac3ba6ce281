#pragma once

#include <vector>

namespace pregrasp {

/// Width of a panel of weights: outputs are computed this many at a time.
inline constexpr int kPanel = 16;

/// The instruction sets that the kernel is compiled for.
enum class KernelIsa { kBaseline, kAvx2, kAvx512 };

const char* KernelIsaName(KernelIsa isa);

/// Whether this processor can run `isa`, and the best one that it can run.
bool KernelIsaSupported(KernelIsa isa);
KernelIsa BestKernelIsa();

/// out[r, c] = bias[c] + in[r, 0] weight[0, c] + in[r, 1] weight[1, c] + ..., for `rows` rows,
/// each product rounded and added in this order: the result is the same bits for every instruction
/// set, and does not depend on what other rows are computed with it.
/// @param in        rows of `depth` numbers, `in_stride` apart.
/// @param weights   `panels` panels of depth x kPanel, one after another.
/// @param bias      panels x kPanel numbers.
/// @param out       rows of panels x kPanel numbers, `out_stride` apart; apart from `in`.
void MultiplyRows(KernelIsa isa, const float* in, int rows, int in_stride, int depth,
                  const float* weights, const float* bias, int panels, float* out, int out_stride);

}  // namespace pregrasp
