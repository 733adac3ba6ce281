#include "app/recording/rawlog.h"

#include <array>
#include <utility>

#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/job/facts_json.h"
#include "app/recording/gzip_file.h"
#include "app/recording/mrpt_codec.h"

namespace pregrasp {
namespace {

constexpr char kPosePrefix[] = "pose_";
constexpr char kContactsLabel[] = "contacts";
constexpr char kPictureLabel[] = "picture";
constexpr char kHandPoseLabel[] = "pose_hand_palm";
constexpr char kJointsLabel[] = "hand_joints";
constexpr char kGraspLabel[] = "grasp";

// The channels of the "contacts" observation for each finger of the step, in its order.
constexpr std::array<const char*, 10> kChannels{"on",         "p_OC_x",     "p_OC_y",     "p_OC_z",
                                                "target_W_x", "target_W_y", "target_W_z", "f_W_x",
                                                "f_W_y",      "f_W_z"};

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

LogFrame MakeFrame(const StepFacts& step, const std::string& line, const std::string& picture) {
  LogFrame frame{kRawlogEpoch + step.t, {}, line};
  const auto add = [&](const std::string& label, LogObservation::Value value) {
    frame.observations.push_back({label, std::move(value)});
  };
  for (const BodyFacts& body : step.bodies) add(kPosePrefix + body.name, body.X_WB());
  if (!step.fingers.empty()) add(kContactsLabel, ContactChannels(step));
  if (const HandFacts* hand = FindHand(step)) {
    add(kHandPoseLabel, hand->configuration().X_WH);
    add(kJointsLabel, hand->joints);
  }
  if (const auto* grasp = std::get_if<GraspFacts>(&step.details)) {
    add(kGraspLabel, GraspChannels(*grasp));
  }
  if (!picture.empty()) add(kPictureLabel, picture);
  return frame;
}

}  // namespace

struct RawlogWriter::Impl {
  GzipFile file;
  const MrptCodec& codec;
};

RawlogWriter::RawlogWriter(const std::filesystem::path& file, const nlohmann::ordered_json& header)
    : impl_(new Impl{GzipFile(file), GetMrptCodec()}) {
  nlohmann::ordered_json text = header;
  text["time_zero_unix_s"] = kRawlogEpoch;
  text["contacts_channels_per_finger"] = kChannels;
  // At the top level a comment is the log's global one.
  impl_->file.Write(impl_->codec.EncodeComment(kRawlogEpoch, FormatJsonIndented(text)));
}

RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::Add(const StepFacts& step, const std::string& line, const std::string& picture) {
  impl_->file.Write(impl_->codec.Encode(MakeFrame(step, line, picture)));
}

void RawlogWriter::Close() { impl_->file.Close(); }

namespace {

// The step of a frame, whose observations must be those that the step has.
StepFacts ReadStep(const LogEntry& entry, const std::string& where) {
  if (entry.comment.empty()) throw InputError(where, "", "a comment with the step", "none");
  StepFacts step = FactsFromJson(ParseJson(entry.comment, where), where);
  const LogFrame expected = MakeFrame(step, entry.comment, entry.picture);
  if (const auto difference = GetMrptCodec().Compare(entry, expected)) {
    throw InputError(where + ", " + step.id, difference->observation, difference->expected,
                     difference->got);
  }
  return step;
}

std::vector<LogEntry> ReadEntries(const std::filesystem::path& file) {
  const MrptCodec& codec = GetMrptCodec();
  const std::string bytes = ReadGzipFile(file);
  try {
    return codec.Decode(bytes);
  } catch (const std::exception& error) {
    throw InputError(file.string(), "", "a whole MRPT log", error.what());
  }
}

}  // namespace

Rawlog LoadRawlog(const std::filesystem::path& file) {
  Rawlog log;
  for (const LogEntry& entry : ReadEntries(file)) {
    if (entry.frame == nullptr) {
      log.header = ParseJson(entry.comment, file.string());
    } else {
      const std::string where = file.string() + ": step " + std::to_string(log.steps.size() + 1);
      log.steps.push_back(ReadStep(entry, where));
      log.pictures.push_back(entry.picture);
    }
  }
  return log;
}

}  // namespace pregrasp
