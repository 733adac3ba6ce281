#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/core/error.h"
#include "app/networks/set_encoder.h"

namespace pregrasp {

float SetEncoderConfig::ScaledDistance(double phi) const {
  return static_cast<float>(std::clamp(phi, phi_min, phi_max) * phi_scale);
}

std::string SetEncoderConfig::ToJson() const {
  nlohmann::ordered_json json;
  json["levels"] = nlohmann::ordered_json::array();
  for (const SetLevelConfig& level : levels) {
    json["levels"].push_back({{"centroids", level.centroids},
                              {"radius", level.radius},
                              {"neighbors", level.neighbors},
                              {"widths", level.widths}});
  }
  json["global_widths"] = global_widths;
  json["code_widths"] = code_widths;
  json["position_scale"] = position_scale;
  json["phi_scale"] = phi_scale;
  json["phi_min"] = phi_min;
  json["phi_max"] = phi_max;
  return json.dump();
}

SetEncoderConfig SetEncoderConfig::FromJson(const std::string& text, const std::string& where) {
  SetEncoderConfig config;
  try {
    const auto json = nlohmann::json::parse(text);
    config.levels.clear();
    for (const auto& level : json.at("levels")) {
      config.levels.push_back({level.at("centroids").get<int>(), level.at("radius").get<double>(),
                               level.at("neighbors").get<int>(),
                               level.at("widths").get<std::vector<int>>()});
    }
    config.global_widths = json.at("global_widths").get<std::vector<int>>();
    config.code_widths = json.at("code_widths").get<std::vector<int>>();
    config.position_scale = json.at("position_scale").get<double>();
    config.phi_scale = json.at("phi_scale").get<double>();
    config.phi_min = json.at("phi_min").get<double>();
    config.phi_max = json.at("phi_max").get<double>();
  } catch (const nlohmann::json::exception& e) {
    throw InputError(where, "encoder", "an encoder's configuration", e.what());
  }
  config.Validate(where);
  return config;
}

void SetEncoderConfig::Validate(const std::string& where) const {
  constexpr int kMaxWidth = 4096;
  const auto check = [&](bool holds, const char* field, const char* expected) {
    if (!holds) throw InputError(where, field, expected, "");
  };
  const auto check_widths = [&](const std::vector<int>& widths, const char* field) {
    check(!widths.empty() && widths.size() <= 16, field, "1 to 16 layers");
    for (const int width : widths) check(width >= 1 && width <= kMaxWidth, field, "widths to 4096");
  };
  check(!levels.empty() && levels.size() <= 8, "levels", "1 to 8 levels");
  int points = kMaxWidth;
  for (const SetLevelConfig& level : levels) {
    check(level.centroids >= 1 && level.centroids <= points, "levels.centroids",
          "at least 1, and no more than the level before");
    check(level.radius > 0.0 && level.radius <= 10.0, "levels.radius", "a radius in m");
    check(level.neighbors >= 1 && level.neighbors <= kMaxWidth, "levels.neighbors", "1 to 4096");
    check_widths(level.widths, "levels.widths");
    points = level.centroids;
  }
  check_widths(global_widths, "global_widths");
  check_widths(code_widths, "code_widths");
  check(position_scale >= 0.0 && position_scale <= 1e4, "position_scale", "a scale");
  check(phi_scale >= 0.0 && phi_scale <= 1e4, "phi_scale", "a scale");
  check(phi_min < phi_max && phi_min >= -10.0 && phi_max <= 10.0, "phi_min", "less than phi_max");
}

SetEncoderConfig PaperSetEncoderConfig() {
  SetEncoderConfig config;
  config.levels = {{128, 0.02, 64, {32, 32, 64}}, {32, 0.04, 128, {64, 64, 64, 128}}};
  config.global_widths = {128, 128, 128, 256};
  config.code_widths = {256, 512, 512};
  return config;
}

}  // namespace pregrasp
