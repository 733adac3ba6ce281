#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/training/dataset.h"

namespace pregrasp {
namespace {

// A table under construction: one growing column.
template <typename T>
struct Column {
  std::vector<T> values;

  void Add(double value) { values.push_back(static_cast<T>(value)); }
  void Add(const Vector3& v) {
    for (int axis = 0; axis < 3; ++axis) Add(v[axis]);
  }
  void Add(const MatrixX3& P) {
    for (int i = 0; i < P.rows(); ++i) Add(Vector3(P.row(i)));
  }
};
using Floats = Column<float>;
using Doubles = Column<double>;
using Ints = Column<std::int32_t>;
using Bytes = Column<std::uint8_t>;

// The columns of one contact: position, normal, signed distance.
constexpr int kContactColumns = 7;

void AddContact(const PlanningContact& contact, double phi_none, Floats& column) {
  column.Add(contact.p_OC);
  column.Add(contact.nhat_O);
  column.Add(std::isfinite(contact.phi) ? contact.phi : phi_none);
}

// Stands for "no surroundings" in the file, which keeps finite numbers only [m].
constexpr double kNoSurroundings = 1e3;

class Reader {
 public:
  explicit Reader(const TensorFile& file) : file_(file) {}

  template <typename T>
  std::vector<T> Get(const std::string& name, std::int64_t rows, std::vector<std::int64_t> rest) {
    rest.insert(rest.begin(), rows);
    return file_.Get<T>(name, rest);
  }
  std::int64_t RowsOf(const std::string& name) {
    const StoredTensor& tensor = file_.at(name);
    if (tensor.shape.empty()) throw InputError(file_.where, name, "a table", "a number");
    return tensor.shape[0];
  }
  int Index(std::int32_t value, std::size_t count, const char* name) {
    if (value < 0 || static_cast<std::size_t>(value) >= count) {
      throw InputError(file_.where, name, "a row of another table", std::to_string(value));
    }
    return value;
  }
  std::vector<std::string> Names(const std::string& key) {
    try {
      return nlohmann::json::parse(file_.metadata_at(key)).get<std::vector<std::string>>();
    } catch (const nlohmann::json::exception&) {
      throw InputError(file_.where, key, "a list of names", file_.metadata_at(key));
    }
  }

 private:
  const TensorFile& file_;
};

Vector3 VectorAt(const std::vector<float>& values, std::size_t at) {
  return {values[at], values[at + 1], values[at + 2]};
}

// The `index`-th cloud of many.
MatrixX3 CloudAt(const std::vector<float>& values, std::size_t index, std::size_t points) {
  MatrixX3 P(points, 3);
  for (std::size_t i = 0; i < points; ++i) {
    P.row(static_cast<Eigen::Index>(i)) = VectorAt(values, 3 * (points * index + i)).transpose();
  }
  return P;
}

// The number of `name` in `names`, added if it is new.
int NumberOf(std::vector<std::string>& names, const std::string& name) {
  const auto number = std::find(names.begin(), names.end(), name) - names.begin();
  if (number == std::ssize(names)) names.push_back(name);
  return static_cast<int>(number);
}

struct ItemTable {
  Ints family, name;
  Column<std::int64_t> index;
  Doubles mass;
  Floats com, cloud, normals;
  std::vector<std::string> families, names;
};

struct ContextTable {
  Ints item, kind, scene;
  Doubles pose, relief;
  Floats phi;
  Bytes occluded;
  std::vector<std::string> kinds;
};

void WriteItems(const std::vector<DatasetItem>& items, TensorFile& file) {
  ItemTable table;
  const int points = items.empty() ? 0 : static_cast<int>(items[0].P_O.rows());
  for (const DatasetItem& item : items) {
    PREGRASP_CHECK(item.P_O.rows() == points && item.N_O.rows() == points, item.index);
    table.index.values.push_back(item.index);
    table.family.Add(NumberOf(table.families, item.family));
    table.name.Add(NumberOf(table.names, item.name));
    table.mass.Add(item.mass);
    table.com.Add(item.p_OOcm);
    table.cloud.Add(item.P_O);
    table.normals.Add(item.N_O);
  }
  const auto n = static_cast<std::int64_t>(items.size());
  file.metadata["families"] = nlohmann::json(table.families).dump();
  file.metadata["names"] = nlohmann::json(table.names).dump();
  file.tensors["item.index"] = MakeTensor({n}, table.index.values);
  file.tensors["item.family"] = MakeTensor({n}, table.family.values);
  file.tensors["item.name"] = MakeTensor({n}, table.name.values);
  file.tensors["item.mass"] = MakeTensor({n}, table.mass.values);
  file.tensors["item.com"] = MakeTensor({n, 3}, table.com.values);
  file.tensors["item.cloud"] = MakeTensor({n, points, 3}, table.cloud.values);
  file.tensors["item.normals"] = MakeTensor({n, points, 3}, table.normals.values);
}

void WriteContexts(const std::vector<DatasetItem>& items, TensorFile& file) {
  ContextTable table;
  const int points = items.empty() ? 0 : static_cast<int>(items[0].P_O.rows());
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (const ContextRecord& context : items[i].contexts) {
      PREGRASP_CHECK(context.phi.size() == points, context.phi.size(), points);
      PREGRASP_CHECK(static_cast<int>(context.occluded.size()) == points);
      table.item.Add(static_cast<double>(i));
      table.kind.Add(NumberOf(table.kinds, context.kind));
      table.scene.Add(context.scene);
      table.relief.Add(context.relief);
      // The matrix itself: through a quaternion it would not come back to the last bit.
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
          table.pose.Add(context.X_WO.matrix()(row, column));
        }
      }
      for (int p = 0; p < points; ++p) {
        table.phi.Add(std::min(context.phi[p], kNoSurroundings));
        table.occluded.Add(context.occluded[p] ? 1 : 0);
      }
    }
  }
  const auto n = static_cast<std::int64_t>(table.item.values.size());
  file.metadata["kinds"] = nlohmann::json(table.kinds).dump();
  file.tensors["context.item"] = MakeTensor({n}, table.item.values);
  file.tensors["context.kind"] = MakeTensor({n}, table.kind.values);
  file.tensors["context.scene"] = MakeTensor({n}, table.scene.values);
  file.tensors["context.relief"] = MakeTensor({n}, table.relief.values);
  file.tensors["context.pose"] = MakeTensor({n, 3, 4}, table.pose.values);
  file.tensors["context.phi"] = MakeTensor({n, points}, table.phi.values);
  file.tensors["context.occluded"] = MakeTensor({n, points}, table.occluded.values);
}

void WriteGrasps(const std::vector<DatasetItem>& items, TensorFile& file) {
  Ints context;
  Floats contacts;
  Bytes used;
  int first = 0;
  for (const DatasetItem& item : items) {
    for (const GraspRecord& grasp : item.grasps) {
      context.Add(first + grasp.context);
      for (int f = 0; f < kNumFingers; ++f) {
        AddContact({grasp.p_OC[f], grasp.nhat_O[f], grasp.phi[f]}, kNoSurroundings, contacts);
        used.Add(grasp.used[f] ? 1 : 0);
      }
    }
    first += static_cast<int>(item.contexts.size());
  }
  const auto n = static_cast<std::int64_t>(context.values.size());
  file.tensors["grasp.context"] = MakeTensor({n}, context.values);
  file.tensors["grasp.contacts"] = MakeTensor({n, kNumFingers, kContactColumns}, contacts.values);
  file.tensors["grasp.used"] = MakeTensor({n, kNumFingers}, used.values);
}

void WriteLabels(const std::vector<DatasetItem>& items, TensorFile& file) {
  Ints context, tries, feasible;
  Floats contacts;
  Bytes present;
  int first = 0;
  for (const DatasetItem& item : items) {
    for (const LabelRecord& label : item.labels) {
      context.Add(first + label.context);
      tries.Add(label.tries);
      for (const int count : label.feasible) feasible.Add(count);
      for (const auto& contact : label.contacts) {
        AddContact(contact.value_or(PlanningContact{}), kNoSurroundings, contacts);
        present.Add(contact ? 1 : 0);
      }
    }
    first += static_cast<int>(item.contexts.size());
  }
  const auto n = static_cast<std::int64_t>(context.values.size());
  file.tensors["label.context"] = MakeTensor({n}, context.values);
  file.tensors["label.tries"] = MakeTensor({n}, tries.values);
  file.tensors["label.feasible"] = MakeTensor({n, kNumReliefs}, feasible.values);
  file.tensors["label.contacts"] =
      MakeTensor({n, kNumPlanningFingers, kContactColumns}, contacts.values);
  file.tensors["label.present"] = MakeTensor({n, kNumPlanningFingers}, present.values);
}

void WriteTruths(const std::vector<DatasetItem>& items, TensorFile& file) {
  Ints context;
  Floats contacts, progress;
  Bytes present, lifted;
  int first = 0;
  for (const DatasetItem& item : items) {
    for (const TruthRecord& truth : item.truths) {
      context.Add(first + truth.context);
      lifted.Add(truth.lifted ? 1 : 0);
      progress.Add(truth.relief);
      progress.Add(truth.room);
      for (const auto& contact : truth.contacts) {
        AddContact(contact.value_or(PlanningContact{}), kNoSurroundings, contacts);
        present.Add(contact ? 1 : 0);
      }
    }
    first += static_cast<int>(item.contexts.size());
  }
  const auto n = static_cast<std::int64_t>(context.values.size());
  file.tensors["truth.context"] = MakeTensor({n}, context.values);
  file.tensors["truth.lifted"] = MakeTensor({n}, lifted.values);
  file.tensors["truth.progress"] = MakeTensor({n, 2}, progress.values);
  file.tensors["truth.contacts"] =
      MakeTensor({n, kNumPlanningFingers, kContactColumns}, contacts.values);
  file.tensors["truth.present"] = MakeTensor({n, kNumPlanningFingers}, present.values);
}

// Where each context of the file went: its item and its number there.
struct ContextPlace {
  int item, context;
};

PlanningContact ContactAt(const std::vector<float>& values, std::size_t row) {
  const std::size_t at = row * kContactColumns;
  return {VectorAt(values, at), VectorAt(values, at + 3), values[at + 6]};
}

void ReadItems(Reader& reader, std::vector<DatasetItem>& items, int* points) {
  const std::int64_t n = reader.RowsOf("item.index");
  const auto families = reader.Names("families"), names = reader.Names("names");
  const auto index = reader.Get<std::int64_t>("item.index", n, {});
  const auto family = reader.Get<std::int32_t>("item.family", n, {});
  const auto name = reader.Get<std::int32_t>("item.name", n, {});
  const auto mass = reader.Get<double>("item.mass", n, {});
  const auto com = reader.Get<float>("item.com", n, {3});
  const auto cloud = reader.Get<float>("item.cloud", n, {-1, 3});
  *points = n > 0 ? static_cast<int>(cloud.size() / (3 * n)) : 0;
  const auto normals = reader.Get<float>("item.normals", n, {*points, 3});
  items.resize(n);
  for (std::int64_t i = 0; i < n; ++i) {
    items[i].index = index[i];
    items[i].family = families[reader.Index(family[i], families.size(), "item.family")];
    items[i].name = names[reader.Index(name[i], names.size(), "item.name")];
    items[i].mass = mass[i];
    items[i].p_OOcm = VectorAt(com, 3 * i);
    items[i].P_O = CloudAt(cloud, i, *points);
    items[i].N_O = CloudAt(normals, i, *points);
  }
}

std::vector<ContextPlace> ReadContexts(Reader& reader, std::vector<DatasetItem>& items,
                                       int points) {
  const std::int64_t n = reader.RowsOf("context.item");
  const auto kinds = reader.Names("kinds");
  const auto item = reader.Get<std::int32_t>("context.item", n, {});
  const auto kind = reader.Get<std::int32_t>("context.kind", n, {});
  const auto scene = reader.Get<std::int32_t>("context.scene", n, {});
  const auto relief = reader.Get<double>("context.relief", n, {});
  const auto pose = reader.Get<double>("context.pose", n, {3, 4});
  const auto phi = reader.Get<float>("context.phi", n, {points});
  const auto occluded = reader.Get<std::uint8_t>("context.occluded", n, {points});
  std::vector<ContextPlace> places;
  for (std::int64_t c = 0; c < n; ++c) {
    DatasetItem& owner = items[reader.Index(item[c], items.size(), "context.item")];
    places.push_back({item[c], static_cast<int>(owner.contexts.size())});
    ContextRecord record;
    record.kind = kinds[reader.Index(kind[c], kinds.size(), "context.kind")];
    record.scene = scene[c];
    record.relief = relief[c];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        record.X_WO.matrix()(row, column) = pose[12 * c + (4L * row + column)];
      }
    }
    record.phi.resize(points);
    for (int p = 0; p < points; ++p) {
      record.phi[p] = phi[c * points + p];
      record.occluded.push_back(occluded[c * points + p] != 0);
    }
    owner.contexts.push_back(std::move(record));
  }
  return places;
}

void ReadGrasps(Reader& reader, const std::vector<ContextPlace>& places,
                std::vector<DatasetItem>& items) {
  const std::int64_t n = reader.RowsOf("grasp.context");
  const auto context = reader.Get<std::int32_t>("grasp.context", n, {});
  const auto contacts = reader.Get<float>("grasp.contacts", n, {kNumFingers, kContactColumns});
  const auto used = reader.Get<std::uint8_t>("grasp.used", n, {kNumFingers});
  for (std::int64_t g = 0; g < n; ++g) {
    const ContextPlace& place = places[reader.Index(context[g], places.size(), "grasp.context")];
    GraspRecord record;
    record.context = place.context;
    for (int f = 0; f < kNumFingers; ++f) {
      const PlanningContact contact = ContactAt(contacts, g * kNumFingers + f);
      record.p_OC[f] = contact.p_OC;
      record.nhat_O[f] = contact.nhat_O;
      record.phi[f] = contact.phi;
      record.used[f] = used[g * kNumFingers + f] != 0;
    }
    items[place.item].grasps.push_back(record);
  }
}

void ReadLabels(Reader& reader, const std::vector<ContextPlace>& places,
                std::vector<DatasetItem>& items) {
  const std::int64_t n = reader.RowsOf("label.context");
  const auto context = reader.Get<std::int32_t>("label.context", n, {});
  const auto tries = reader.Get<std::int32_t>("label.tries", n, {});
  const auto feasible = reader.Get<std::int32_t>("label.feasible", n, {kNumReliefs});
  const auto contacts =
      reader.Get<float>("label.contacts", n, {kNumPlanningFingers, kContactColumns});
  const auto present = reader.Get<std::uint8_t>("label.present", n, {kNumPlanningFingers});
  for (std::int64_t l = 0; l < n; ++l) {
    const ContextPlace& place = places[reader.Index(context[l], places.size(), "label.context")];
    LabelRecord record;
    record.context = place.context;
    record.tries = tries[l];
    for (int r = 0; r < kNumReliefs; ++r) record.feasible[r] = feasible[l * kNumReliefs + r];
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const std::size_t row = l * kNumPlanningFingers + f;
      if (present[row]) record.contacts[f] = ContactAt(contacts, row);
    }
    items[place.item].labels.push_back(record);
  }
}

void ReadTruths(Reader& reader, const std::vector<ContextPlace>& places,
                std::vector<DatasetItem>& items) {
  const std::int64_t n = reader.RowsOf("truth.context");
  const auto context = reader.Get<std::int32_t>("truth.context", n, {});
  const auto lifted = reader.Get<std::uint8_t>("truth.lifted", n, {});
  const auto progress = reader.Get<float>("truth.progress", n, {2});
  const auto contacts =
      reader.Get<float>("truth.contacts", n, {kNumPlanningFingers, kContactColumns});
  const auto present = reader.Get<std::uint8_t>("truth.present", n, {kNumPlanningFingers});
  for (std::int64_t t = 0; t < n; ++t) {
    const ContextPlace& place = places[reader.Index(context[t], places.size(), "truth.context")];
    TruthRecord record;
    record.context = place.context;
    record.lifted = lifted[t] != 0;
    record.relief = progress[2 * t];
    record.room = progress[2 * t + 1];
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      const std::size_t row = t * kNumPlanningFingers + f;
      if (present[row]) record.contacts[f] = ContactAt(contacts, row);
    }
    items[place.item].truths.push_back(record);
  }
}

}  // namespace

double LabelRecord::Value() const {
  PREGRASP_CHECK(tries > 0, tries);
  double sum = 0.0;
  for (const int count : feasible) sum += count;
  return sum / (static_cast<double>(tries) * kNumReliefs);
}

TensorFile ItemsToTensors(const std::vector<DatasetItem>& items) {
  TensorFile file;
  file.metadata["format"] = "pregrasp items 2";
  WriteItems(items, file);
  WriteContexts(items, file);
  WriteGrasps(items, file);
  WriteLabels(items, file);
  WriteTruths(items, file);
  return file;
}

std::vector<DatasetItem> ItemsFromTensors(const TensorFile& file) {
  if (file.metadata_at("format") != "pregrasp items 2") {
    throw InputError(file.where, "format", "pregrasp items 2", file.metadata_at("format"));
  }
  Reader reader(file);
  std::vector<DatasetItem> items;
  int points = 0;
  ReadItems(reader, items, &points);
  const std::vector<ContextPlace> places = ReadContexts(reader, items, points);
  ReadGrasps(reader, places, items);
  ReadLabels(reader, places, items);
  ReadTruths(reader, places, items);
  return items;
}

}  // namespace pregrasp
