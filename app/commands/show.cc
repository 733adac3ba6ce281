#include <fmt/core.h>

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/commands/commands.h"
#include "app/core/error.h"
#include "app/core/json_text.h"
#include "app/recording/checked_file.h"
#include "app/recording/loaded_run.h"
#include "app/session/motion_film.h"
#include "app/session/picture_file.h"

namespace pregrasp {
namespace {

struct ShowOptions {
  std::string run, step, out, size;
  std::vector<std::string> overlay;
};

// The picture that the run took of the step; the usual one where it took none.
Shot FindShot(const LoadedRun& run, const std::string& step) {
  const std::filesystem::path file = run.directory / "pictures.jsonl";
  if (!std::filesystem::exists(file)) return {};
  std::istringstream lines(ReadFile(file));
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json value = ParseJson(line, file.string());
    if (value.value("step", "") == step) return ShotFromJson(value, file.string());
  }
  return {};
}

// "1280x720".
void SetSize(const std::string& size, PictureConfig& config) {
  std::istringstream in(size);
  char x = 0;
  int width = 0, height = 0;
  if (!(in >> width >> x >> height) || x != 'x' || in.peek() != EOF) {
    throw InputError("--size", "", "WIDTHxHEIGHT in pixels", '"' + size + '"');
  }
  for (const int pixels : {width, height})
    RequireWithin("--size", "", {16, 8192, 1, "pixels"}, pixels);
  config.width = width;
  config.height = height;
}

// The whole hand motion, of which no step and nothing about pictures can be asked.
int ShowMotion(const ShowOptions& options) {
  for (const auto& [flag, given] : {std::pair("--step", !options.step.empty()),
                                    std::pair("--overlay", !options.overlay.empty()),
                                    std::pair("--size", !options.size.empty())}) {
    if (given) throw InputError(flag, "", "a picture, --out FILE.png", options.out);
  }
  WriteMotionFilm(LoadRun(options.run), options.out);
  return 0;
}

int Show(const ShowOptions& options) {
  if (std::filesystem::path(options.out).extension() == ".glb") return ShowMotion(options);
  if (options.step.empty()) {
    throw InputError("--step", "", "a step's id, as in steps.jsonl: path.1.mppi.5", "nothing");
  }
  const LoadedRun run = LoadRun(options.run);
  const StepFacts& step = run.Get(options.step);
  Shot shot = FindShot(run, options.step);
  if (!options.overlay.empty()) SetOverlays(shot.config, options.overlay);
  if (!options.size.empty()) SetSize(options.size, shot.config);
  shot.config.Validate();
  PictureDrawer drawer(run.scene,
                       {run.summary.seed, run.manifest.value("scene_file", run.scene.name),
                        run.manifest.value("command", "")});
  if (std::filesystem::path(options.out).extension() == ".3Dscene") {
    drawer.WriteScene(step, run, shot, options.out);
  } else {
    drawer.Draw(step, run, shot, options.out);
  }
  return 0;
}

}  // namespace

void AddShow(const Subcommand& app, Action& action) {
  auto options = std::make_shared<ShowOptions>();
  const Subcommand command =
      app.AddCommand("show",
                     "Draw a step of a finished run, or write its hand motion as an animation, "
                     "without planning again");
  command.Add("RUN_DIR", options->run, "The run directory").Required();
  command.Add("--step", options->step,
              "Of a picture: the step's id, as in steps.jsonl: path.1.mppi.5");
  command
      .Add("--out", options->out,
           "FILE.png, a picture of the step; FILE.3Dscene, the same for MRPT's SceneViewer3D; "
           "FILE.glb, the scene and the hand's motion as "
           "binary glTF, for modelling programs and web viewers")
      .Required();
  command.Add("--size", options->size, "WIDTHxHEIGHT in pixels; as the run took it by default");
  command
      .Add("--overlay", options->overlay,
           "What to show: forces, cones, contacts, trace, ghost, fingers, axes, mesh, scores, "
           "rollouts, hand; as the run took it by default")
      .OneAtATime();
  command.OnChosen([options, &action] { action = [options] { return Show(*options); }; });
}

}  // namespace pregrasp
