#include "app/networks/score_function.h"

#include <algorithm>
#include <cmath>

#include "app/core/check.h"
#include "app/core/error.h"

namespace pregrasp {
namespace {

constexpr int kStatesPerTask = 16;
constexpr int kContactsPerTask = 512;

double Sigmoid(double x) { return 1.0 / (1.0 + std::exp(-x)); }

}  // namespace

ScoreFunction ScoreFunction::Load(const std::filesystem::path& file) {
  return FromTensors(ReadTensors(file));
}

ScoreFunction ScoreFunction::FromTensors(const TensorFile& file) {
  ScoreFunction score;
  score.encoder_ = SetEncoder::Load(file, "encoder");
  score.contacts_ = ContactFeatureConfig::FromJson(file.metadata_at("contacts"), file.where);
  const std::vector<int> widths = ReadHeadWidths(file, "score");
  if (widths.back() > 3)
    throw InputError(file.where, "score", "a head of one to three outputs", "");
  score.num_outputs_ = widths.back();
  score.head_ = Head::Load(file, "score", score.encoder_.config().code_size(),
                           ContactFeatureCount(score.contacts_, score.encoder_.config()), widths);
  return score;
}

void ScoreFunction::ScoreRange(const CloudStructure& structure, const EncodedState& encoded,
                               const std::vector<float>& share, const PlanningContacts* contacts,
                               int count, ScoreOutput output, double* scores) const {
  Rows features, a, b;
  features.Resize(count, head_.others());
  for (int i = 0; i < count; ++i) {
    WriteContactFeatures(structure, encoded, encoder_.config(), contacts_, contacts[i],
                         features.row(i));
  }
  const Rows& out = head_.Apply(share, features, a, b);
  const int column = std::min(static_cast<int>(output), num_outputs_ - 1);
  for (int i = 0; i < count; ++i) {
    const bool any = contacts[i][0].has_value() || contacts[i][1].has_value();
    scores[i] = any ? Sigmoid(out.row(i)[column]) : 0.0;
  }
}

VectorX ScoreFunction::ScoreContacts(const CloudStructure& structure, const ObjectState& state,
                                     const std::vector<PlanningContacts>& contacts,
                                     ScoreOutput output, ThreadPool& pool) const {
  EncodedState encoded;
  encoder_.EncodeChunk(structure, &state, 1, &encoded);
  const std::vector<float> share = head_.CalcCodeShare(encoded.code);
  const int count = static_cast<int>(contacts.size());
  VectorX scores(count);
  pool.ParallelFor((count + kContactsPerTask - 1) / kContactsPerTask, [&](int task, int) {
    const int first = task * kContactsPerTask;
    ScoreRange(structure, encoded, share, &contacts[first],
               std::min(kContactsPerTask, count - first), output, scores.data() + first);
  });
  return scores;
}

VectorX ScoreFunction::ScoreContacts(const CloudStructure& structure, const ObjectState& state,
                                     const std::vector<PlanningContacts>& contacts,
                                     ScoreOutput output) const {
  EncodedState encoded;
  encoder_.EncodeChunk(structure, &state, 1, &encoded);
  VectorX scores(static_cast<Eigen::Index>(contacts.size()));
  ScoreRange(structure, encoded, head_.CalcCodeShare(encoded.code), contacts.data(),
             static_cast<int>(contacts.size()), output, scores.data());
  return scores;
}

VectorX ScoreFunction::ScoreStates(const CloudStructure& structure,
                                   const std::vector<ObjectState>& states,
                                   const std::vector<PlanningContacts>& contacts,
                                   ThreadPool& pool) const {
  PREGRASP_CHECK(states.size() == contacts.size(), states.size(), contacts.size());
  const int count = static_cast<int>(states.size());
  VectorX scores(count);
  pool.ParallelFor((count + kStatesPerTask - 1) / kStatesPerTask, [&](int task, int) {
    const int first = task * kStatesPerTask;
    const int size = std::min(kStatesPerTask, count - first);
    std::vector<EncodedState> encoded(size);
    encoder_.EncodeChunk(structure, &states[first], size, encoded.data());
    for (int i = 0; i < size; ++i) {
      ScoreRange(structure, encoded[i], head_.CalcCodeShare(encoded[i].code), &contacts[first + i],
                 1, ScoreOutput::kProgress, scores.data() + first + i);
    }
  });
  return scores;
}

}  // namespace pregrasp
