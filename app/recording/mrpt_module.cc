// MRPT's logs; with mrpt_scene_module.cc the only files with its headers, which take seconds to
// compile; calls nothing of ours.
#include <mrpt/core/Clock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRawDAQ.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include "app/recording/mrpt_codec.h"
#include "app/recording/mrpt_scene_module.h"

namespace pregrasp {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationComment;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationRawDAQ;
using mrpt::obs::CObservationRobotPose;
using mrpt::obs::CSensoryFrame;

constexpr double kSamePose = 1e-12;  // of a matrix's entries

mrpt::poses::CPose3D ToPose(const RigidTransform& X) {
  mrpt::math::CMatrixDouble44 matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = X.matrix()(row, column);
  }
  return mrpt::poses::CPose3D(matrix);
}

RigidTransform FromPose(const mrpt::poses::CPose3D& pose) {
  mrpt::math::CMatrixDouble44 matrix;
  pose.getHomogeneousMatrix(matrix);
  RigidTransform X = RigidTransform::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) X.matrix()(row, column) = matrix(row, column);
  }
  return X;
}

template <typename Observation>
std::shared_ptr<Observation> NewObservation(const std::string& label, double t) {
  auto observation = Observation::Create();
  observation->sensorLabel = label;
  observation->timestamp = mrpt::Clock::fromDouble(t);
  return observation;
}

CObservation::Ptr NewObservation(const LogObservation& entry, double t) {
  if (const auto* X = std::get_if<RigidTransform>(&entry.value)) {
    auto pose = NewObservation<CObservationRobotPose>(entry.label, t);
    pose->pose.mean = ToPose(*X);
    pose->pose.cov.setZero();
    return pose;
  }
  if (const auto* channels = std::get_if<std::vector<double>>(&entry.value)) {
    auto daq = NewObservation<CObservationRawDAQ>(entry.label, t);
    // Without this, rawlog-edit exports nothing.
    daq->AIN_channel_count = static_cast<std::uint16_t>(channels->size());
    daq->AIN_double = *channels;
    return daq;
  }
  auto picture = NewObservation<CObservationImage>(entry.label, t);
  picture->image.setExternalStorage(std::get<std::string>(entry.value));
  return picture;
}

// MRPT keeps no label of a comment.
CObservationComment::Ptr NewComment(double t, const std::string& text) {
  auto comment = NewObservation<CObservationComment>("", t);
  comment->text = text;
  return comment;
}

CSensoryFrame MakeFrame(const LogFrame& frame) {
  CSensoryFrame made;
  for (const LogObservation& entry : frame.observations) {
    made.insert(NewObservation(entry, frame.t));
  }
  made.insert(NewComment(frame.t, frame.comment));
  return made;
}

std::string BytesOf(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << object;
  return {static_cast<const char*>(bytes.getRawBufferData()), bytes.getTotalBytesCount()};
}

// Whether an observation that was read is one that was written. Poses go through yaw, pitch and
// roll, which costs their last bits.
bool AreSame(const CObservation& read, const CObservation& written) {
  const auto* pose = dynamic_cast<const CObservationRobotPose*>(&read);
  const auto* other = dynamic_cast<const CObservationRobotPose*>(&written);
  if (pose == nullptr || other == nullptr) return BytesOf(read) == BytesOf(written);
  const RigidTransform X = FromPose(pose->pose.mean), Y = FromPose(other->pose.mean);
  CObservationRobotPose same_mean = *pose;
  same_mean.pose.mean = other->pose.mean;
  return (X.matrix() - Y.matrix()).cwiseAbs().maxCoeff() < kSamePose &&
         BytesOf(same_mean) == BytesOf(written);
}

std::string NameOf(const CObservation& observation) {
  return observation.sensorLabel.empty() ? observation.GetRuntimeClass()->className
                                         : observation.sensorLabel;
}

class Codec : public MrptCodec {
 public:
  std::string EncodeComment(double t, const std::string& text) const override {
    return BytesOf(*NewComment(t, text));
  }

  std::string Encode(const LogFrame& frame) const override {
    // rawlog-edit takes a log of frames alone for one single object; pairs work everywhere.
    return BytesOf(mrpt::obs::CActionCollection()) + BytesOf(MakeFrame(frame));
  }

  std::string EncodeScene(const MrptScene& scene) const override { return EncodeMrptScene(scene); }

  std::vector<LogEntry> Decode(std::string_view bytes) const override {
    mrpt::io::CMemoryStream stream;
    stream.assignMemoryNotOwn(bytes.data(), bytes.size());
    auto archive = mrpt::serialization::archiveFrom(stream);
    std::vector<LogEntry> entries;
    while (stream.getPosition() < bytes.size()) {
      const auto object = archive.ReadObject();
      if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(object)) {
        entries.push_back({comment->text, "", nullptr});
      } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
        LogEntry& entry = entries.emplace_back();
        entry.frame = frame;
        if (const auto said = frame->getObservationByClass<CObservationComment>()) {
          entry.comment = said->text;
        }
        const auto image = frame->getObservationByClass<CObservationImage>();
        if (image && image->image.isExternallyStored()) {
          entry.picture = image->image.getExternalStorageFile();
        }
      }
    }
    return entries;
  }

  std::optional<LogDifference> Compare(const LogEntry& entry,
                                       const LogFrame& expected) const override {
    const auto& frame = *static_cast<const CSensoryFrame*>(entry.frame.get());
    const CSensoryFrame whole = MakeFrame(expected);
    auto read = frame.begin();
    for (const auto& written : whole) {
      if (read == frame.end() || !AreSame(**read, *written)) {
        return LogDifference{NameOf(*written), "what the step's comment says",
                             read == frame.end() ? "nothing" : "something else"};
      }
      ++read;
    }
    if (read == frame.end()) return std::nullopt;
    return LogDifference{NameOf(**read), "nothing", "an observation more"};
  }
};

}  // namespace
}  // namespace pregrasp

extern "C" const pregrasp::MrptCodec* PregraspMrptCodec() {
  static const pregrasp::Codec codec;
  return &codec;
}
