#include "app/networks/grasp_generator.h"

#include <algorithm>
#include <string>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {

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
  const std::string& latent = file.metadata_at("latent_size");
  generator.latent_size_ = latent.size() < 4 ? std::atoi(latent.c_str()) : 0;
  if (generator.latent_size_ < 1) {
    throw InputError(file.where, "latent_size", "a count of 1 to 999", latent);
  }
  const int others = ContactFeatureCount(generator.contacts_, config) + generator.latent_size_;
  for (int which = 0; which < 3; ++which) {
    const std::string name = kGeneratorNames[which];
    const std::vector<int> widths = ReadHeadWidths(file, name);
    const int outputs = 3 * static_cast<int>(PredictedFingers(which).size());
    if (widths.back() != outputs) {
      throw InputError(file.where, name, "a head of " + std::to_string(outputs) + " outputs",
                       std::to_string(widths.back()));
    }
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

std::vector<GraspPoints> GraspGenerator::Decode(const CloudStructure& structure,
                                                const EncodedState& encoded,
                                                const PlanningContacts& contacts,
                                                const std::vector<float>& latent) const {
  PREGRASP_CHECK(latent.size() % latent_size_ == 0, latent.size(), latent_size_);
  const int which = GeneratorOf(contacts);
  const Head& head = heads_[which];
  const int count = static_cast<int>(latent.size()) / latent_size_;
  const int features = head.others() - latent_size_;
  std::vector<float> condition(features);
  WriteContactFeatures(structure, encoded, encoder_.config(), contacts_, contacts,
                       condition.data());
  Rows in, a, b;
  in.Resize(count, head.others());
  for (int i = 0; i < count; ++i) {
    std::copy(condition.begin(), condition.end(), in.row(i));
    std::copy_n(latent.begin() + static_cast<std::ptrdiff_t>(i) * latent_size_, latent_size_,
                in.row(i) + features);
  }
  const Rows& out = head.Apply(head.CalcCodeShare(encoded.code), in, a, b);

  const std::vector<Finger> fingers = PredictedFingers(which);
  const Vector3 anchor = CalcAnchor(contacts);
  const Matrix3 R_OG = encoded.R_GO.transpose() / contacts_.position_scale;
  std::vector<GraspPoints> grasps(count);
  for (int i = 0; i < count; ++i) {
    for (int f = 0; f < kNumPlanningFingers; ++f) {
      if (contacts[f]) grasps[i][f] = contacts[f]->p_OC;
    }
    for (std::size_t k = 0; k < fingers.size(); ++k) {
      const float* p = out.row(i) + 3 * k;
      grasps[i][static_cast<int>(fingers[k])] = anchor + R_OG * Vector3(p[0], p[1], p[2]);
    }
  }
  return grasps;
}

}  // namespace pregrasp
