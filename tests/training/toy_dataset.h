#pragma once

#include <algorithm>
#include <string>

#include "app/core/rng.h"
#include "app/training/dataset.h"

namespace pregrasp {

/// A small data set with a known answer, for tests of the trainer: boxes at random poses, distances
/// to a plane, and labels that depend on shape, surroundings and contacts in a simple way.
inline Dataset MakeToyDataset(std::uint64_t seed, int items, int points) {
  Dataset dataset;
  dataset.description = "{}";
  dataset.hash = "toy " + std::to_string(seed);
  for (int i = 0; i < items; ++i) {
    Rng rng(seed, RngStream::kTest, static_cast<std::uint32_t>(i));
    DatasetItem item;
    item.index = i;
    item.family = "family" + std::to_string(i % 4);
    item.mass = 0.2;
    const Vector3 half(rng.Uniform(0.02, 0.09), rng.Uniform(0.02, 0.09), rng.Uniform(0.01, 0.05));
    item.P_O.resize(points, 3);
    item.N_O.setZero(points, 3);
    for (int p = 0; p < points; ++p) {
      Vector3 x(rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0));
      const std::uint32_t axis = rng.UniformInt(3);
      x[axis] = rng.UniformInt(2) ? 1.0 : -1.0;
      item.N_O(p, axis) = x[axis];
      item.P_O.row(p) = x.cwiseProduct(half).transpose();
    }
    for (int c = 0; c < 3; ++c) {
      ContextRecord context;
      context.kind = "toy";
      context.X_WO = MakeTransform(rng.Rotation(), Vector3(0.0, 0.0, rng.Uniform(0.02, 0.12)));
      context.phi = (item.P_O * context.X_WO.linear().row(2).transpose()).array() +
                    context.X_WO.translation().z();
      for (int p = 0; p < points; ++p) context.occluded.push_back(context.phi[p] < 0.0);
      const auto contact_at = [&](std::uint32_t p) {
        return PlanningContact{item.P_O.row(p), item.N_O.row(p), context.phi[p]};
      };
      for (int l = 0; l < 8; ++l) {
        LabelRecord label;
        label.context = c;
        const std::uint32_t which = 1 + rng.UniformInt(3);
        double value = 1.0;
        for (int f = 0; f < kNumPlanningFingers; ++f) {
          if (!(which >> f & 1)) continue;
          label.contacts[f] = contact_at(rng.UniformInt(points));
          value *= std::clamp(label.contacts[f]->phi / 0.1, 0.0, 1.0);
        }
        label.tries = 20;
        label.feasible.fill(static_cast<int>(20.0 * value));
        item.labels.push_back(label);
        TruthRecord truth;
        truth.context = c;
        truth.contacts = label.contacts;
        truth.relief = value;
        truth.room = 1.0 - value;
        truth.lifted = value > 0.4;
        item.truths.push_back(truth);
      }
      for (int g = 0; g < 4; ++g) {
        GraspRecord grasp;
        grasp.context = c;
        for (int f = 0; f < kNumFingers; ++f) {
          grasp.used[f] = f < 3 || rng.UniformInt(2) == 1;
          if (!grasp.used[f]) continue;
          const PlanningContact contact = contact_at(rng.UniformInt(points));
          grasp.p_OC[f] = contact.p_OC;
          grasp.nhat_O[f] = contact.nhat_O;
          grasp.phi[f] = contact.phi;
        }
        for (int f = 0; f < kNumFingers; ++f) {
          if (!grasp.used[f]) grasp.p_OC[f] = grasp.nhat_O[f] = Vector3::Zero();
        }
        item.grasps.push_back(grasp);
      }
      item.contexts.push_back(context);
    }
    dataset.items.push_back(item);
  }
  return dataset;
}

/// An encoder for clouds of 64 points or more.
inline SetEncoderConfig MakeToyEncoder() {
  SetEncoderConfig config;
  config.levels = {{24, 0.06, 8, {8, 8, 16}}, {8, 0.12, 8, {16, 16}}};
  config.global_widths = {16, 32};
  config.code_widths = {32};
  return config;
}

}  // namespace pregrasp
