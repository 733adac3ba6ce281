#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "app/core/math.h"
#include "app/recording/mrpt_scene.h"

namespace pregrasp {

/// An entry of a log as plain values: a pose in W, channels of numbers, or the name of a picture.
struct LogObservation {
  using Value = std::variant<RigidTransform, std::vector<double>, std::string>;

  std::string label;
  Value value;
};

/// What a log has of one step.
struct LogFrame {
  double t = 0.0;  ///< seconds since 1970
  std::vector<LogObservation> observations;
  std::string comment;
};

/// An object that was read.
struct LogEntry {
  std::string comment;
  std::string picture;                ///< "" for none
  std::shared_ptr<const void> frame;  ///< MRPT's; null for a comment that stands alone
};

/// Where a frame differs from the one that is expected.
struct LogDifference {
  std::string observation, expected, got;
};

/// MRPT's way of writing objects. It is a module of its own, loaded when the first log is written
/// or read: MRPT comes with 150 libraries, which take the loader a fifth of a second.
class MrptCodec {
 public:
  MrptCodec() = default;
  MrptCodec(const MrptCodec&) = delete;
  MrptCodec& operator=(const MrptCodec&) = delete;
  virtual ~MrptCodec() = default;

  /// A comment that stands alone.
  virtual std::string EncodeComment(double t, const std::string& text) const = 0;
  /// An empty CActionCollection and a CSensoryFrame.
  virtual std::string Encode(const LogFrame& frame) const = 0;
  /// All comments and frames. @throws std::exception of MRPT's where the bytes are none of its own.
  virtual std::vector<LogEntry> Decode(std::string_view bytes) const = 0;
  /// A COpenGLScene.
  virtual std::string EncodeScene(const MrptScene& scene) const = 0;
  /// The first difference of an entry's frame, but for the last bits of poses.
  virtual std::optional<LogDifference> Compare(const LogEntry& entry,
                                               const LogFrame& expected) const = 0;
};

/// @throws InputError where the module or a library of MRPT's is missing.
const MrptCodec& GetMrptCodec();

}  // namespace pregrasp
