#pragma once

#include <string>
#include <vector>

#include "app/networks/linear.h"

namespace pregrasp {

/// A perceptron over (code, other numbers): the code's part of the first layer, which is the same
/// for all queries of one state, is computed once.
class Head {
 public:
  /// Reads NAME.0, NAME.1, .. for `widths` outputs each; the last layer has no activation.
  /// @param code, others  how many numbers the first layer takes of each kind, in this order.
  static Head Load(const TensorFile& file, const std::string& name, int code, int others,
                   const std::vector<int>& widths);

  int others() const { return others_.inputs(); }

  /// What the code alone gives to the first layer.
  std::vector<float> CalcCodeShare(const std::vector<float>& code) const;

  /// One row of outputs for each row of other numbers. The result lies in `a` or `b`.
  const Rows& Apply(const std::vector<float>& share, const Rows& others, Rows& a, Rows& b) const;

 private:
  Linear code_, others_;
  Perceptron rest_;
};

/// The widths of a head, kept with its weights as a JSON list. @throws InputError naming the entry.
std::vector<int> ReadHeadWidths(const TensorFile& file, const std::string& key);

}  // namespace pregrasp
