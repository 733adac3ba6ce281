#include "app/studies/statistics.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"

namespace pregrasp {

MeanDeviation CalcMeanDeviation(const std::vector<double>& values) {
  MeanDeviation result;
  result.count = static_cast<int>(values.size());
  if (values.empty()) return result;
  double sum = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / result.count;
  result.mean = mean;
  if (result.count < 2) return result;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  result.deviation = std::sqrt(squares / (result.count - 1));
  return result;
}

std::optional<double> CalcMedian(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::pair<double, double> CalcWilsonInterval(int successes, int count) {
  PREGRASP_CHECK(count > 0 && successes >= 0 && successes <= count, successes, count);
  constexpr double kZ = 1.959963984540054;  // of the normal distribution at 97.5 %
  const double n = count, share = successes / n, z2 = kZ * kZ;
  const double centre = (share + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half =
      kZ / (1.0 + z2 / n) * std::sqrt(share * (1.0 - share) / n + z2 / (4.0 * n * n));
  // At 0 and 1 the ends are exact; rounding would miss them.
  return {successes == 0 ? 0.0 : centre - half, successes == count ? 1.0 : centre + half};
}

}  // namespace pregrasp
