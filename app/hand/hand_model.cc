#include "app/hand/hand_model.h"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <mutex>

#include "app/core/data_folder.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/hand/hand_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

fs::path HandsFolder() { return DataFolder() / "assets" / "hands"; }

}  // namespace

bool IsHandFile(const std::string& name_or_file) {
  return name_or_file.find('/') != std::string::npos || name_or_file.ends_with(".lua");
}

std::optional<Finger> HandModel::FingerOf(int link) const {
  for (int f = 0; f < num_fingers; ++f) {
    if (tips[f].link == link) return static_cast<Finger>(f);
  }
  return std::nullopt;
}

TipSpheres HandModel::tip_spheres() const {
  TipSpheres spheres;
  spheres.count = num_fingers;
  for (int f = 0; f < kNumFingers; ++f) spheres.radii[f] = tips[f].radius;
  return spheres;
}

std::map<std::string, fs::path> ListHands() {
  std::map<std::string, fs::path> hands;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(HandsFolder(), ignored)) {
    const fs::path file = entry.path() / "hand.lua";
    if (fs::exists(file, ignored)) hands[entry.path().filename().string()] = file;
  }
  return hands;
}

fs::path FileOfHand(const std::string& name_or_file) {
  if (IsHandFile(name_or_file)) return name_or_file;
  const std::map<std::string, fs::path> hands = ListHands();
  if (const auto found = hands.find(name_or_file); found != hands.end()) return found->second;
  std::vector<std::string> names;
  std::string listed;
  for (const auto& [name, file] : hands) {
    names.push_back(name);
    listed += (listed.empty() ? "" : ", ") + name;
  }
  throw InputError("", "hand", "the name of a hand (" + listed + ") or a hand.lua",
                   '"' + name_or_file + '"' + FormatHint(FindNearest(name_or_file, names)));
}

const HandModel& FindHand(const std::string& name_or_file) {
  static std::mutex mutex;
  static std::map<fs::path, std::unique_ptr<const HandModel>> hands;
  const std::lock_guard lock(mutex);
  const fs::path file = FileOfHand(name_or_file);
  std::unique_ptr<const HandModel>& hand = hands[fs::absolute(file).lexically_normal()];
  if (!hand) {
    HandReading reading = ReadHand(file);
    if (!reading.faults.empty()) throw InputError(reading.faults.front());
    hand = std::make_unique<const HandModel>(std::move(reading.hand));
  }
  return *hand;
}

const HandModel& ShadowHand() {
  static const HandModel& hand = FindHand(kDefaultHand);
  return hand;
}

const HandModel& HandOf(const Scene& scene) { return FindHand(scene.hand); }

void TakeHand(Scene& scene) { scene.tips = HandOf(scene).tip_spheres(); }

}  // namespace pregrasp
