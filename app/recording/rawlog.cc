// The only file with MRPT's headers: they take seconds to compile.
#include "app/recording/rawlog.h"

#include <mrpt/core/Clock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationRawDAQ.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <utility>

#include "app/core/check.h"
#include "app/core/error.h"
#include "app/recording/gzip_file.h"
#include "app/core/json_text.h"

namespace pregrasp {
namespace {

using mrpt::obs::CObservationComment;
using mrpt::obs::CObservationImage;
using mrpt::obs::CObservationRawDAQ;
using mrpt::obs::CObservationRobotPose;
using mrpt::obs::CSensoryFrame;

constexpr char kPosePrefix[] = "pose_";
constexpr char kContactsLabel[] = "contacts";
constexpr char kPictureLabel[] = "picture";

// The channels of the "contacts" observation for each finger of the step, in its order.
constexpr std::array<const char*, 10> kChannels{"on",         "p_OC_x",     "p_OC_y",     "p_OC_z",
                                                "target_W_x", "target_W_y", "target_W_z", "f_W_x",
                                                "f_W_y",      "f_W_z"};

mrpt::Clock::time_point StampOf(double t) { return mrpt::Clock::fromDouble(kRawlogEpoch + t); }

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
  observation->timestamp = StampOf(t);
  return observation;
}

CObservationRobotPose::Ptr NewPose(const StepRecord::BodyPose& body, double t) {
  auto pose = NewObservation<CObservationRobotPose>(kPosePrefix + body.name, t);
  pose->pose.mean = ToPose(body.X_WB);
  pose->pose.cov.setZero();
  return pose;
}

CObservationRawDAQ::Ptr NewContacts(const StepRecord& step) {
  auto contacts = NewObservation<CObservationRawDAQ>(kContactsLabel, step.t);
  std::vector<double>& channels = contacts->AIN_double;
  for (const StepRecord::FingerContact& finger : step.fingers) {
    channels.push_back(finger.on ? 1.0 : 0.0);
    for (const Vector3& v : {finger.p_OC, finger.p_WTarget, finger.f_W}) {
      channels.insert(channels.end(), v.data(), v.data() + 3);
    }
  }
  // Without this, rawlog-edit exports nothing.
  contacts->AIN_channel_count = static_cast<std::uint16_t>(channels.size());
  return contacts;
}

CObservationImage::Ptr NewPicture(const StepRecord& step, int number) {
  auto picture = NewObservation<CObservationImage>(kPictureLabel, step.t);
  picture->image.setExternalStorage(PictureName(number, step.id));
  return picture;
}

// MRPT keeps no label of a comment.
CObservationComment::Ptr NewComment(double t, const std::string& text) {
  auto comment = NewObservation<CObservationComment>("", t);
  comment->text = text;
  return comment;
}

}  // namespace

struct RawlogWriter::Impl {
  explicit Impl(const std::filesystem::path& path) : file(path) {}

  void Write(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream bytes;
    mrpt::serialization::archiveFrom(bytes) << object;
    file.Write({static_cast<const char*>(bytes.getRawBufferData()), bytes.getTotalBytesCount()});
  }

  GzipFile file;
};

RawlogWriter::RawlogWriter(const std::filesystem::path& file, const nlohmann::ordered_json& header)
    : impl_(std::make_unique<Impl>(file)) {
  nlohmann::ordered_json text = header;
  text["time_zero_unix_s"] = kRawlogEpoch;
  text["contacts_channels_per_finger"] = kChannels;
  // At the top level a comment is the log's global one.
  impl_->Write(*NewComment(0.0, FormatJsonIndented(text)));
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::Add(const StepRecord& step, int number) {
  CSensoryFrame frame;
  for (const StepRecord::BodyPose& body : step.bodies) frame.insert(NewPose(body, step.t));
  if (!step.fingers.empty()) frame.insert(NewContacts(step));
  frame.insert(NewPicture(step, number));
  frame.insert(NewComment(step.t, FormatJson(StepToJson(step, number))));
  // rawlog-edit takes a log of frames alone for one single object; pairs work everywhere.
  impl_->Write(mrpt::obs::CActionCollection());
  impl_->Write(frame);
}

void RawlogWriter::Close() { impl_->file.Close(); }

namespace {

// Everything in a frame, with what is read from it checked against the step's comment.
class FrameReader {
 public:
  FrameReader(const CSensoryFrame& frame, std::string where)
      : frame_(frame), where_(std::move(where)) {}

  StepRecord ReadStep() const {
    const auto comment = frame_.getObservationByClass<CObservationComment>();
    Require(comment != nullptr, "a comment");
    StepRecord step = StepFromJson(ParseJson(comment->text, where_), where_);
    for (const auto& observation : frame_) {
      Require(
          std::abs(mrpt::Clock::toDouble(observation->timestamp) - kRawlogEpoch - step.t) < 1e-6,
          "the time stamp that the comment gives");
    }
    for (std::size_t i = 0; i < step.bodies.size(); ++i) {
      const auto pose = frame_.getObservationByClass<CObservationRobotPose>(i);
      Require(pose && pose->sensorLabel == kPosePrefix + step.bodies[i].name,
              "a pose for each body of the comment");
      step.bodies[i].X_WB = FromPose(pose->pose.mean);
    }
    if (!step.fingers.empty()) ReadContacts(step);
    return step;
  }

  std::string ReadPicture() const {
    const auto picture = frame_.getObservationByClass<CObservationImage>();
    Require(picture && picture->image.isExternallyStored(), "a picture stored outside the log");
    return picture->image.getExternalStorageFile();
  }

 private:
  void Require(bool condition, const char* expected) const {
    if (!condition) throw InputError(where_, "", expected, "none");
  }

  void ReadContacts(StepRecord& step) const {
    const auto contacts = frame_.getObservationByClass<CObservationRawDAQ>();
    Require(contacts && contacts->AIN_double.size() == kChannels.size() * step.fingers.size() &&
                contacts->AIN_channel_count == contacts->AIN_double.size(),
            "contact channels for each finger of the comment");
    const double* channel = contacts->AIN_double.data();
    for (StepRecord::FingerContact& finger : step.fingers) {
      finger.on = *channel++ != 0.0;
      for (Vector3* v : {&finger.p_OC, &finger.p_WTarget, &finger.f_W}) {
        *v = Vector3(channel[0], channel[1], channel[2]);
        channel += 3;
      }
    }
  }

  const CSensoryFrame& frame_;
  std::string where_;
};

}  // namespace

Rawlog LoadRawlog(const std::filesystem::path& file) {
  const std::string bytes = ReadGzipFile(file);
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(stream);
  Rawlog log;
  try {
    while (stream.getPosition() < bytes.size()) {
      const auto object = archive.ReadObject();
      if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(object)) {
        log.header = ParseJson(comment->text, file.string());
      } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
        const FrameReader reader(*frame,
                                 file.string() + ": step " + std::to_string(log.steps.size() + 1));
        log.steps.push_back(reader.ReadStep());
        log.pictures.push_back(reader.ReadPicture());
      }
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // MRPT's
    throw InputError(file.string(), "", "a whole MRPT log", error.what());
  }
  return log;
}

}  // namespace pregrasp
