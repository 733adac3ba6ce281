#pragma once

#include <optional>
#include <utility>
#include <vector>

namespace pregrasp {

/// Mean, and standard deviation of the sample (n - 1); none of too few values.
struct MeanDeviation {
  int count = 0;
  std::optional<double> mean, deviation;
};
MeanDeviation CalcMeanDeviation(const std::vector<double>& values);

/// The middle value, of an even number the mean of the two; none of none.
std::optional<double> CalcMedian(std::vector<double> values);

/// 95 % interval of the probability behind `successes` of `count` > 0 independent trials (Wilson
/// 1927, "Probable inference, the law of succession, and statistical inference"): unlike the normal
/// one it stays within [0, 1] and says something of 0 and of all.
std::pair<double, double> CalcWilsonInterval(int successes, int count);

}  // namespace pregrasp
