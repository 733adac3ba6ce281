#include "app/scene/settings.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>

#include "app/core/error.h"
#include "app/core/text.h"
#include "app/scene/limits.h"

namespace pregrasp {
namespace {

double ParseNumber(const Setting& setting, std::string_view text, const NumberRange& range) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw InputError(setting.where, setting.key, range.Expected(), '"' + std::string(text) + '"');
  }
  RequireWithin(setting.where, setting.key, range, value);
  return value;
}

// "x,y,z", with or without the braces of a scene file.
Vector3 ParseVector(const Setting& setting, const NumberRange& range) {
  std::string_view text = setting.value;
  if (text.size() >= 2 && text.front() == '{' && text.back() == '}') {
    text = text.substr(1, text.size() - 2);
  }
  Vector3 v;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) {
      throw InputError(setting.where, setting.key, "three numbers x,y,z",
                       '"' + setting.value + '"');
    }
    v[i] = ParseNumber(setting, text.substr(0, comma), range);
    text.remove_prefix(i == 2 ? text.size() : comma + 1);
  }
  return v;
}

using Setter = std::function<void(const Setting&)>;
using Setters = std::map<std::string, Setter>;

Setter SetNumber(double& target, const NumberRange& range) {
  return [&target, &range](const Setting& setting) {
    target = ParseNumber(setting, setting.value, range);
  };
}

Setter SetVector(Vector3& target, const NumberRange& range) {
  return [&target, &range](const Setting& setting) { target = ParseVector(setting, range); };
}

Setter SetText(std::string& target) {
  return [&target](const Setting& setting) { target = setting.value; };
}

void AddBody(Setters& setters, const std::string& prefix, Body& body) {
  setters[prefix + ".name"] = SetText(body.name);
  setters[prefix + ".friction"] = SetNumber(body.friction, kFrictionRange);
  setters[prefix + ".p"] = [&body](const Setting& setting) {
    body.X_WB.translation() = ParseVector(setting, kPositionRange);
  };
  setters[prefix + ".rpy_deg"] = [&body](const Setting& setting) {
    body.X_WB.linear() = RotationFromRpy(ParseVector(setting, kAngleRange) * (kPi / 180.0));
  };
  setters[prefix + ".mass"] = [&body](const Setting& setting) {
    const double mass = ParseNumber(setting, setting.value, kMassRange);
    if (!body.mass_properties) body.mass_properties.emplace();
    MassProperties& properties = *body.mass_properties;
    // An inertia that the scene gave follows the mass: the same body, denser.
    if (properties.mass > 0.0) properties.I_BBcm *= mass / properties.mass;
    properties.mass = mass;
  };
}

Setters SettersOf(Scene& scene) {
  Setters setters;
  setters["name"] = SetText(scene.name);
  setters["hand"] = SetText(scene.hand);
  setters["gravity"] = SetVector(scene.gravity, kGravityRange);
  AddBody(setters, "object", scene.object());
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    AddBody(setters, "environment." + scene.bodies[i].name, scene.bodies[i]);
  }
  setters["fingertips.friction"] = SetNumber(scene.fingertips.friction, kFrictionRange);
  setters["fingertips.max_force"] = SetNumber(scene.fingertips.max_force, kForceRange);
  setters["fingertips.stiffness"] = SetNumber(scene.fingertips.stiffness, kStiffnessRange);
  setters["fingertips.damping"] = SetNumber(scene.fingertips.damping, kDampingRange);
  setters["fingertips.grasp_stiffness"] =
      SetNumber(scene.fingertips.grasp_stiffness, kStiffnessRange);
  if (scene.camera) {
    setters["camera.p"] = SetVector(scene.camera->p_WCam, kPositionRange);
    setters["camera.look_at"] = SetVector(scene.camera->p_WTarget, kPositionRange);
    setters["camera.fov_deg"] = SetNumber(scene.camera->fov_deg, kFovRange);
  }
  return setters;
}

// What messages of ValidateScene call what a setting changes.
std::string FieldOf(const Scene& scene, const std::string& key) {
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    const std::string prefix = "environment." + scene.bodies[i].name + '.';
    if (key.starts_with(prefix)) {
      return "environment[" + std::to_string(i) + "]." + key.substr(prefix.size());
    }
  }
  return key;
}

std::string RootOf(const std::string& key) { return key.substr(0, key.find('.')); }

}  // namespace

Setting ParseSetting(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == assignment.size()) {
    throw InputError(Setting{}.where, "", "key=value, as in fingertips.friction=0.5",
                     '"' + assignment + '"');
  }
  return {assignment.substr(0, equals), assignment.substr(equals + 1)};
}

void ApplySceneSettings(Scene& scene, std::vector<Setting>& settings) {
  const Setters setters = SettersOf(scene);
  std::vector<std::string> legal, roots;
  for (const auto& [key, setter] : setters) {
    legal.push_back(key);
    roots.push_back(RootOf(key));
  }
  std::vector<Setting> left;
  std::map<std::string, const Setting*> taken;  // by field; what they say may rename bodies
  for (const Setting& setting : settings) {
    if (setters.contains(setting.key)) taken[FieldOf(scene, setting.key)] = &setting;
  }
  for (const Setting& setting : settings) {
    if (const auto setter = setters.find(setting.key); setter != setters.end()) {
      setter->second(setting);
    } else if (std::find(roots.begin(), roots.end(), RootOf(setting.key)) == roots.end()) {
      left.push_back(setting);
    } else {
      RequireNoSettingsLeft({setting}, legal);
    }
  }
  try {
    if (!taken.empty()) ValidateScene(scene);
  } catch (const InputError& error) {
    const auto found = taken.find(error.field());
    if (found == taken.end()) throw;
    const Setting& setting = *found->second;
    throw InputError(setting.where, setting.key, error.expected(), error.got());
  }
  settings = std::move(left);
}

void RequireNoSettingsLeft(const std::vector<Setting>& settings,
                           const std::vector<std::string>& known) {
  if (settings.empty()) return;
  const auto& [key, value, where] = settings.front();
  const std::string nearest = FindNearest(key, known);
  throw InputError(where, "",
                   nearest.empty()
                       ? "a key that can be set, as object.mass or mppi.sigma (pregrasp info "
                         "--settings lists the planner's)"
                       : "a key that can be set",
                   "\"" + key + "\"" + FormatHint(nearest));
}

}  // namespace pregrasp
