#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "app/core/rng.h"
#include "app/networks/contact_features.h"
#include "app/networks/grasp_generator.h"
#include "app/networks/safetensors.h"

namespace pregrasp {

/// Networks with random weights and random objects, for tests of what holds for any weights.

inline void AddRandomLayer(TensorFile& file, Rng& rng, const std::string& name, int inputs,
                           int outputs) {
  std::vector<float> weight(static_cast<std::size_t>(inputs) * outputs), bias(outputs);
  for (float& w : weight) w = static_cast<float>(rng.Normal() * std::sqrt(2.0 / inputs));
  for (float& b : bias) b = static_cast<float>(0.1 * rng.Normal());
  file.tensors[name + ".weight"] = MakeTensor<float>({outputs, inputs}, weight);
  file.tensors[name + ".bias"] = MakeTensor<float>({outputs}, bias);
}

inline void AddRandomLayers(TensorFile& file, Rng& rng, const std::string& name, int inputs,
                            const std::vector<int>& widths) {
  for (std::size_t i = 0; i < widths.size(); ++i) {
    AddRandomLayer(file, rng, name + "." + std::to_string(i), inputs, widths[i]);
    inputs = widths[i];
  }
}

inline void AddRandomEncoder(TensorFile& file, Rng& rng, const SetEncoderConfig& config) {
  file.metadata["encoder"] = config.ToJson();
  int features = 1;
  for (std::size_t l = 0; l < config.levels.size(); ++l) {
    AddRandomLayers(file, rng, "encoder.level" + std::to_string(l), 3 + features,
                    config.levels[l].widths);
    features = config.levels[l].widths.back();
  }
  AddRandomLayers(file, rng, "encoder.global", 3 + features, config.global_widths);
  AddRandomLayers(file, rng, "encoder.code", config.global_widths.back(), config.code_widths);
}

inline TensorFile MakeRandomScore(std::uint64_t seed, const SetEncoderConfig& config = {}) {
  TensorFile file;
  file.where = "random score";
  Rng rng(seed);
  AddRandomEncoder(file, rng, config);
  const ContactFeatureConfig contacts;
  file.metadata["contacts"] = contacts.ToJson();
  file.metadata["score"] = "[256,256,1]";
  AddRandomLayers(file, rng, "score", config.code_size() + ContactFeatureCount(contacts, config),
                  {256, 256, 1});
  return file;
}

/// An autoencoder's decoders; flows if `flow` is given.
inline TensorFile MakeRandomGenerator(std::uint64_t seed, int latent = 8,
                                      const FlowConfig* flow = nullptr) {
  TensorFile file;
  file.where = "random generator";
  Rng rng(seed);
  const SetEncoderConfig config;
  AddRandomEncoder(file, rng, config);
  const ContactFeatureConfig contacts;
  file.metadata["contacts"] = contacts.ToJson();
  if (flow != nullptr) {
    file.metadata["flow"] = flow->ToJson();
  } else {
    file.metadata["latent_size"] = std::to_string(latent);
  }
  for (int which = 0; which < 3; ++which) {
    const std::string name = kGeneratorNames[which];
    const int outputs = 3 * static_cast<int>(PredictedFingers(which).size());
    file.metadata[name] = "[256,256," + std::to_string(outputs) + "]";
    const int taken = flow != nullptr ? FlowInputCount(outputs / 3) : latent;
    AddRandomLayers(file, rng, name,
                    config.code_size() + ContactFeatureCount(contacts, config) + taken,
                    {256, 256, outputs});
  }
  return file;
}

/// Points on the surface of a 0.20 x 0.10 x 0.04 m box.
inline MatrixX3 MakeBoxCloud(std::uint64_t seed, int count = 512) {
  Rng rng(seed);
  const Vector3 half(0.10, 0.05, 0.02);
  MatrixX3 P(count, 3);
  for (int i = 0; i < count; ++i) {
    Vector3 p(rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0));
    p[rng.UniformInt(3)] = rng.UniformInt(2) ? 1.0 : -1.0;
    P.row(i) = p.cwiseProduct(half).transpose();
  }
  return P;
}

/// A random tilt, random distances, a quarter of the points occluded.
inline ObjectState MakeRandomState(Rng& rng, int points) {
  ObjectState state;
  state.phi.resize(points);
  state.occluded.resize(points);
  for (int i = 0; i < points; ++i) {
    state.phi[i] = rng.Uniform(-0.03, 0.15);
    state.occluded[i] = rng.UniformInt(4) == 0;
  }
  state.up_O = (Vector3::UnitZ() + 0.5 * rng.Direction()).normalized();
  return state;
}

inline PlanningContact MakeRandomContact(Rng& rng, const MatrixX3& P) {
  PlanningContact contact;
  contact.p_OC = P.row(rng.UniformInt(static_cast<std::uint32_t>(P.rows()))).transpose();
  contact.nhat_O = rng.Direction();
  contact.phi = rng.Uniform(-0.01, 0.1);
  return contact;
}

inline PlanningContacts MakeRandomContacts(Rng& rng, const MatrixX3& P) {
  PlanningContacts contacts;
  const std::uint32_t which = 1 + rng.UniformInt(3);
  if (which & 1) contacts[0] = MakeRandomContact(rng, P);
  if (which & 2) contacts[1] = MakeRandomContact(rng, P);
  return contacts;
}

/// Both networks' files, as a planner loads them from a folder.
inline void WriteRandomWeights(const std::filesystem::path& folder) {
  WriteTensors(folder / "score.safetensors", MakeRandomScore(3));
  WriteTensors(folder / "generator.safetensors", MakeRandomGenerator(4));
}

}  // namespace pregrasp
