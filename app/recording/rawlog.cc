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

CObservationImage::Ptr NewPicture(double t, const std::string& name) {
  auto picture = NewObservation<CObservationImage>(kPictureLabel, t);
  picture->image.setExternalStorage(name);
  return picture;
}

// MRPT keeps no label of a comment.
CObservationComment::Ptr NewComment(double t, const std::string& text) {
  auto comment = NewObservation<CObservationComment>("", t);
  comment->text = text;
  return comment;
}

std::string BytesOf(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream bytes;
  mrpt::serialization::archiveFrom(bytes) << object;
  return {static_cast<const char*>(bytes.getRawBufferData()), bytes.getTotalBytesCount()};
}

CSensoryFrame MakeFrame(const StepFacts& step, const std::string& line,
                        const std::string& picture) {
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
  if (!picture.empty()) frame.insert(NewPicture(step.t, picture));
  frame.insert(NewComment(step.t, line));
  return frame;
}

}  // namespace

struct RawlogWriter::Impl {
  explicit Impl(const std::filesystem::path& path) : file(path) {}

  void Write(const mrpt::serialization::CSerializable& object) { file.Write(BytesOf(object)); }

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

void RawlogWriter::Add(const StepFacts& step, const std::string& line, const std::string& picture) {
  // rawlog-edit takes a log of frames alone for one single object; pairs work everywhere.
  impl_->Write(mrpt::obs::CActionCollection());
  impl_->Write(MakeFrame(step, line, picture));
}

void RawlogWriter::Close() { impl_->file.Close(); }

namespace {

// Whether an observation that was read is one that was written. Poses go through yaw, pitch and
// roll, which costs their last bits.
bool AreSame(const mrpt::obs::CObservation& read, const mrpt::obs::CObservation& written) {
  const auto* pose = dynamic_cast<const CObservationRobotPose*>(&read);
  const auto* other = dynamic_cast<const CObservationRobotPose*>(&written);
  if (pose == nullptr || other == nullptr) return BytesOf(read) == BytesOf(written);
  const RigidTransform X = FromPose(pose->pose.mean), Y = FromPose(other->pose.mean);
  CObservationRobotPose same_mean = *pose;
  same_mean.pose.mean = other->pose.mean;
  return (X.matrix() - Y.matrix()).cwiseAbs().maxCoeff() < kSamePose &&
         BytesOf(same_mean) == BytesOf(written);
}

std::string NameOf(const mrpt::obs::CObservation& observation) {
  return observation.sensorLabel.empty() ? observation.GetRuntimeClass()->className
                                         : observation.sensorLabel;
}

// The step of a frame, whose observations must be those that the step has.
StepFacts ReadStep(const CSensoryFrame& frame, const std::string& where, std::string& picture) {
  const auto comment = frame.getObservationByClass<CObservationComment>();
  if (!comment) throw InputError(where, "", "a comment with the step", "none");
  StepFacts step = FactsFromJson(ParseJson(comment->text, where), where);
  const auto image = frame.getObservationByClass<CObservationImage>();
  if (image && image->image.isExternallyStored()) picture = image->image.getExternalStorageFile();
  const CSensoryFrame expected = MakeFrame(step, comment->text, picture);
  auto read = frame.begin();
  for (const auto& written : expected) {
    if (read == frame.end() || !AreSame(**read, *written)) {
      throw InputError(where + ", " + step.id, NameOf(*written), "what the step's comment says",
                       read == frame.end() ? "nothing" : "something else");
    }
    ++read;
  }
  if (read != frame.end()) {
    throw InputError(where + ", " + step.id, NameOf(**read), "nothing", "an observation more");
  }
  return step;
}

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
        const std::string where = file.string() + ": step " + std::to_string(log.steps.size() + 1);
        std::string& picture = log.pictures.emplace_back();
        log.steps.push_back(ReadStep(*frame, where, picture));
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
