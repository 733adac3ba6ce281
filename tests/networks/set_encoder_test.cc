#include "app/networks/set_encoder.h"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "app/core/error.h"
#include "tests/networks/random_network.h"

namespace pregrasp {
namespace {

// The set encoder as the paper's figure says it, in double precision and without any of the
// rearrangements: every edge goes through all layers of its level.
class PlainEncoder {
 public:
  PlainEncoder(const TensorFile& file, const SetEncoderConfig& config)
      : file_(file), config_(config) {}

  VectorX Encode(const CloudStructure& structure, const ObjectState& state) const {
    const Matrix3 R_GO = structure.CalcUprightFrame(state.up_O);
    MatrixX3 P(structure.size(), 3);
    MatrixX F(structure.size(), 1);
    std::vector<bool> present(structure.size());
    for (int i = 0; i < structure.size(); ++i) {
      P.row(i) =
          (config_.position_scale * (R_GO * (structure.P_O.row(i).transpose() - structure.p_OC)))
              .transpose();
      const double phi = state.phi.size() ? state.phi[i] : config_.phi_max;
      F(i, 0) = config_.phi_scale * std::clamp(phi, config_.phi_min, config_.phi_max);
      present[i] = state.occluded.empty() || !state.occluded[i];
    }
    for (std::size_t l = 0; l < structure.levels.size(); ++l) {
      const SetLevel& level = structure.levels[l];
      const int count = static_cast<int>(level.centroids.size());
      const std::string name = "encoder.level" + std::to_string(l);
      MatrixX G = MatrixX::Zero(count, config_.levels[l].widths.back());
      std::vector<bool> any(count, false);
      for (int c = 0; c < count; ++c) {
        for (int e = level.begin[c]; e < level.begin[c + 1]; ++e) {
          const int i = level.neighbors[e];
          if (!present[i]) continue;
          VectorX x(3 + F.cols());
          x << (P.row(i) - P.row(level.centroids[c])).transpose(), F.row(i).transpose();
          G.row(c) = G.row(c).cwiseMax(Apply(name, config_.levels[l].widths, x).transpose());
          any[c] = true;
        }
      }
      MatrixX3 Q(count, 3);
      for (int c = 0; c < count; ++c) Q.row(c) = P.row(level.centroids[c]);
      P = Q;
      F = G;
      present = any;
    }
    VectorX global = VectorX::Zero(config_.global_widths.back());
    for (int c = 0; c < P.rows(); ++c) {
      if (!present[c]) continue;
      VectorX x(3 + F.cols());
      x << P.row(c).transpose(), F.row(c).transpose();
      global = global.cwiseMax(Apply("encoder.global", config_.global_widths, x));
    }
    return Apply("encoder.code", config_.code_widths, global);
  }

 private:
  VectorX Apply(const std::string& name, const std::vector<int>& widths, VectorX x) const {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string layer = name + "." + std::to_string(i);
      const auto inputs = static_cast<int>(x.size());
      const auto weight = file_.Get<float>(layer + ".weight", {widths[i], inputs});
      const auto bias = file_.Get<float>(layer + ".bias", {widths[i]});
      VectorX y(widths[i]);
      for (int o = 0; o < widths[i]; ++o) {
        y[o] = bias[o];
        for (int k = 0; k < inputs; ++k) y[o] += weight[o * inputs + k] * x[k];
      }
      x = y.cwiseMax(0.0);
    }
    return x;
  }

  const TensorFile& file_;
  SetEncoderConfig config_;
};

class SetEncoderTest : public testing::Test {
 protected:
  const TensorFile file_ = [] {
    TensorFile file;
    Rng rng(11);
    AddRandomEncoder(file, rng, {});
    return file;
  }();
  const SetEncoder encoder_ = SetEncoder::Load(file_, "encoder");
  const MatrixX3 P_ = MakeBoxCloud(1);
  const CloudStructure structure_ = encoder_.BuildStructure(P_, Matrix3::Identity());
  ThreadPool pool_{2};

  EncodedState Encode(const CloudStructure& structure, const ObjectState& state) {
    return encoder_.Encode(structure, {state}, pool_).front();
  }
};

TEST_F(SetEncoderTest, AgreesWithThePlainDefinition) {
  const PlainEncoder plain(file_, {});
  for (std::uint32_t trial = 0; trial < 6; ++trial) {
    Rng rng(4, RngStream::kTest, trial);
    ObjectState state = MakeRandomState(rng, structure_.size());
    if (trial == 0) state.occluded.clear();
    if (trial == 1) state.phi.resize(0);
    const VectorX expected = plain.Encode(structure_, state);
    const EncodedState encoded = Encode(structure_, state);
    ASSERT_GT(expected.maxCoeff(), 0.1);
    for (int i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(encoded.code[i], expected[i], 1e-5 * (1.0 + expected.maxCoeff()));
    }
  }
}

TEST_F(SetEncoderTest, ThePapersEncoderAgreesWithThePlainDefinitionToo) {
  TensorFile file;
  Rng rng(12);
  AddRandomEncoder(file, rng, PaperSetEncoderConfig());
  const SetEncoder encoder = SetEncoder::Load(file, "encoder");
  const CloudStructure structure = encoder.BuildStructure(P_, Matrix3::Identity());
  const ObjectState state = MakeRandomState(rng, structure.size());
  const VectorX expected = PlainEncoder(file, PaperSetEncoderConfig()).Encode(structure, state);
  const EncodedState encoded = encoder.Encode(structure, {state}, pool_).front();
  ASSERT_EQ(encoded.code.size(), 512U);
  for (int i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(encoded.code[i], expected[i], 1e-5 * (1.0 + expected.maxCoeff()));
  }
}

TEST_F(SetEncoderTest, TheOrderOfThePointsDoesNotMatter) {
  Rng rng(5);
  const ObjectState state = MakeRandomState(rng, structure_.size());
  std::vector<int> order(structure_.size());
  std::iota(order.begin(), order.end(), 0);
  for (int i = structure_.size() - 1; i > 0; --i) std::swap(order[i], order[rng.UniformInt(i + 1)]);
  ObjectState shuffled = state;
  for (int i = 0; i < structure_.size(); ++i) {
    shuffled.phi[i] = state.phi[order[i]];
    shuffled.occluded[i] = state.occluded[order[i]];
  }
  const CloudStructure other =
      encoder_.BuildStructure(MatrixX3(P_(order, Eigen::all)), Matrix3::Identity());
  EXPECT_EQ(Encode(structure_, state).code, Encode(other, shuffled).code);
}

TEST_F(SetEncoderTest, AnOccludedPointIsAnAbsentPoint) {
  Rng rng(6);
  const ObjectState state = MakeRandomState(rng, structure_.size());
  // Nothing of it can reach the result ..
  ObjectState poisoned = state;
  for (int i = 0; i < structure_.size(); ++i) {
    if (state.occluded[i]) poisoned.phi[i] = std::numeric_limits<double>::quiet_NaN();
  }
  const EncodedState encoded = Encode(structure_, state);
  EXPECT_EQ(Encode(structure_, poisoned).code, encoded.code);
  // .. and it is as if it were in no neighbourhood.
  CloudStructure without = structure_;
  SetLevel& level = without.levels.front();
  SetLevel kept;
  kept.centroids = level.centroids;
  kept.begin.push_back(0);
  for (std::size_t c = 0; c < level.centroids.size(); ++c) {
    for (int e = level.begin[c]; e < level.begin[c + 1]; ++e) {
      if (!state.occluded[level.neighbors[e]]) kept.neighbors.push_back(level.neighbors[e]);
    }
    kept.begin.push_back(static_cast<int>(kept.neighbors.size()));
  }
  level = kept;
  ObjectState all = state;
  all.occluded.clear();
  EXPECT_EQ(Encode(without, all).code, encoded.code);
}

TEST_F(SetEncoderTest, OcclusionMatters) {
  Rng rng(7);
  ObjectState state = MakeRandomState(rng, structure_.size());
  const EncodedState with = Encode(structure_, state);
  state.occluded.clear();
  EXPECT_NE(Encode(structure_, state).code, with.code);
}

TEST_F(SetEncoderTest, AFullyOccludedObjectHasAFiniteCode) {
  ObjectState state;
  state.occluded.assign(structure_.size(), true);
  const EncodedState encoded = Encode(structure_, state);
  for (const float c : encoded.code) EXPECT_TRUE(std::isfinite(c));
  EXPECT_TRUE(encoded.present.empty());
}

TEST_F(SetEncoderTest, AStatesBitsDependOnItAlone) {
  std::vector<ObjectState> states;
  for (std::uint32_t i = 0; i < 37; ++i) {
    Rng rng(8, RngStream::kTest, i);
    states.push_back(MakeRandomState(rng, structure_.size()));
  }
  ThreadPool one(1), three(3);
  const auto together = encoder_.Encode(structure_, states, one);
  const auto threaded = encoder_.Encode(structure_, states, three);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const EncodedState alone = Encode(structure_, states[i]);
    EXPECT_EQ(together[i].code, alone.code);
    EXPECT_EQ(threaded[i].code, alone.code);
    for (int c = 0; c < alone.local.rows(); ++c) {
      for (int k = 0; k < encoder_.config().local_size(); ++k) {
        ASSERT_EQ(together[i].local.row(c)[k], alone.local.row(c)[k]);
      }
    }
  }
}

TEST_F(SetEncoderTest, NoSurroundingsAreTheSameAsFarSurroundings) {
  ObjectState none, far;
  far.phi = VectorX::Constant(structure_.size(), 3.0);
  EXPECT_EQ(Encode(structure_, none).code, Encode(structure_, far).code);
}

TEST_F(SetEncoderTest, TheChoiceOfTheObjectsFrameDoesNotMatter) {
  // The same object and pose, written in another body frame.
  Rng rng(9);
  const ObjectState state = MakeRandomState(rng, structure_.size());
  const Matrix3 R_BO = rng.Rotation().toRotationMatrix();
  const Vector3 p_BO(0.3, -0.2, 0.1);
  MatrixX3 P_B = P_ * R_BO.transpose();
  P_B.rowwise() += p_BO.transpose();
  ObjectState turned = state;
  turned.up_O = R_BO * state.up_O;
  CloudStructure other = encoder_.BuildStructure(P_B, R_BO.transpose());
  // Ties and rounding may choose other centroids, and the box's middle is of the axes' choosing.
  other.levels = structure_.levels;
  other.p_OC = R_BO * structure_.p_OC + p_BO;
  const EncodedState a = Encode(structure_, state), b = Encode(other, turned);
  for (std::size_t i = 0; i < a.code.size(); ++i) EXPECT_NEAR(a.code[i], b.code[i], 1e-4);
}

TEST_F(SetEncoderTest, AConfigurationSurvivesJsonAndNonsenseIsRefused) {
  const std::string json = PaperSetEncoderConfig().ToJson();
  EXPECT_EQ(SetEncoderConfig::FromJson(json, "test").ToJson(), json);
  EXPECT_THROW(SetEncoderConfig::FromJson("{}", "test"), InputError);
  EXPECT_THROW(SetEncoderConfig::FromJson("[", "test"), InputError);
  SetEncoderConfig config;
  config.levels[1].centroids = 65;
  EXPECT_THROW(SetEncoderConfig::FromJson(config.ToJson(), "test"), InputError);
  config = {};
  config.phi_min = 0.2;
  EXPECT_THROW(SetEncoderConfig::FromJson(config.ToJson(), "test"), InputError);
  config = {};
  config.code_widths = {100'000};
  EXPECT_THROW(SetEncoderConfig::FromJson(config.ToJson(), "test"), InputError);
}

}  // namespace
}  // namespace pregrasp
