#include "app/networks/grasp_generator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

std::string FlowConfig::ToJson() const {
  return nlohmann::ordered_json{{"steps", steps}, {"noise", noise}, {"finger_sets", finger_sets}}
      .dump();
}

FlowConfig FlowConfig::FromJson(const std::string& text, const std::string& where) {
  FlowConfig flow;
  try {
    const auto json = nlohmann::json::parse(text);
    json.at("steps").get_to(flow.steps);
    json.at("noise").get_to(flow.noise);
    json.at("finger_sets").get_to(flow.finger_sets);
  } catch (const nlohmann::json::exception&) {
    throw InputError(where, "flow", "steps, noise and finger_sets", text);
  }
  double sum = 0.0;
  bool valid = flow.steps >= 1 && flow.steps <= 1000 && flow.noise > 0.0 && flow.noise < 1e3;
  for (const double share : flow.finger_sets) {
    valid = valid && share >= 0.0;
    sum += share;
  }
  if (!(valid && std::abs(sum - 1.0) < 1e-6)) {
    throw InputError(where, "flow", "1 to 1000 steps, positive noise and shares that sum to 1",
                     text);
  }
  return flow;
}

void WriteTimeNumbers(double t, float* out) {
  out[0] = static_cast<float>(t);
  out[1] = static_cast<float>(std::sin(kPi * t));
  out[2] = static_cast<float>(std::cos(kPi * t));
}

std::vector<float> ChooseFingers(const FlowConfig& flow, int fingers, float number) {
  const double u = 0.5 * std::erfc(-number / std::sqrt(2.0));
  std::vector<float> used(fingers, 1.0F);  // ring and little are the last
  double below = 0.0;
  int set = 0;
  while (set < 3 && u >= (below += flow.finger_sets[set])) ++set;
  if (set == 1 || set == 3) used[fingers - 1] = 0.0F;
  if (set == 2 || set == 3) used[fingers - 2] = 0.0F;
  return used;
}

int FlowInputCount(int fingers) { return 4 * fingers + kTimeNumbers; }

int GeneratorOf(const PlanningContacts& contacts) {
  PREGRASP_CHECK(contacts[0] || contacts[1]);
  return contacts[0] && contacts[1] ? 2 : (contacts[0] ? 0 : 1);
}

std::vector<Finger> PredictedFingers(int which) {
  std::vector<Finger> fingers;
  if (which == 1) fingers.push_back(Finger::kThumb);
  if (which == 0) fingers.push_back(Finger::kIndex);
  for (const Finger finger : {Finger::kMiddle, Finger::kRing, Finger::kLittle}) {
    fingers.push_back(finger);
  }
  return fingers;
}

Vector3 CalcAnchor(const PlanningContacts& contacts) {
  Vector3 sum = Vector3::Zero();
  int count = 0;
  for (const auto& contact : contacts) {
    if (!contact) continue;
    sum += contact->p_OC;
    ++count;
  }
  PREGRASP_CHECK(count > 0);
  return sum / count;
}

GraspGenerator GraspGenerator::Load(const std::filesystem::path& file) {
  return FromTensors(ReadTensors(file));
}

GraspGenerator GraspGenerator::FromTensors(const TensorFile& file) {
  GraspGenerator generator;
  generator.encoder_ = SetEncoder::Load(file, "encoder");
  const SetEncoderConfig& config = generator.encoder_.config();
  generator.contacts_ = ContactFeatureConfig::FromJson(file.metadata_at("contacts"), file.where);
  if (file.metadata.contains("flow")) {
    generator.flow_ = FlowConfig::FromJson(file.metadata_at("flow"), file.where);
    generator.latent_size_ = kFlowLatentSize;
  } else {
    const std::string& latent = file.metadata_at("latent_size");
    generator.latent_size_ = latent.size() < 4 ? std::atoi(latent.c_str()) : 0;
    if (generator.latent_size_ < 1) {
      throw InputError(file.where, "latent_size", "a count of 1 to 999", latent);
    }
  }
  for (int which = 0; which < 3; ++which) {
    const std::string name = kGeneratorNames[which];
    const std::vector<int> widths = ReadHeadWidths(file, name);
    const int outputs = 3 * static_cast<int>(PredictedFingers(which).size());
    if (widths.back() != outputs) {
      throw InputError(file.where, name, "a head of " + std::to_string(outputs) + " outputs",
                       std::to_string(widths.back()));
    }
    const int others = ContactFeatureCount(generator.contacts_, config) +
                       (generator.flow_ ? FlowInputCount(outputs / 3) : generator.latent_size_);
    generator.heads_[which] = Head::Load(file, name, config.code_size(), others, widths);
  }
  return generator;
}

EncodedState GraspGenerator::Encode(const CloudStructure& structure,
                                    const ObjectState& state) const {
  EncodedState encoded;
  encoder_.EncodeChunk(structure, &state, 1, &encoded);
  return encoded;
}

std::vector<GraspPoints> GraspGenerator::Sample(const CloudStructure& structure,
                                                const EncodedState& encoded,
                                                const PlanningContacts& contacts, int count,
                                                Rng rng) const {
  std::vector<float> latent(static_cast<std::size_t>(count) * latent_size_);
  for (float& z : latent) z = static_cast<float>(rng.Normal());
  return Decode(structure, encoded, contacts, latent);
}

std::vector<std::vector<float>> GraspGenerator::DecodeOnce(
    const Head& head, const std::vector<float>& share, const std::vector<float>& condition,
    const std::vector<std::vector<float>>& rows) const {
  Rows in, a, b;
  in.Resize(static_cast<int>(rows.size()), head.others());
  for (int i = 0; i < in.rows(); ++i) {
    std::copy(condition.begin(), condition.end(), in.row(i));
    std::copy(rows[i].begin(), rows[i].end(), in.row(i) + condition.size());
  }
  const Rows& out = head.Apply(share, in, a, b);
  std::vector<std::vector<float>> results;
  for (int i = 0; i < in.rows(); ++i) results.emplace_back(out.row(i), out.row(i) + out.stride());
  return results;
}

std::vector<std::vector<float>> GraspGenerator::Flow(const Head& head,
                                                     const std::vector<float>& share,
                                                     const std::vector<float>& condition, int which,
                                                     const std::vector<float>& latent) const {
  const int fingers = static_cast<int>(PredictedFingers(which).size());
  const int count = static_cast<int>(latent.size()) / latent_size_;
  std::vector<std::vector<float>> points(count), used(count), rows(count);
  for (int i = 0; i < count; ++i) {
    const float* numbers = latent.data() + static_cast<std::ptrdiff_t>(i) * latent_size_;
    used[i] = ChooseFingers(*flow_, fingers, numbers[latent_size_ - 1]);
    for (int k = 0; k < 3 * fingers; ++k) {
      points[i].push_back(static_cast<float>(flow_->noise) * numbers[k] * used[i][k / 3]);
    }
  }
  for (int step = 0; step < flow_->steps; ++step) {
    float time[kTimeNumbers];
    WriteTimeNumbers(static_cast<double>(step) / flow_->steps, time);
    for (int i = 0; i < count; ++i) {
      rows[i] = points[i];
      rows[i].insert(rows[i].end(), used[i].begin(), used[i].end());
      rows[i].insert(rows[i].end(), time, time + kTimeNumbers);
    }
    const auto velocity = DecodeOnce(head, share, condition, rows);
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < 3 * fingers; ++k) {
        points[i][k] += velocity[i][k] * used[i][k / 3] / static_cast<float>(flow_->steps);
      }
    }
  }
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 3 * fingers; ++k) {
      if (used[i][k / 3] == 0.0F) points[i][k] = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return points;
}

std::vector<GraspPoints> GraspGenerator::Decode(const CloudStructure& structure,
                                                const EncodedState& encoded,
                                                const PlanningContacts& contacts,
                                                const std::vector<float>& latent) const {
  PREGRASP_CHECK(latent.size() % latent_size_ == 0, latent.size(), latent_size_);
  const int which = GeneratorOf(contacts);
  const Head& head = heads_[which];
  const std::vector<Finger> fingers = PredictedFingers(which);
  const int taken = flow_ ? FlowInputCount(static_cast<int>(fingers.size())) : latent_size_;
  std::vector<float> condition(head.others() - taken);
  WriteContactFeatures(structure, encoded, encoder_.config(), contacts_, contacts,
                       condition.data());
  const std::vector<float> share = head.CalcCodeShare(encoded.code);
  std::vector<std::vector<float>> points;
  if (flow_) {
    points = Flow(head, share, condition, which, latent);
  } else {
    std::vector<std::vector<float>> rows;
    for (auto row = latent.begin(); row != latent.end(); row += latent_size_) {
      rows.emplace_back(row, row + latent_size_);
    }
    points = DecodeOnce(head, share, condition, rows);
  }

  const Vector3 anchor = CalcAnchor(contacts);
  const Matrix3 R_OG = encoded.R_GO.transpose() / contacts_.position_scale;
  std::vector<GraspPoints> grasps(points.size());
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (contacts[f]) grasps[i][f] = contacts[f]->p_OC;
    }
    for (std::size_t k = 0; k < fingers.size(); ++k) {
      const float* p = points[i].data() + 3 * k;
      grasps[i][static_cast<int>(fingers[k])] = anchor + R_OG * Vector3(p[0], p[1], p[2]);
    }
  }
  return grasps;
}

}  // namespace pregrasp
