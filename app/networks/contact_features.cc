#include "app/networks/contact_features.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/core/error.h"

namespace pregrasp {
namespace {

// Softens the weights within 1 mm of a centroid [m^2].
constexpr double kLocalSoftening = 1e-6;

}  // namespace

std::string ContactFeatureConfig::ToJson() const {
  return nlohmann::ordered_json{{"position_scale", position_scale},
                                {"local_neighbors", local_neighbors}}
      .dump();
}

ContactFeatureConfig ContactFeatureConfig::FromJson(const std::string& text,
                                                    const std::string& where) {
  ContactFeatureConfig config;
  try {
    const auto json = nlohmann::json::parse(text);
    config.position_scale = json.at("position_scale").get<double>();
    config.local_neighbors = json.at("local_neighbors").get<int>();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(where, "contacts", "a configuration of contact features", e.what());
  }
  if (!(config.position_scale > 0.0 && config.position_scale <= 1e4)) {
    throw InputError(where, "contacts.position_scale", "a scale above 0", "");
  }
  if (config.local_neighbors < 0 || config.local_neighbors > 64) {
    throw InputError(where, "contacts.local_neighbors", "0 to 64", "");
  }
  return config;
}

int ContactFeatureCount(const ContactFeatureConfig& config, const SetEncoderConfig& encoder) {
  return kNumPlanningFingers *
             (kContactNumbers + (config.local_neighbors > 0 ? encoder.local_size() : 0)) +
         kPairNumbers;
}

std::vector<std::pair<int, float>> CalcLocalWeights(const CloudStructure& structure,
                                                    const std::vector<int>& present,
                                                    const Vector3& p_OC, int neighbors) {
  std::vector<std::pair<double, int>> near;
  near.reserve(present.size());
  const std::vector<int>& centroids = structure.levels.front().centroids;
  for (const int i : present) {
    near.emplace_back((structure.P_O.row(centroids[i]).transpose() - p_OC).squaredNorm(), i);
  }
  const std::size_t count = std::min<std::size_t>(near.size(), neighbors);
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
  near.resize(count);
  double sum = 0.0;
  for (auto& [value, i] : near) {
    value = 1.0 / (value + kLocalSoftening);
    sum += value;
  }
  std::vector<std::pair<int, float>> weights;
  weights.reserve(count);
  for (const auto& [value, i] : near) weights.emplace_back(i, static_cast<float>(value / sum));
  return weights;
}

void WriteContactNumbers(const CloudStructure& structure, const Matrix3& R_GO,
                         const SetEncoderConfig& encoder, const ContactFeatureConfig& config,
                         const PlanningContacts& contacts, float* out) {
  std::fill_n(out, kNumPlanningFingers * kContactNumbers + kPairNumbers, 0.0F);
  for (const auto& contact : contacts) {
    if (contact) {
      const Vector3 p = config.position_scale * (R_GO * (contact->p_OC - structure.p_OC));
      const Vector3 n = R_GO * contact->nhat_O;
      out[0] = 1.0F;
      for (int axis = 0; axis < 3; ++axis) {
        out[1 + axis] = static_cast<float>(p[axis]);
        out[4 + axis] = static_cast<float>(n[axis]);
      }
      out[7] = encoder.ScaledDistance(contact->phi);
    }
    out += kContactNumbers;
  }
  if (!contacts[0] || !contacts[1]) return;
  const Vector3 line = contacts[1]->p_OC - contacts[0]->p_OC;
  const double distance = line.norm();
  const Vector3 direction = distance > 0.0 ? Vector3(line / distance) : Vector3::Zero();
  out[0] = static_cast<float>(config.position_scale * distance);
  out[1] = static_cast<float>(contacts[0]->nhat_O.dot(contacts[1]->nhat_O));
  out[2] = static_cast<float>(contacts[0]->nhat_O.dot(direction));
  out[3] = static_cast<float>(contacts[1]->nhat_O.dot(direction));
}

void WriteContactFeatures(const CloudStructure& structure, const EncodedState& encoded,
                          const SetEncoderConfig& encoder, const ContactFeatureConfig& config,
                          const PlanningContacts& contacts, float* out) {
  WriteContactNumbers(structure, encoded.R_GO, encoder, config, contacts, out);
  if (config.local_neighbors == 0) return;
  out += kNumPlanningFingers * kContactNumbers + kPairNumbers;
  const int size = encoder.local_size();
  for (const auto& contact : contacts) {
    std::fill_n(out, size, 0.0F);
    if (contact) {
      for (const auto& [i, weight] :
           CalcLocalWeights(structure, encoded.present, contact->p_OC, config.local_neighbors)) {
        const float* local = encoded.local.row(i);
        for (int c = 0; c < size; ++c) out[c] += weight * local[c];
      }
    }
    out += size;
  }
}

}  // namespace pregrasp
