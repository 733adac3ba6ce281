#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/networks/cloud_structure.h"
#include "app/training/dataset.h"

namespace pregrasp {

/// A context with the structure of its object and what is known in it, ready for batches.
struct TrainingContext {
  const DatasetItem* item = nullptr;
  const ContextRecord* context = nullptr;
  const CloudStructure* structure = nullptr;
  std::vector<const LabelRecord*> labels;
  std::vector<const GraspRecord*> grasps;
  std::vector<const TruthRecord*> truths;
};

/// A data set split by family; the contexts point into it.
struct TrainingData {
  std::shared_ptr<const Dataset> dataset;
  std::vector<CloudStructure> structures;  ///< by item
  std::vector<TrainingContext> training, validation;
};

/// @param keep  which contexts count at all: those with labels, with grasps, or with truths.
/// @param validation_families  held out whole. @throws InputError if the data set has none of one.
TrainingData PrepareTrainingData(std::shared_ptr<const Dataset> dataset,
                                 const std::vector<SetLevelConfig>& levels,
                                 const std::vector<std::string>& validation_families,
                                 const std::function<bool(const TrainingContext&)>& keep);

/// Goes through 0 .. count - 1 in a fresh random order each round: the `batch` numbers of step
/// `step` are a pure function of it and of the seed.
class BatchOrder {
 public:
  BatchOrder(std::int64_t count, std::uint64_t seed) : count_(count), seed_(seed) {}

  std::vector<std::int64_t> Draw(std::int64_t step, int batch);

 private:
  std::int64_t count_;
  std::uint64_t seed_;
  std::int64_t round_ = -1;
  std::vector<std::int64_t> order_;
};

/// `count` of 0 .. n - 1 in random order, all of them if there are fewer.
std::vector<int> DrawSubset(int n, int count, Rng& rng);

}  // namespace pregrasp
