#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/batch/item_folder.h"
#include "app/networks/contact_features.h"
#include "app/networks/grasp_generator.h"
#include "app/networks/safetensors.h"

namespace pregrasp {

/// How far the surroundings are moved away for the feasibility tests behind a label [m]; the
/// first, none at all, is what the planner's own tests use.
inline constexpr std::array<double, 5> kReliefs{0.0, 0.005, 0.010, 0.020, 0.040};
inline constexpr int kNumReliefs = static_cast<int>(kReliefs.size());

/// One pose of an object among surroundings, as the networks see it.
struct ContextRecord {
  std::string kind;     ///< of its scene: "free", "edge tilted wall", ..
  int scene = 0;        ///< number of its scene within the item
  double relief = 0.0;  ///< how far the surroundings were moved away [m]
  RigidTransform X_WO = RigidTransform::Identity();
  VectorX phi;                 ///< at the item's points [m]
  std::vector<bool> occluded;  ///< of the item's points
};

/// A feasible grasp in one context of its item.
struct GraspRecord {
  int context = 0;
  GraspPoints p_OC{};                     ///< of fingers not in `used`: zero
  GraspPoints nhat_O{};                   ///< outward normals there
  std::array<double, kNumFingers> phi{};  ///< to the surroundings, there [m]
  std::array<bool, kNumFingers> used{};
};

/// One answer of the score function that is known: how many of `tries` completions of these
/// contacts were feasible at each relief.
struct LabelRecord {
  int context = 0;
  PlanningContacts contacts;
  int tries = 0;
  std::array<int, kNumReliefs> feasible{};

  /// The label: the mean share over the reliefs.
  double Value() const;
};

/// What contact searches say of contacts in one state (search_labels.h).
struct TruthRecord {
  int context = 0;
  PlanningContacts contacts;
  bool lifted = false;  ///< a grasp with these contacts was found, and lifted
  double relief = 0.0;  ///< share of reliefs at which a found set has room for them and holds
  double room = 0.0;    ///< GraspRoom::CalcWith of them
};

/// An object with all that was found out about it: the unit in which data is made, a pure function
/// of (configuration, seed, index).
struct DatasetItem {
  std::int64_t index = 0;
  std::string family, name;
  double mass = 0.0;                 ///< [kg]
  Vector3 p_OOcm = Vector3::Zero();  ///< centre of mass
  MatrixX3 P_O, N_O;                 ///< cloud and normals; equally many points in all items
  std::vector<ContextRecord> contexts;
  std::vector<GraspRecord> grasps;
  std::vector<LabelRecord> labels;
  std::vector<TruthRecord> truths;
};

/// Items as tensors: tables item.*, context.*, grasp.*, label.*, truth.*, where context.item and
/// grasp.context, label.context, truth.context are rows of the tables before. Lengths, distances
/// and cosines are kept in single precision, poses in double.
TensorFile ItemsToTensors(const std::vector<DatasetItem>& items);

/// @throws InputError if a table is missing, of another shape, or refers to a row that is not.
std::vector<DatasetItem> ItemsFromTensors(const TensorFile& file);

/// Of the files that items are made in (ItemFolder).
inline constexpr const char* kItemExtension = ".safetensors";
/// @param folder  with kItemExtension.
void WriteItem(const ItemFolder& folder, const DatasetItem& item);

/// Puts items 0 .. count - 1, found in any of `folders`, together at `out`: shards of
/// `items_per_shard` items and index.json with the description, counts per family and SHA-256 sums.
/// The bytes depend on the items alone, not on the folders they were made in.
/// @throws InputError if an item is missing or the folders' descriptions differ.
void MergeDataset(const std::vector<std::filesystem::path>& folders, std::int64_t count,
                  const std::filesystem::path& out, int items_per_shard = 64);

struct Dataset {
  std::string description;
  /// SHA-256 of index.json, or of the packed file before gzip: names the data for the weights'
  /// metadata.
  std::string hash;
  std::vector<DatasetItem> items;
};

/// Reads a merged data set, or a file that PackStates made of one, which gzip may have packed
/// further (.gz). @throws InputError for a missing
/// or altered shard.
Dataset ReadDataset(const std::filesystem::path& folder);

/// The items of several one after the other; the hash is that of all hashes, or the only one.
/// @throws InputError also where their clouds differ in size.
Dataset ReadDatasets(const std::vector<std::filesystem::path>& folders);

}  // namespace pregrasp
