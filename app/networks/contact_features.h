#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/networks/set_encoder.h"
#include "app/scene/finger.h"

namespace pregrasp {

/// A contact of the thumb or the index finger, as given to the networks.
struct PlanningContact {
  Vector3 p_OC = Vector3::Zero();
  Vector3 nhat_O = Vector3::UnitZ();  ///< outward surface normal there
  /// Signed distance from there to the surroundings [m]; infinity means that there are none.
  double phi = std::numeric_limits<double>::infinity();
};

/// Which planning fingers touch, and where; indexed by Finger. The paper's p1, p2 with presence
/// instead of its token [100, 100, 100].
using PlanningContacts = std::array<std::optional<PlanningContact>, kNumPlanningFingers>;

/// How contacts are put to a head; kept with its weights.
struct ContactFeatureConfig {
  double position_scale = 10.0;  ///< [1/m]
  /// A contact also gets the encoder's features around it, interpolated between this many of the
  /// nearest centroids of its first level; 0 for none.
  int local_neighbors = 3;

  std::string ToJson() const;
  static ContactFeatureConfig FromJson(const std::string& text, const std::string& where);
};

/// Numbers of one contact (present, position, normal, signed distance) and of a pair (distance,
/// and the normals' cosines with each other and with the line between the contacts).
inline constexpr int kContactNumbers = 8;
inline constexpr int kPairNumbers = 4;

/// Length of what WriteContactFeatures writes.
int ContactFeatureCount(const ContactFeatureConfig& config, const SetEncoderConfig& encoder);

/// The centroids of the first level around p_OC that have points, with weights that fall with the
/// squared distance and sum to 1; none if no point is left.
std::vector<std::pair<int, float>> CalcLocalWeights(const CloudStructure& structure,
                                                    const std::vector<int>& present,
                                                    const Vector3& p_OC, int neighbors);

/// Numbers without the local features, in frame G: thumb, index (kContactNumbers each, zero when
/// absent), pair (kPairNumbers, zero unless both are present).
void WriteContactNumbers(const CloudStructure& structure, const Matrix3& R_GO,
                         const SetEncoderConfig& encoder, const ContactFeatureConfig& config,
                         const PlanningContacts& contacts, float* out);

/// The same followed by the local features of thumb and index.
void WriteContactFeatures(const CloudStructure& structure, const EncodedState& encoded,
                          const SetEncoderConfig& encoder, const ContactFeatureConfig& config,
                          const PlanningContacts& contacts, float* out);

}  // namespace pregrasp
