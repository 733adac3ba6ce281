#include "app/training/metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/core/check.h"

namespace pregrasp {
namespace {

double MeanOf(const std::vector<double>& values) {
  return values.empty() ? 0.0
                        : std::accumulate(values.begin(), values.end(), 0.0) /
                              static_cast<double>(values.size());
}

std::vector<double> CalcRanks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t k = first; k < end; ++k) {
      ranks[order[k]] = 0.5 * static_cast<double>(first + end - 1);
    }
    first = end;
  }
  return ranks;
}

}  // namespace

double CalcR2(const std::vector<double>& truth, const std::vector<double>& prediction) {
  PREGRASP_CHECK(truth.size() == prediction.size(), truth.size(), prediction.size());
  const double mean = MeanOf(truth);
  double error = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error += (prediction[i] - truth[i]) * (prediction[i] - truth[i]);
    variance += (truth[i] - mean) * (truth[i] - mean);
  }
  return variance > 0.0 ? 1.0 - error / variance : 0.0;
}

double CalcRankCorrelation(const std::vector<double>& a, const std::vector<double>& b) {
  PREGRASP_CHECK(a.size() == b.size(), a.size(), b.size());
  const std::vector<double> ranks_a = CalcRanks(a), ranks_b = CalcRanks(b);
  const double mean = MeanOf(ranks_a);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double x = ranks_a[i] - mean, y = ranks_b[i] - mean;
    ab += x * y;
    aa += x * x;
    bb += y * y;
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

double CalcAuc(const std::vector<double>& truth, const std::vector<double>& prediction) {
  PREGRASP_CHECK(truth.size() == prediction.size(), truth.size(), prediction.size());
  const std::vector<double> ranks = CalcRanks(prediction);
  double sum = 0.0, positives = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] < 0.5) continue;
    sum += ranks[i];
    positives += 1.0;
  }
  const double negatives = static_cast<double>(truth.size()) - positives;
  if (positives == 0.0 || negatives == 0.0) return 0.5;
  return (sum - 0.5 * positives * (positives - 1.0)) / (positives * negatives);
}

double CalcCalibrationError(const std::vector<double>& truth, const std::vector<double>& prediction,
                            int bins) {
  PREGRASP_CHECK(truth.size() == prediction.size() && bins > 0, truth.size(), prediction.size());
  std::vector<std::size_t> order(truth.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return prediction[i] < prediction[j]; });
  double error = 0.0;
  for (int b = 0; b < bins; ++b) {
    const std::size_t first = truth.size() * b / bins, end = truth.size() * (b + 1) / bins;
    double difference = 0.0;
    for (std::size_t k = first; k < end; ++k) difference += prediction[order[k]] - truth[order[k]];
    error += std::abs(difference) / static_cast<double>(std::max<std::size_t>(1, truth.size()));
  }
  return error;
}

std::vector<CalibrationBin> CalcCalibration(const std::vector<double>& truth,
                                            const std::vector<double>& prediction, int bins) {
  PREGRASP_CHECK(truth.size() == prediction.size() && bins > 0, truth.size(), prediction.size());
  std::vector<CalibrationBin> curve(bins);
  for (int b = 0; b < bins; ++b) {
    curve[b].low = static_cast<double>(b) / bins;
    curve[b].high = static_cast<double>(b + 1) / bins;
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    CalibrationBin& bin = curve[std::clamp(static_cast<int>(prediction[i] * bins), 0, bins - 1)];
    ++bin.count;
    bin.mean_prediction += prediction[i];
    bin.mean_truth += truth[i];
  }
  for (CalibrationBin& bin : curve) {
    if (bin.count == 0) continue;
    bin.mean_prediction /= bin.count;
    bin.mean_truth /= bin.count;
  }
  return curve;
}

}  // namespace pregrasp
