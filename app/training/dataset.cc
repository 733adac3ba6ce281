#include "app/training/dataset.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/core/gzip.h"
#include "app/core/sha256.h"
#include "app/training/packed_states.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIndexFile = "index.json";

DatasetItem ReadItem(const ItemFolders& folders, std::int64_t index) {
  const fs::path path = folders.Find(index);
  std::vector<DatasetItem> items = ItemsFromTensors(ReadTensors(path));
  if (items.size() != 1 || items[0].index != index) {
    throw InputError(path.string(), "item.index", std::to_string(index), "another item");
  }
  return std::move(items[0]);
}

// What index.json says of one family, or of all.
struct Counts {
  std::int64_t items = 0, contexts = 0, grasps = 0, labels = 0, truths = 0;

  void Add(const DatasetItem& item) {
    ++items;
    contexts += static_cast<std::int64_t>(item.contexts.size());
    grasps += static_cast<std::int64_t>(item.grasps.size());
    labels += static_cast<std::int64_t>(item.labels.size());
    truths += static_cast<std::int64_t>(item.truths.size());
  }
  nlohmann::ordered_json ToJson() const {
    return {{"items", items},
            {"contexts", contexts},
            {"grasps", grasps},
            {"labels", labels},
            {"truths", truths}};
  }
};

}  // namespace

void WriteItem(const ItemFolder& folder, const DatasetItem& item) {
  WriteWholeFile(folder.PathOf(item.index), SerializeTensors(ItemsToTensors({item})));
}

void MergeDataset(const std::vector<fs::path>& folders, std::int64_t count, const fs::path& out,
                  int items_per_shard) {
  PREGRASP_CHECK(!folders.empty() && count > 0 && items_per_shard > 0, count, items_per_shard);
  const ItemFolders sources(folders, kItemExtension, "data set");
  for (std::int64_t i = 0; i < count; ++i) sources.Find(i);  // before anything is written
  fs::create_directories(out);
  Counts total;
  std::map<std::string, Counts> families;
  auto shards = nlohmann::ordered_json::array();
  for (std::int64_t first = 0; first < count; first += items_per_shard) {
    const std::int64_t end = std::min(count, first + items_per_shard);
    std::vector<DatasetItem> items;
    for (std::int64_t i = first; i < end; ++i) {
      items.push_back(ReadItem(sources, i));
      total.Add(items.back());
      families[items.back().family].Add(items.back());
    }
    const std::string name = fmt::format("shard-{:04}.safetensors", shards.size());
    WriteTensors(out / name, ItemsToTensors(items));
    shards.push_back({{"file", name},
                      {"sha256", Sha256OfFile(out / name)},
                      {"first_item", first},
                      {"items", end - first}});
  }
  nlohmann::ordered_json index;
  index["format"] = "pregrasp dataset 2";
  index["description"] = nlohmann::ordered_json::parse(sources.description());
  index["counts"] = total.ToJson();
  for (const auto& [family, counts] : families) index["families"][family] = counts.ToJson();
  index["shards"] = shards;
  WriteWholeFile(out / kIndexFile, index.dump(1) + "\n");
}

Dataset ReadDataset(const fs::path& folder) {
  if (fs::is_regular_file(folder)) {
    std::string bytes = ReadWholeFile(folder);
    if (folder.extension() == ".gz") bytes = Inflate(bytes, folder.string());
    Dataset dataset = UnpackStates(ParseTensors(bytes, folder.string()));
    dataset.hash = Sha256(bytes);
    return dataset;
  }
  const std::string text = ReadWholeFile(folder / kIndexFile);
  Dataset dataset;
  dataset.hash = Sha256(text);
  std::vector<std::pair<std::string, std::string>> shards;
  try {
    const auto index = nlohmann::ordered_json::parse(text);
    if (index.at("format") != "pregrasp dataset 2") throw InputError("", "", "", "");
    dataset.description = index.at("description").dump();
    for (const auto& shard : index.at("shards")) {
      shards.emplace_back(shard.at("file").get<std::string>(),
                          shard.at("sha256").get<std::string>());
    }
  } catch (const std::exception&) {
    throw InputError((folder / kIndexFile).string(), "", "the index of a data set",
                     "something else");
  }
  for (const auto& [name, sum] : shards) {
    if (fs::path(name).filename() != name || Sha256OfFile(folder / name) != sum) {
      throw InputError((folder / name).string(), "", "the shard that index.json names",
                       "other content");
    }
    for (DatasetItem& item : ItemsFromTensors(ReadTensors(folder / name))) {
      dataset.items.push_back(std::move(item));
    }
  }
  return dataset;
}

Dataset ReadDatasets(const std::vector<fs::path>& folders) {
  PREGRASP_CHECK(!folders.empty());
  Dataset all = ReadDataset(folders.front());
  std::string hashes = all.hash;
  for (std::size_t i = 1; i < folders.size(); ++i) {
    Dataset next = ReadDataset(folders[i]);
    hashes += next.hash;
    for (DatasetItem& item : next.items) {
      if (!all.items.empty() && item.P_O.rows() != all.items.front().P_O.rows()) {
        throw InputError(folders[i].string(), "",
                         std::to_string(all.items.front().P_O.rows()) + " points an object",
                         std::to_string(item.P_O.rows()));
      }
      all.items.push_back(std::move(item));
    }
  }
  if (folders.size() > 1) all.hash = Sha256(hashes);
  return all;
}

}  // namespace pregrasp
