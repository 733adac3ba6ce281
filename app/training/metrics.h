#pragma once

#include <string>
#include <vector>

namespace pregrasp {

/// 1 - squared error / variance of `truth`; 0 if that has no variance.
double CalcR2(const std::vector<double>& truth, const std::vector<double>& prediction);

/// Spearman's rank correlation, equal values sharing their mean rank; 0 if either is constant.
double CalcRankCorrelation(const std::vector<double>& a, const std::vector<double>& b);

/// How probable it is that a positive is predicted above a negative (area under the ROC curve, ties
/// counting half); 0.5 if there are none of either.
double CalcAuc(const std::vector<double>& truth, const std::vector<double>& prediction);

/// Expected calibration error: the mean of |mean prediction - mean truth| over `bins` bins of
/// equally many predictions, in order of these; 0 without any.
double CalcCalibrationError(const std::vector<double>& truth, const std::vector<double>& prediction,
                            int bins = 10);

/// One bin of a calibration curve: predictions between low and high.
struct CalibrationBin {
  double low = 0.0, high = 0.0;
  int count = 0;
  double mean_prediction = 0.0, mean_truth = 0.0;
};

/// `bins` equal bins of [0, 1].
std::vector<CalibrationBin> CalcCalibration(const std::vector<double>& truth,
                                            const std::vector<double>& prediction, int bins = 10);

}  // namespace pregrasp
