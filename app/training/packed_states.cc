#include "app/training/packed_states.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

using Json = nlohmann::ordered_json;
using PackedBytes = std::vector<std::uint8_t>;

constexpr const char* kFormat = "pregrasp packed states 1";
constexpr double kPhiMin = -0.02, kPhiMax = 0.10;  // [m]
constexpr double kByte = 255.0, kWord = 65535.0;

std::uint8_t ToByte(double share) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * kByte));
}
std::uint8_t PhiToByte(double phi) { return ToByte((phi - kPhiMin) / (kPhiMax - kPhiMin)); }
double PhiFromByte(std::uint8_t byte) { return kPhiMin + (kPhiMax - kPhiMin) * byte / kByte; }

// The octahedral map (Meyer et al., "On floating-point normal vectors", 2010).
void AddNormal(const Vector3& nhat, PackedBytes& bytes) {
  const double sum = nhat.cwiseAbs().sum();
  Vector2 e = sum > 0.0 ? Vector2(nhat.head<2>() / sum) : Vector2::Zero();
  if (nhat.z() < 0.0) {
    const Vector2 signs(e.x() < 0.0 ? -1.0 : 1.0, e.y() < 0.0 ? -1.0 : 1.0);
    e = (Vector2::Ones() - Vector2(std::abs(e.y()), std::abs(e.x()))).cwiseProduct(signs);
  }
  for (int axis = 0; axis < 2; ++axis) bytes.push_back(ToByte(0.5 + 0.5 * e[axis]));
}
Vector3 NormalAt(const PackedBytes& bytes, std::size_t at) {
  const Vector2 e(2.0 * bytes[at] / kByte - 1.0, 2.0 * bytes[at + 1] / kByte - 1.0);
  Vector3 n(e.x(), e.y(), 1.0 - std::abs(e.x()) - std::abs(e.y()));
  if (n.z() < 0.0) {
    n.x() = (1.0 - std::abs(e.y())) * (e.x() < 0.0 ? -1.0 : 1.0);
    n.y() = (1.0 - std::abs(e.x())) * (e.y() < 0.0 ? -1.0 : 1.0);
  }
  return n.normalized();
}

// Places in a box, 16 bits an axis, the high byte first.
struct Box16 {
  Vector3 low, size;

  void Add(const Vector3& p, PackedBytes& bytes) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double share = size[axis] > 0.0 ? (p[axis] - low[axis]) / size[axis] : 0.0;
      const auto word = static_cast<unsigned>(std::lround(std::clamp(share, 0.0, 1.0) * kWord));
      bytes.push_back(static_cast<std::uint8_t>(word >> 8));
      bytes.push_back(static_cast<std::uint8_t>(word & 255U));
    }
  }
  Vector3 At(const PackedBytes& bytes, std::size_t at) const {
    Vector3 p;
    for (int axis = 0; axis < 3; ++axis, at += 2) {
      p[axis] = low[axis] + size[axis] * (256.0 * bytes[at] + bytes[at + 1]) / kWord;
    }
    return p;
  }
};

// Around the cloud and all contacts, in numbers of single precision: as the file has them.
Box16 BoxOf(const DatasetItem& item) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < item.P_O.rows(); ++i) box.extend(Vector3(item.P_O.row(i)));
  for (const TruthRecord& truth : item.truths) {
    for (const auto& contact : truth.contacts) {
      if (contact) box.extend(contact->p_OC);
    }
  }
  constexpr double kRound = 1e-6;  // [m]
  const Vector3 low = (box.min().array() - kRound).cast<float>().cast<double>();
  const Vector3 size = (box.max() - low + Vector3::Constant(kRound)).cast<float>().cast<double>();
  return {low, size};
}

int NumberOfName(std::vector<std::string>& names, const std::string& name) {
  const auto number = std::find(names.begin(), names.end(), name) - names.begin();
  if (number == std::ssize(names)) names.push_back(name);
  return static_cast<int>(number);
}

struct Tables {
  std::vector<std::string> families, names, kinds;
  std::vector<std::int64_t> index;
  std::vector<std::int32_t> family, name, contexts, kind, scene, truths;
  std::vector<float> mass, com, box, pose;
  PackedBytes cloud, normals, phi, occluded, bits, progress, places, contact_normals, contact_phi;
};

void AddContext(const ContextRecord& context, Tables& t) {
  t.kind.push_back(NumberOfName(t.kinds, context.kind));
  t.scene.push_back(context.scene);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      t.pose.push_back(static_cast<float>(context.X_WO.matrix()(row, column)));
    }
  }
  for (Eigen::Index p = 0; p < context.phi.size(); ++p) t.phi.push_back(PhiToByte(context.phi[p]));
  for (std::size_t p = 0; p < context.occluded.size(); p += 8) {
    unsigned byte = 0;
    for (std::size_t b = 0; b < 8 && p + b < context.occluded.size(); ++b) {
      if (context.occluded[p + b]) byte |= 1U << b;
    }
    t.occluded.push_back(static_cast<std::uint8_t>(byte));
  }
}

void AddTruth(const TruthRecord& truth, const Box16& box, Tables& t) {
  unsigned bits = truth.lifted ? 4U : 0U;
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    const PlanningContact contact =
        truth.contacts[f].value_or(PlanningContact{box.low, Vector3::UnitZ(), kPhiMin});
    if (truth.contacts[f]) bits |= 1U << f;
    box.Add(contact.p_OC, t.places);
    AddNormal(contact.nhat_O, t.contact_normals);
    t.contact_phi.push_back(PhiToByte(contact.phi));
  }
  t.bits.push_back(static_cast<std::uint8_t>(bits));
  t.progress.push_back(ToByte(truth.relief));
  t.progress.push_back(ToByte(truth.room));
}

void AddItem(const DatasetItem& item, Tables& t) {
  const Box16 box = BoxOf(item);
  t.index.push_back(item.index);
  t.family.push_back(NumberOfName(t.families, item.family));
  t.name.push_back(NumberOfName(t.names, item.name));
  t.mass.push_back(static_cast<float>(item.mass));
  for (int axis = 0; axis < 3; ++axis) t.com.push_back(static_cast<float>(item.p_OOcm[axis]));
  for (const Vector3& v : {box.low, box.size}) {
    for (int axis = 0; axis < 3; ++axis) t.box.push_back(static_cast<float>(v[axis]));
  }
  for (Eigen::Index i = 0; i < item.P_O.rows(); ++i) {
    box.Add(item.P_O.row(i), t.cloud);
    AddNormal(item.N_O.row(i), t.normals);
  }
  t.contexts.push_back(static_cast<std::int32_t>(item.contexts.size()));
  std::vector<std::int32_t> counts(item.contexts.size(), 0);
  for (const TruthRecord& truth : item.truths) ++counts[truth.context];
  for (std::size_t c = 0; c < item.contexts.size(); ++c) {
    AddContext(item.contexts[c], t);
    t.truths.push_back(counts[c]);
    for (const TruthRecord& truth : item.truths) {
      if (truth.context == static_cast<int>(c)) AddTruth(truth, box, t);
    }
  }
}

class Unpacker {
 public:
  explicit Unpacker(const TensorFile& file) : file_(file) {
    if (file.metadata_at("format") != kFormat) {
      throw InputError(file.where, "format", kFormat, file.metadata_at("format"));
    }
    points_ = Number("points");
    t_.families = Names("families");
    t_.names = Names("names");
    t_.kinds = Names("kinds");
    t_.index = file.Get<std::int64_t>("item.index", {-1});
    const auto n = static_cast<std::int64_t>(t_.index.size());
    t_.family = file.Get<std::int32_t>("item.family", {n});
    t_.name = file.Get<std::int32_t>("item.name", {n});
    t_.mass = file.Get<float>("item.mass", {n});
    t_.com = file.Get<float>("item.com", {n, 3});
    t_.box = file.Get<float>("item.box", {n, 6});
    t_.cloud = file.Get<std::uint8_t>("item.cloud", {n, points_, 6});
    t_.normals = file.Get<std::uint8_t>("item.normals", {n, points_, 2});
    t_.contexts = file.Get<std::int32_t>("item.contexts", {n});
    const std::int64_t c = Sum(t_.contexts, "item.contexts");
    t_.kind = file.Get<std::int32_t>("context.kind", {c});
    t_.scene = file.Get<std::int32_t>("context.scene", {c});
    t_.pose = file.Get<float>("context.pose", {c, 3, 4});
    t_.phi = file.Get<std::uint8_t>("context.phi", {c, points_});
    t_.occluded = file.Get<std::uint8_t>("context.occluded", {c, (points_ + 7) / 8});
    t_.truths = file.Get<std::int32_t>("context.truths", {c});
    const std::int64_t m = Sum(t_.truths, "context.truths");
    t_.bits = file.Get<std::uint8_t>("truth.bits", {m});
    t_.progress = file.Get<std::uint8_t>("truth.progress", {m, 2});
    t_.places = file.Get<std::uint8_t>("truth.places", {m, kNumPlanningFingers, 6});
    t_.contact_normals = file.Get<std::uint8_t>("truth.normals", {m, kNumPlanningFingers, 2});
    t_.contact_phi = file.Get<std::uint8_t>("truth.phi", {m, kNumPlanningFingers});
  }

  std::vector<DatasetItem> Items() {
    std::vector<DatasetItem> items;
    for (std::size_t i = 0; i < t_.index.size(); ++i) items.push_back(ItemAt(i));
    return items;
  }

 private:
  std::vector<std::string> Names(const char* key) const {
    try {
      return Json::parse(file_.metadata_at(key)).get<std::vector<std::string>>();
    } catch (const nlohmann::json::exception&) {
      throw InputError(file_.where, key, "a list of names", file_.metadata_at(key));
    }
  }
  std::int64_t Number(const char* key) const {
    const std::string& text = file_.metadata_at(key);
    constexpr std::size_t kMostDigits = 6;
    const bool digits = !text.empty() && text.size() <= kMostDigits &&
                        text.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) throw InputError(file_.where, key, "a number of points", text);
    return std::stoll(text);
  }
  std::int64_t Sum(const std::vector<std::int32_t>& counts, const char* name) const {
    for (const std::int32_t count : counts) {
      if (count < 0) throw InputError(file_.where, name, "counts", std::to_string(count));
    }
    return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  }
  const std::string& Name(const std::vector<std::string>& names, std::int32_t number,
                          const char* table) const {
    if (number < 0 || number >= std::ssize(names)) {
      throw InputError(file_.where, table, "a name's number", std::to_string(number));
    }
    return names[number];
  }

  DatasetItem ItemAt(std::size_t i) {
    DatasetItem item;
    item.index = t_.index[i];
    item.family = Name(t_.families, t_.family[i], "item.family");
    item.name = Name(t_.names, t_.name[i], "item.name");
    item.mass = t_.mass[i];
    item.p_OOcm = Vector3(t_.com[3 * i], t_.com[3 * i + 1], t_.com[3 * i + 2]);
    const float* b = &t_.box[6 * i];
    const Box16 box{{b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
    item.P_O.resize(points_, 3);
    item.N_O.resize(points_, 3);
    for (std::int64_t p = 0; p < points_; ++p) {
      const std::size_t at = i * points_ + p;
      item.P_O.row(p) = box.At(t_.cloud, 6 * at).transpose();
      item.N_O.row(p) = NormalAt(t_.normals, 2 * at).transpose();
    }
    for (int c = 0; c < t_.contexts[i]; ++c, ++context_) {
      item.contexts.push_back(ContextAt(context_));
      for (int k = 0; k < t_.truths[context_]; ++k, ++truth_) {
        item.truths.push_back(TruthAt(truth_, c, box));
      }
    }
    return item;
  }

  ContextRecord ContextAt(std::size_t c) const {
    ContextRecord context;
    context.kind = Name(t_.kinds, t_.kind[c], "context.kind");
    context.scene = t_.scene[c];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        context.X_WO.matrix()(row, column) = t_.pose[12 * c + 4 * row + column];
      }
    }
    context.phi.resize(points_);
    const std::size_t bytes = (points_ + 7) / 8;
    for (std::int64_t p = 0; p < points_; ++p) {
      context.phi[p] = PhiFromByte(t_.phi[c * points_ + p]);
      context.occluded.push_back((t_.occluded[c * bytes + p / 8] >> (p % 8) & 1) != 0);
    }
    return context;
  }

  TruthRecord TruthAt(std::size_t k, int context, const Box16& box) const {
    TruthRecord truth;
    truth.context = context;
    truth.lifted = (t_.bits[k] & 4) != 0;
    truth.relief = t_.progress[2 * k] / kByte;
    truth.room = t_.progress[2 * k + 1] / kByte;
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if ((t_.bits[k] >> f & 1) == 0) continue;
      const std::size_t at = kNumPlanningFingers * k + f;
      truth.contacts[f] =
          PlanningContact{box.At(t_.places, 6 * at), NormalAt(t_.contact_normals, 2 * at),
                          PhiFromByte(t_.contact_phi[at])};
    }
    return truth;
  }

  const TensorFile& file_;
  Tables t_;
  std::int64_t points_ = 0;
  std::size_t context_ = 0, truth_ = 0;
};

}  // namespace

TensorFile PackStates(const Dataset& dataset) {
  Tables t;
  const std::int64_t points = dataset.items.empty() ? 0 : dataset.items.front().P_O.rows();
  for (const DatasetItem& item : dataset.items) {
    PREGRASP_CHECK(item.P_O.rows() == points, item.index);
    AddItem(item, t);
  }
  const auto n = static_cast<std::int64_t>(t.index.size());
  const auto c = static_cast<std::int64_t>(t.kind.size());
  const auto m = static_cast<std::int64_t>(t.bits.size());
  TensorFile file;
  file.metadata["format"] = kFormat;
  file.metadata["description"] = dataset.description;
  file.metadata["points"] = std::to_string(points);
  file.metadata["families"] = Json(t.families).dump();
  file.metadata["names"] = Json(t.names).dump();
  file.metadata["kinds"] = Json(t.kinds).dump();
  file.tensors["item.index"] = MakeTensor({n}, t.index);
  file.tensors["item.family"] = MakeTensor({n}, t.family);
  file.tensors["item.name"] = MakeTensor({n}, t.name);
  file.tensors["item.mass"] = MakeTensor({n}, t.mass);
  file.tensors["item.com"] = MakeTensor({n, 3}, t.com);
  file.tensors["item.box"] = MakeTensor({n, 6}, t.box);
  file.tensors["item.cloud"] = MakeTensor({n, points, 6}, t.cloud);
  file.tensors["item.normals"] = MakeTensor({n, points, 2}, t.normals);
  file.tensors["item.contexts"] = MakeTensor({n}, t.contexts);
  file.tensors["context.kind"] = MakeTensor({c}, t.kind);
  file.tensors["context.scene"] = MakeTensor({c}, t.scene);
  file.tensors["context.pose"] = MakeTensor({c, 3, 4}, t.pose);
  file.tensors["context.phi"] = MakeTensor({c, points}, t.phi);
  file.tensors["context.occluded"] = MakeTensor({c, (points + 7) / 8}, t.occluded);
  file.tensors["context.truths"] = MakeTensor({c}, t.truths);
  file.tensors["truth.bits"] = MakeTensor({m}, t.bits);
  file.tensors["truth.progress"] = MakeTensor({m, 2}, t.progress);
  file.tensors["truth.places"] = MakeTensor({m, kNumPlanningFingers, 6}, t.places);
  file.tensors["truth.normals"] = MakeTensor({m, kNumPlanningFingers, 2}, t.contact_normals);
  file.tensors["truth.phi"] = MakeTensor({m, kNumPlanningFingers}, t.contact_phi);
  return file;
}

Dataset UnpackStates(const TensorFile& file) {
  Dataset dataset;
  dataset.items = Unpacker(file).Items();
  dataset.description = file.metadata_at("description");
  return dataset;
}

}  // namespace pregrasp
