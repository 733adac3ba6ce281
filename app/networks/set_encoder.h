#pragma once

#include <string>
#include <vector>

#include "app/core/thread_pool.h"
#include "app/networks/cloud_structure.h"
#include "app/networks/linear.h"

namespace pregrasp {

/// The shape of an encoder and the scales of its inputs; kept with its weights. The default is the
/// small one of the project's own measurements; the paper's PointNet++ differs only in numbers
/// (PaperSetEncoderConfig).
struct SetEncoderConfig {
  std::vector<SetLevelConfig> levels = {{64, 0.05, 16, {16, 16, 32}}, {16, 0.10, 16, {32, 32, 64}}};
  std::vector<int> global_widths = {64, 64, 128};  ///< over all centroids of the last level
  std::vector<int> code_widths = {256, 256};       ///< after the maximum; the last is the code's
  double position_scale = 10.0;                    ///< [1/m]; 0 hides the shape (an ablation)
  double phi_scale = 20.0;  ///< [1/m]; 0 hides the surroundings (an ablation)
  double phi_min = -0.02;   ///< distances are clamped to this range first [m]
  double phi_max = 0.10;

  int code_size() const { return code_widths.back(); }
  int local_size() const { return levels.front().widths.back(); }

  /// `phi` clamped and scaled, as every network input that is a signed distance.
  float ScaledDistance(double phi) const;

  std::string ToJson() const;
  /// @throws InputError naming `where` if `text` is not a configuration.
  static SetEncoderConfig FromJson(const std::string& text, const std::string& where);
  /// @throws InputError naming `where`.
  void Validate(const std::string& where) const;
};

/// The widths, radii and counts of the paper's grasp generators (its released options).
SetEncoderConfig PaperSetEncoderConfig();

/// One situation of an object, as the networks see it: the paper's S and O'.
struct ObjectState {
  /// Signed distance from each cloud point to the surroundings (#points) [m]; empty means that
  /// there are none.
  VectorX phi;
  /// Points where no fingertip can be (#points); they are left out. Empty means none.
  std::vector<bool> occluded;
  Vector3 up_O = Vector3::UnitZ();  ///< the direction against gravity, unit length
};

/// What the encoder made of one state; everything a head needs besides the contacts.
struct EncodedState {
  std::vector<float> code;   ///< code_size() numbers
  std::vector<int> present;  ///< centroids of the first level that have points, ascending
  Rows local;                ///< features of all its centroids (#centroids x local_size())
  Matrix3 R_GO = Matrix3::Identity();
};

/// The set encoder over (position, signed distance): PointNet++'s set abstraction with ragged,
/// cached neighbourhoods. Exact rearrangements make it cheap (findings: 25x the naive form): the
/// first layer of a level is applied per point instead of per edge, bias and rectifier of the last
/// one after the maximum. Immutable, safe to share between threads.
class SetEncoder {
 public:
  /// Reads the layers PREFIX.level<l>.<i>, PREFIX.global.<i>, PREFIX.code.<i> for a configuration
  /// given as JSON in the metadata entry PREFIX. @throws InputError.
  static SetEncoder Load(const TensorFile& file, const std::string& prefix);

  const SetEncoderConfig& config() const { return config_; }

  CloudStructure BuildStructure(const MatrixX3& P_O, const Matrix3& R_WO0) const {
    return BuildCloudStructure(P_O, R_WO0, config_.levels);
  }

  /// Encodes states of one object. The bits of a result depend on its state alone: not on the
  /// others, nor on the number of threads or the instruction set.
  std::vector<EncodedState> Encode(const CloudStructure& structure,
                                   const std::vector<ObjectState>& states, ThreadPool& pool) const;

  /// Encodes states[0 .. count) on the calling thread.
  void EncodeChunk(const CloudStructure& structure, const ObjectState* states, int count,
                   EncodedState* encoded) const;

 private:
  // One level: `point` is the first layer over (position, features), `shift` its part in the
  // position, `rest` the others.
  struct Level {
    Linear point, shift;
    std::vector<Linear> rest;
  };
  struct Workspace;

  void EncodeLevels(const CloudStructure& structure, const ObjectState& state,
                    EncodedState& encoded, Workspace& work, float* global) const;
  static void ApplyLevel(const Level& level, const SetLevel& graph, Workspace& work);

  SetEncoderConfig config_;
  std::vector<Level> levels_;
  Perceptron global_, code_;
};

}  // namespace pregrasp
