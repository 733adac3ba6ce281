#include "app/networks/linear_kernel.h"

#include <cstddef>

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

template <std::ptrdiff_t kLanes>
struct Packet {
  using Type __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias)) = float;
};

// One multiplication, with sizes in the type that offsets are computed in.
struct Job {
  const float* in;
  std::ptrdiff_t rows, in_stride, depth;
  const float* weights;
  const float* bias;
  std::ptrdiff_t panels;
  float* out;
  std::ptrdiff_t out_stride;
};

// kRows rows from `row` of panel `p`: the accumulators stay in registers over the whole depth.
template <std::ptrdiff_t kLanes, std::ptrdiff_t kRows>
[[gnu::always_inline]] inline void MultiplyBlock(const Job& job, std::ptrdiff_t p,
                                                 std::ptrdiff_t row) {
  using Vector = typename Packet<kLanes>::Type;
  constexpr std::ptrdiff_t kVectors = kPanel / kLanes;
  const float* in = job.in + row * job.in_stride;
  const float* panel = job.weights + p * job.depth * kPanel;
  float* out = job.out + row * job.out_stride + p * kPanel;
  Vector sum[kRows][kVectors];
  for (std::ptrdiff_t r = 0; r < kRows; ++r) {
    for (std::ptrdiff_t v = 0; v < kVectors; ++v) {
      sum[r][v] = *reinterpret_cast<const Vector*>(job.bias + p * kPanel + v * kLanes);
    }
  }
  for (std::ptrdiff_t k = 0; k < job.depth; ++k) {
    for (std::ptrdiff_t r = 0; r < kRows; ++r) {
      const float x = in[r * job.in_stride + k];
      for (std::ptrdiff_t v = 0; v < kVectors; ++v) {
        sum[r][v] += x * *reinterpret_cast<const Vector*>(panel + k * kPanel + v * kLanes);
      }
    }
  }
  for (std::ptrdiff_t r = 0; r < kRows; ++r) {
    for (std::ptrdiff_t v = 0; v < kVectors; ++v) {
      *reinterpret_cast<Vector*>(out + r * job.out_stride + v * kLanes) = sum[r][v];
    }
  }
}

template <std::ptrdiff_t kLanes, std::ptrdiff_t kRows>
[[gnu::always_inline]] inline void MultiplyPanels(const Job& job) {
  for (std::ptrdiff_t p = 0; p < job.panels; ++p) {
    std::ptrdiff_t row = 0;
    for (; row + kRows <= job.rows; row += kRows) MultiplyBlock<kLanes, kRows>(job, p, row);
    for (; row < job.rows; ++row) MultiplyBlock<kLanes, 1>(job, p, row);
  }
}

// The block sizes fill the registers of each set: 16 of 4 floats, 16 of 8, 32 of 16.
void MultiplyBaseline(const Job& job) { MultiplyPanels<4, 3>(job); }

PREGRASP_KERNEL_TARGET("avx2") void MultiplyAvx2(const Job& job) { MultiplyPanels<8, 6>(job); }

PREGRASP_KERNEL_TARGET("avx512f")
void MultiplyAvx512(const Job& job) { MultiplyPanels<16, 12>(job); }

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
  const Job job{in, rows, in_stride, depth, weights, bias, panels, out, out_stride};
  switch (isa) {
    case KernelIsa::kBaseline:
      return MultiplyBaseline(job);
    case KernelIsa::kAvx2:
      return MultiplyAvx2(job);
    case KernelIsa::kAvx512:
      return MultiplyAvx512(job);
  }
}

}  // namespace pregrasp
