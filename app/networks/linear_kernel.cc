#include "app/networks/linear_kernel.h"

#include <algorithm>

// One source, compiled once per instruction set by GCC's vector extensions. Lanes are different
// outputs, so a wider register changes which sums run side by side but not the order within any;
// the products are not fused (-ffp-contract=off), so that all sets round alike.

namespace pregrasp {
namespace {

#if defined(__x86_64__)
#define PREGRASP_KERNEL_TARGET(isa) __attribute__((target(isa)))
#else
#define PREGRASP_KERNEL_TARGET(isa)
#endif

template <int kLanes>
struct Packet {
  using Type __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias)) = float;
};

// kRows rows of one panel: the accumulators stay in registers over the whole depth.
template <int kLanes, int kRows>
[[gnu::always_inline]] inline void MultiplyBlock(const float* in, int in_stride, int depth,
                                                 const float* panel, const float* bias, float* out,
                                                 int out_stride) {
  using Vector = typename Packet<kLanes>::Type;
  constexpr int kVectors = kPanel / kLanes;
  Vector sum[kRows][kVectors];
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      sum[r][v] = *reinterpret_cast<const Vector*>(bias + v * kLanes);
    }
  }
  for (int k = 0; k < depth; ++k) {
    const float* weight = panel + k * kPanel;
    for (int r = 0; r < kRows; ++r) {
      const float x = in[r * in_stride + k];
      for (int v = 0; v < kVectors; ++v) {
        sum[r][v] += x * *reinterpret_cast<const Vector*>(weight + v * kLanes);
      }
    }
  }
  for (int r = 0; r < kRows; ++r) {
    for (int v = 0; v < kVectors; ++v) {
      *reinterpret_cast<Vector*>(out + r * out_stride + v * kLanes) = sum[r][v];
    }
  }
}

template <int kLanes, int kRows>
[[gnu::always_inline]] inline void MultiplyPanels(const float* in, int rows, int in_stride,
                                                  int depth, const float* weights,
                                                  const float* bias, int panels, float* out,
                                                  int out_stride) {
  for (int p = 0; p < panels; ++p) {
    const float* panel = weights + p * depth * kPanel;
    int r = 0;
    for (; r + kRows <= rows; r += kRows) {
      MultiplyBlock<kLanes, kRows>(in + r * in_stride, in_stride, depth, panel, bias + p * kPanel,
                                   out + r * out_stride + p * kPanel, out_stride);
    }
    for (; r < rows; ++r) {
      MultiplyBlock<kLanes, 1>(in + r * in_stride, in_stride, depth, panel, bias + p * kPanel,
                               out + r * out_stride + p * kPanel, out_stride);
    }
  }
}

// The block sizes fill the registers of each set: 16 of 4 floats, 16 of 8, 32 of 16.
void MultiplyBaseline(const float* in, int rows, int in_stride, int depth, const float* weights,
                      const float* bias, int panels, float* out, int out_stride) {
  MultiplyPanels<4, 3>(in, rows, in_stride, depth, weights, bias, panels, out, out_stride);
}

PREGRASP_KERNEL_TARGET("avx2")
void MultiplyAvx2(const float* in, int rows, int in_stride, int depth, const float* weights,
                  const float* bias, int panels, float* out, int out_stride) {
  MultiplyPanels<8, 6>(in, rows, in_stride, depth, weights, bias, panels, out, out_stride);
}

PREGRASP_KERNEL_TARGET("avx512f")
void MultiplyAvx512(const float* in, int rows, int in_stride, int depth, const float* weights,
                    const float* bias, int panels, float* out, int out_stride) {
  MultiplyPanels<16, 12>(in, rows, in_stride, depth, weights, bias, panels, out, out_stride);
}

}  // namespace

const char* KernelIsaName(KernelIsa isa) {
  switch (isa) {
    case KernelIsa::kBaseline:
      return "baseline";
    case KernelIsa::kAvx2:
      return "AVX2";
    case KernelIsa::kAvx512:
      return "AVX-512";
  }
  return "";
}

bool KernelIsaSupported(KernelIsa isa) {
  if (isa == KernelIsa::kBaseline) return true;
#if defined(__x86_64__)
  return isa == KernelIsa::kAvx2 ? __builtin_cpu_supports("avx2")
                                 : __builtin_cpu_supports("avx512f");
#else
  return false;
#endif
}

KernelIsa BestKernelIsa() {
  for (const KernelIsa isa : {KernelIsa::kAvx512, KernelIsa::kAvx2}) {
    if (KernelIsaSupported(isa)) return isa;
  }
  return KernelIsa::kBaseline;
}

void MultiplyRows(KernelIsa isa, const float* in, int rows, int in_stride, int depth,
                  const float* weights, const float* bias, int panels, float* out, int out_stride) {
  switch (isa) {
    case KernelIsa::kBaseline:
      return MultiplyBaseline(in, rows, in_stride, depth, weights, bias, panels, out, out_stride);
    case KernelIsa::kAvx2:
      return MultiplyAvx2(in, rows, in_stride, depth, weights, bias, panels, out, out_stride);
    case KernelIsa::kAvx512:
      return MultiplyAvx512(in, rows, in_stride, depth, weights, bias, panels, out, out_stride);
  }
}

}  // namespace pregrasp
