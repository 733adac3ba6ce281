#include "app/training/training_data.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

TrainingData PrepareTrainingData(std::shared_ptr<const Dataset> dataset,
                                 const std::vector<SetLevelConfig>& levels,
                                 const std::vector<std::string>& validation_families,
                                 const std::function<bool(const TrainingContext&)>& keep) {
  TrainingData data;
  data.dataset = std::move(dataset);
  const std::vector<DatasetItem>& items = data.dataset->items;
  for (const std::string& family : validation_families) {
    if (std::none_of(items.begin(), items.end(),
                     [&](const DatasetItem& item) { return item.family == family; })) {
      throw InputError("", "validation", "a family of the data set", family);
    }
  }
  data.structures.reserve(items.size());
  for (const DatasetItem& item : items) {
    data.structures.push_back(BuildCloudStructure(item.P_O, Matrix3::Identity(), levels));
    std::vector<TrainingContext> contexts;
    for (const ContextRecord& context : item.contexts) {
      contexts.push_back({&item, &context, &data.structures.back(), {}, {}, {}});
    }
    for (const LabelRecord& label : item.labels) contexts[label.context].labels.push_back(&label);
    for (const GraspRecord& grasp : item.grasps) contexts[grasp.context].grasps.push_back(&grasp);
    for (const TruthRecord& truth : item.truths) contexts[truth.context].truths.push_back(&truth);
    const bool held_out = std::find(validation_families.begin(), validation_families.end(),
                                    item.family) != validation_families.end();
    for (TrainingContext& context : contexts) {
      if (keep(context)) {
        (held_out ? data.validation : data.training).push_back(std::move(context));
      }
    }
  }
  if (data.training.empty()) throw InputError("", "", "a data set with something to learn", "none");
  return data;
}

std::vector<std::int64_t> BatchOrder::Draw(std::int64_t step, int batch) {
  std::vector<std::int64_t> numbers;
  for (int i = 0; i < batch; ++i) {
    const std::int64_t position = step * batch + i;
    const std::int64_t round = position / count_;
    if (round != round_) {
      round_ = round;
      order_.resize(count_);
      std::iota(order_.begin(), order_.end(), 0);
      Rng rng(seed_, RngStream::kBatchOrder, round);
      for (std::int64_t k = count_ - 1; k > 0; --k) {
        std::swap(order_[k], order_[rng.UniformInt(static_cast<std::uint32_t>(k + 1))]);
      }
    }
    numbers.push_back(order_[position % count_]);
  }
  return numbers;
}

std::vector<int> DrawSubset(int n, int count, Rng& rng) {
  std::vector<int> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  const int size = std::min(n, count);
  for (int k = 0; k < size; ++k) {
    std::swap(numbers[k], numbers[k + rng.UniformInt(static_cast<std::uint32_t>(n - k))]);
  }
  numbers.resize(size);
  return numbers;
}

}  // namespace pregrasp
