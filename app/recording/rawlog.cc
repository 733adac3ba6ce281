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
#include "app/core/json_text.h"
#include "app/job/facts_json.h"
#include "app/recording/gzip_file.h"
#include "app/recording/run_directory.h"

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
constexpr char kHandPoseLabel[] = "pose_hand_palm";
constexpr char kJointsLabel[] = "hand_joints";
constexpr char kGraspLabel[] = "grasp";
constexpr double kSamePose = 1e-12;  // of a matrix's entries

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

CObservationRobotPose::Ptr NewPose(const std::string& label, const RigidTransform& X, double t) {
  auto pose = NewObservation<CObservationRobotPose>(label, t);
  pose->pose.mean = ToPose(X);
  pose->pose.cov.setZero();
  return pose;
}

CObservationRawDAQ::Ptr NewChannels(const std::string& label, std::vector<double> channels,
                                    double t) {
  auto daq = NewObservation<CObservationRawDAQ>(label, t);
  // Without this, rawlog-edit exports nothing.
  daq->AIN_channel_count = static_cast<std::uint16_t>(channels.size());
  daq->AIN_double = std::move(channels);
  return daq;
}

void Append(std::vector<double>& channels, const Vector3& v) {
  channels.insert(channels.end(), v.data(), v.data() + 3);
}

std::vector<double> ContactChannels(const StepFacts& step) {
  std::vector<double> channels;
  for (const FingerFacts& finger : step.fingers) {
    channels.push_back(finger.on ? 1.0 : 0.0);
    for (const Vector3& v : {finger.p_OC, finger.p_WTarget, finger.f_W}) Append(channels, v);
  }
  return channels;
}

// Of each finger: whether the grasp uses it, contact, outward normal, force, in O.
std::vector<double> GraspChannels(const GraspFacts& grasp) {
  std::vector<double> channels;
  for (int f = 0; f < kNumFingers; ++f) {
    GraspContactFacts contact;
    contact.nhat_O.setZero();
    bool used = false;
    for (const GraspContactFacts& candidate : grasp.contacts) {
      if (static_cast<int>(candidate.finger) != f) continue;
      contact = candidate;
      used = true;
    }
    channels.push_back(used ? 1.0 : 0.0);
    for (const Vector3& v : {contact.p_OC, contact.nhat_O, contact.f_O}) Append(channels, v);
  }
  return channels;
}

// The hand that a step shows; null for none.
const HandFacts* FindHand(const StepFacts& step) {
  if (const auto* grasp = std::get_if<GraspFacts>(&step.details)) {
    return grasp->hand ? &*grasp->hand : nullptr;
  }
  if (const auto* lift = std::get_if<LiftFacts>(&step.details)) return &lift->hand;
  if (const auto* frame = std::get_if<FrameFacts>(&step.details)) return &frame->hand;
  return nullptr;
}

CObservationImage::Ptr NewPicture(const StepFacts& step, int number) {
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

void RawlogWriter::Add(const StepFacts& step, int number, const std::string& line) {
  CSensoryFrame frame;
  for (const BodyFacts& body : step.bodies) {
    frame.insert(NewPose(kPosePrefix + body.name, body.X_WB(), step.t));
  }
  if (!step.fingers.empty()) {
    frame.insert(NewChannels(kContactsLabel, ContactChannels(step), step.t));
  }
  if (const HandFacts* hand = FindHand(step)) {
    frame.insert(NewPose(kHandPoseLabel, hand->configuration().X_WH, step.t));
    frame.insert(NewChannels(kJointsLabel, hand->joints, step.t));
  }
  if (const auto* grasp = std::get_if<GraspFacts>(&step.details)) {
    frame.insert(NewChannels(kGraspLabel, GraspChannels(*grasp), step.t));
  }
  frame.insert(NewPicture(step, number));
  frame.insert(NewComment(step.t, line));
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

  StepFacts ReadStep() const {
    const auto comment = frame_.getObservationByClass<CObservationComment>();
    Require(comment != nullptr, "a comment");
    StepFacts step = FactsFromJson(ParseJson(comment->text, where_), where_);
    for (const auto& observation : frame_) {
      Require(
          std::abs(mrpt::Clock::toDouble(observation->timestamp) - kRawlogEpoch - step.t) < 1e-6,
          "the time stamp that the comment gives");
    }
    for (std::size_t i = 0; i < step.bodies.size(); ++i) {
      const auto pose = frame_.getObservationByClass<CObservationRobotPose>(i);
      Require(pose && pose->sensorLabel == kPosePrefix + step.bodies[i].name &&
                  (FromPose(pose->pose.mean).matrix() - step.bodies[i].X_WB().matrix())
                          .cwiseAbs()
                          .maxCoeff() < kSamePose,
              "the pose of each body of the comment");
    }
    if (!step.fingers.empty()) CheckContacts(step);
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

  void CheckContacts(const StepFacts& step) const {
    const auto contacts = frame_.getObservationByClass<CObservationRawDAQ>();
    Require(contacts && contacts->sensorLabel == kContactsLabel &&
                contacts->AIN_double == ContactChannels(step) &&
                contacts->AIN_channel_count == contacts->AIN_double.size(),
            "the contact channels of each finger of the comment");
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
