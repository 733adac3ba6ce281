#include "app/session/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "app/core/error.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"
#include "app/core/json_values.h"
#include "app/pictures/words.h"
#include "app/recording/checked_file.h"
#include "app/recording/mrpt_scene.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

// One OpenGL context for the whole process.
Renderer& SharedRenderer() {
  static Renderer renderer;
  return renderer;
}

// The overlays of a picture by their names in scripts, --overlay and pictures.jsonl.
struct OverlayFlag {
  const char* name;
  bool PictureConfig::*flag;
};
constexpr std::array<OverlayFlag, 11> kOverlays{{{"forces", &PictureConfig::forces},
                                                 {"cones", &PictureConfig::cones},
                                                 {"contacts", &PictureConfig::contacts},
                                                 {"trace", &PictureConfig::trace},
                                                 {"ghost", &PictureConfig::ghost},
                                                 {"fingers", &PictureConfig::fingers},
                                                 {"axes", &PictureConfig::axes},
                                                 {"mesh", &PictureConfig::mesh},
                                                 {"scores", &PictureConfig::scores},
                                                 {"rollouts", &PictureConfig::rollouts},
                                                 {"hand", &PictureConfig::hand}}};

// Its words, which are there unless a picture is to be without.
constexpr std::array<OverlayFlag, 3> kWords{{{"card", &PictureConfig::card},
                                             {"legend", &PictureConfig::legend},
                                             {"footer", &PictureConfig::footer}}};

const char* QualityName(RenderQuality quality) {
  switch (quality) {
    case RenderQuality::kDraft:
      return "draft";
    case RenderQuality::kNormal:
      return "normal";
    case RenderQuality::kStill:
      return "still";
  }
  return "";
}

}  // namespace

PictureMode ParsePictureMode(const std::string& text, const std::string& where,
                             const std::string& field) {
  if (text == "none") return PictureMode::kNone;
  if (text == "key") return PictureMode::kKey;
  if (text == "all") return PictureMode::kAll;
  throw InputError(where, field, "\"none\", \"key\" or \"all\"", '"' + text + '"');
}

void SetOverlays(PictureConfig& config, const std::vector<std::string>& names) {
  for (const OverlayFlag& overlay : kOverlays) config.*overlay.flag = false;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(kOverlays.begin(), kOverlays.end(),
                     [&](const OverlayFlag& overlay) { return name == overlay.name; });
    if (found == kOverlays.end()) {
      std::string all;
      for (const OverlayFlag& overlay : kOverlays) {
        if (!all.empty()) all += ", ";
        all += overlay.name;
      }
      throw InputError("", "overlay", "some of " + all, '"' + name + '"');
    }
    config.*found->flag = true;
  }
}

RenderQuality ParseQuality(const std::string& text) {
  for (const RenderQuality quality :
       {RenderQuality::kDraft, RenderQuality::kNormal, RenderQuality::kStill}) {
    if (text == QualityName(quality)) return quality;
  }
  throw InputError("", "quality", "\"draft\", \"normal\" or \"still\"", '"' + text + '"');
}

nlohmann::ordered_json ShotToJson(const Shot& shot) {
  nlohmann::ordered_json overlay = nlohmann::ordered_json::array();
  for (const OverlayFlag& flag : kOverlays) {
    if (shot.config.*flag.flag) overlay.push_back(flag.name);
  }
  nlohmann::ordered_json camera;
  if (shot.config.camera) {
    camera = {{"p_WCam", ToJson(shot.config.camera->p_WCam)},
              {"p_WTarget", ToJson(shot.config.camera->p_WTarget)},
              {"fov_deg", shot.config.camera->fov_deg}};
  }
  nlohmann::ordered_json json = {{"title", shot.title},
                                 {"caption", shot.caption},
                                 {"size", {shot.config.width, shot.config.height}},
                                 {"quality", QualityName(shot.config.quality)},
                                 {"overlay", std::move(overlay)},
                                 {"camera", std::move(camera)}};
  for (const OverlayFlag& word : kWords) {
    if (!(shot.config.*word.flag)) json["without"].push_back(word.name);
  }
  if (shot.shares_camera) json["shares_camera"] = true;
  if (shot.config.font_scale != 1.0) json["font_scale"] = shot.config.font_scale;
  return json;
}

Shot ShotFromJson(const nlohmann::json& value, const std::string& where) {
  const JsonReader reader(value, where);
  Shot shot;
  shot.title = reader["title"].Text();
  shot.caption = reader["caption"].Text();
  shot.config.width = static_cast<int>(reader["size"][0].Number());
  shot.config.height = static_cast<int>(reader["size"][1].Number());
  shot.config.quality = ParseQuality(reader["quality"].Text());
  std::vector<std::string> overlay;
  for (std::size_t i = 0; i < reader["overlay"].size(); ++i) {
    overlay.push_back(reader["overlay"][i].Text());
  }
  SetOverlays(shot.config, overlay);
  if (value.contains("without")) {
    for (std::size_t i = 0; i < reader["without"].size(); ++i) {
      const std::string name = reader["without"][i].Text();
      for (const OverlayFlag& word : kWords) {
        if (name == word.name) shot.config.*word.flag = false;
      }
    }
  }
  shot.shares_camera = value.contains("shares_camera") && reader["shares_camera"].Bool();
  if (value.contains("font_scale")) shot.config.font_scale = reader["font_scale"].Number();
  if (const JsonReader camera = reader["camera"]; !camera.is_null()) {
    shot.config.camera = CameraConfig{camera["p_WCam"].Vec3(), camera["p_WTarget"].Vec3(),
                                      camera["fov_deg"].Number()};
  }
  return shot;
}

Shot FindShot(const std::filesystem::path& run, const std::string& step) {
  const std::filesystem::path file = run / "pictures.jsonl";
  if (!std::filesystem::exists(file)) return {};
  std::istringstream lines(ReadFile(file));
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json value = ParseJson(line, file.string());
    if (value.value("step", "") == step) return ShotFromJson(value, file.string());
  }
  return {};
}

PictureDrawer::PictureDrawer(Scene scene, PictureLabels labels)
    : scene_(std::move(scene)), labels_(std::move(labels)) {}

PictureDrawer::~PictureDrawer() = default;

PictureText PictureDrawer::Caption(const StepFacts& step, const FactsSource& steps,
                                   const Shot& shot) const {
  PictureText text;
  text.title = fmt::format("{}   {}   t = {:.2f} s", scene_.name,
                           shot.title.empty() ? step.id : shot.title, step.t);
  text.lines = DescribeStep(scene_, step, steps);
  if (!shot.caption.empty()) text.lines = {shot.caption};
  text.footer = fmt::format("{} · seed {} · {} · t = {:.3f} s", labels_.scene_file, labels_.seed,
                            step.id, step.t);
  if (!labels_.command.empty()) text.footer += " · again: " + labels_.command;
  return text;
}

const PictureMaker& PictureDrawer::Maker() {
  if (!maker_) maker_ = std::make_unique<PictureMaker>(scene_);
  return *maker_;
}

RenderScene PictureDrawer::Compose(const StepFacts& step, const FactsSource& steps,
                                   const Shot& shot) {
  return Maker().Compose(step, steps, Caption(step, steps, shot), shot.config);
}

Image PictureDrawer::Render(const StepFacts& step, const FactsSource& steps, const Shot& shot) {
  const PictureConfig& config = shot.config;
  return SharedRenderer().Render(Compose(step, steps, shot),
                                 {config.width, config.height, config.quality});
}

MatrixX3 PictureDrawer::CalcFocus(const std::vector<const StepFacts*>& shown,
                                  const FactsSource& steps, const PictureConfig& config) {
  return Maker().CalcFocus(shown, steps, config);
}

CameraConfig PictureDrawer::Frame(const MatrixX3& focus_W, const PictureConfig& config,
                                  const std::optional<Vector3>& view) {
  return Maker().Frame(focus_W, config, view);
}

CameraConfig PictureDrawer::FrameSteps(const std::vector<const StepFacts*>& shown,
                                       const FactsSource& steps, const PictureConfig& config,
                                       const std::optional<Vector3>& view) {
  return Frame(CalcFocus(shown, steps, config), config, view);
}

CameraConfig PictureDrawer::FrameOnWay(const CameraConfig& camera, const StepFacts& step,
                                       const FactsSource& steps, const PictureConfig& config) {
  return Maker().FrameOnWay(camera, step, steps, config);
}

void PictureDrawer::ShareCamera(std::vector<StepPicture>& pictures, const FactsSource& steps) {
  Maker().ShareCamera(pictures, steps);
}

void PictureDrawer::Draw(const StepFacts& step, const FactsSource& steps, const Shot& shot,
                         const std::filesystem::path& file) {
  WritePng(Render(step, steps, shot), file);
}

void PictureDrawer::WriteScene(const StepFacts& step, const FactsSource& steps, const Shot& shot,
                               const std::filesystem::path& file) {
  const RenderScene picture = Compose(step, steps, shot);
  const auto color = [](const Rgba& c) { return MrptScene::Color{c.r, c.g, c.b, c.a}; };
  MrptScene scene;
  for (const RenderBody& body : picture.bodies) {
    MrptScene::Mesh mesh{body.mesh, body.X_WB, color(body.color), {}};
    for (const Rgba& face : body.face_colors) {
      mesh.face_colors.push_back(color(WithAlpha(face, body.color.a)));
    }
    scene.meshes.push_back(std::move(mesh));
  }
  for (const RenderArrow& arrow : picture.arrows) {
    scene.arrows.push_back({arrow.p_W, arrow.v_W, arrow.radius, color(arrow.color)});
  }
  for (const RenderPoint& point : picture.points) {
    scene.balls.push_back({point.p_W, point.radius, color(point.color)});
  }
  for (const RenderLine& line : picture.lines) {
    scene.lines.push_back({line.p_W, color(line.color)});
  }
  for (const RenderLabel& label : picture.labels) {
    scene.labels.push_back({label.p_W, label.text, color(label.color)});
  }
  WriteMrptScene(file, scene);
}

}  // namespace pregrasp
