#include <fmt/core.h>

#include <array>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/commands/commands.h"
#include "app/commands/progress.h"
#include "app/core/error.h"
#include "app/page/figure.h"
#include "app/page/film.h"
#include "app/page/page.h"
#include "app/page/pair.h"
#include "app/page/run_steps.h"
#include "app/page/strip.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "app/recording/partial_directory.h"
#include "app/session/motion_film.h"
#include "app/session/picture_file.h"

namespace pregrasp {
namespace {

struct ShowOptions {
  std::string run, step, what, against, out, size, camera;
  std::vector<std::string> steps, overlay;
  double font_scale = 0.0;  // 0: as the picture has it
  bool no_card = false, no_legend = false, no_footer = false, no_axes = false;

  // Flags about pictures that were given, for what shows no picture.
  std::vector<const char*> PictureFlags() const {
    std::vector<const char*> flags;
    for (const auto& [flag, given] :
         {std::pair("--overlay", !overlay.empty()), std::pair("--size", !size.empty()),
          std::pair("--camera", !camera.empty()), std::pair("--font-scale", font_scale != 0.0),
          std::pair("--no-card", no_card), std::pair("--no-legend", no_legend),
          std::pair("--no-footer", no_footer), std::pair("--no-axes", no_axes)}) {
      if (given) flags.push_back(flag);
    }
    return flags;
  }
};

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

// Directions to look from, a little from above.
struct NamedView {
  const char* name;
  Vector3 direction;
};
const std::array<NamedView, 5> kViews{{{"front", {0.0, -1.0, 0.35}},
                                       {"back", {0.0, 1.0, 0.35}},
                                       {"left", {-1.0, 0.0, 0.35}},
                                       {"right", {1.0, 0.0, 0.35}},
                                       {"top", {0.0, 0.0, 1.0}}}};

// The direction that --camera names; none for "run" and none given.
std::optional<Vector3> FindView(const std::string& name) {
  if (name.empty() || name == "run") return std::nullopt;
  std::string all = "run";
  for (const NamedView& view : kViews) {
    if (name == view.name) return view.direction;
    all += std::string(", ") + view.name;
  }
  throw InputError("--camera", "", "one of " + all, '"' + name + '"');
}

// A camera that is shared was framed for the picture's shape: a narrower one shows as much from
// left to right.
void Widen(double aspect_before, PictureConfig& config) {
  const double aspect = static_cast<double>(config.width) / config.height;
  if (!config.camera || aspect >= aspect_before) return;
  const double tangent = std::tan(0.5 * DegToRad(config.camera->fov_deg));
  config.camera->fov_deg = RadToDeg(2.0 * std::atan(tangent * aspect_before / aspect));
}

void ApplyOptions(const ShowOptions& options, PictureConfig& config) {
  if (!options.overlay.empty()) SetOverlays(config, options.overlay);
  if (!options.size.empty()) SetSize(options.size, config);
  if (options.font_scale != 0.0) config.font_scale = options.font_scale;
  config.card = config.card && !options.no_card;
  config.legend = config.legend && !options.no_legend;
  config.footer = config.footer && !options.no_footer;
  config.axes = config.axes && !options.no_axes;
  config.Validate();
}

// What shows a whole run has no step, and no pictures of its own: refuses flags about these.
void RefuseFlags(const ShowOptions& options, bool pictures) {
  if (!options.step.empty()) {
    throw InputError("--step", "", "a picture of the step, --out FILE.png or FILE.3Dscene",
                     options.out);
  }
  for (const auto& [flag, given] : {std::pair("--steps", !options.steps.empty()),
                                    std::pair("--against", !options.against.empty())}) {
    if (given) throw InputError(flag, "", "a picture, --out FILE.png", options.out);
  }
  if (pictures) return;
  const std::vector<const char*> flags = options.PictureFlags();
  if (!flags.empty()) {
    throw InputError(flags.front(), "", "a picture, --out FILE.png, or a film, FILE.mp4",
                     options.out);
  }
}

int ShowStep(const ShowOptions& options) {
  for (const auto& [flag, given] : {std::pair("--steps", !options.steps.empty()),
                                    std::pair("--against", !options.against.empty())}) {
    if (given) throw InputError(flag, "", "no --step beside it", "--step " + options.step);
  }
  const std::optional<Vector3> view = FindView(options.camera);
  const LoadedRun run = LoadRun(options.run);
  const StepFacts& step = run.Get(options.step);
  Shot shot = FindShot(run.directory, options.step);
  const double aspect = static_cast<double>(shot.config.width) / shot.config.height;
  ApplyOptions(options, shot.config);
  if (shot.shares_camera) Widen(aspect, shot.config);
  PictureDrawer drawer(run.scene, LabelsOf(run));
  if (options.camera == "run") {
    const RunSteps steps(run);
    std::vector<const StepFacts*> story = steps.FindStory(run.steps.size());
    story.push_back(&step);
    shot.config.camera =
        drawer.FrameOnWay(drawer.FrameSteps(story, run, shot.config), step, run, shot.config);
  } else if (view) {
    shot.config.camera = drawer.FrameSteps({&step}, run, shot.config, view);
  }
  if (std::filesystem::path(options.out).extension() == ".3Dscene") {
    drawer.WriteScene(step, run, shot, options.out);
  } else {
    drawer.Draw(step, run, shot, options.out);
  }
  return 0;
}

// Steps of the run in one picture: of its story, those of --steps, or beside another run's.
int ShowSheet(const ShowOptions& options) {
  const std::optional<Vector3> view = FindView(options.camera);
  Shot shot;
  shot.config.width = options.against.empty() ? 1920 : 2400;
  shot.config.height = 1440;
  ApplyOptions(options, shot.config);
  const LoadedRun run = LoadRun(options.run);
  if (!options.against.empty()) {
    const LoadedRun other = LoadRun(options.against);
    WritePng(DrawPairOfRuns(run, other, options.steps, shot, view), options.out);
  } else if (!options.steps.empty()) {
    WritePng(DrawStripOfRun(run, options.steps, shot, view), options.out);
  } else {
    WritePng(DrawContactSheet(run, shot, view), options.out);
  }
  return 0;
}

int ShowFilm(const ShowOptions& options) {
  RefuseFlags(options, true);
  const std::optional<Vector3> view = FindView(options.camera);
  Shot shot;
  const bool small = std::filesystem::path(options.out).extension() == ".gif";
  shot.config.width = small ? 480 : 960;
  shot.config.height = small ? 270 : 540;
  shot.config.quality = RenderQuality::kNormal;
  if (small) shot.config.card = shot.config.footer = false;
  ApplyOptions(options, shot.config);
  ProgressLine line;
  WriteFilm(LoadRun(options.run), shot, view, options.out,
            [&](int done, int total) { line.Show("film", done, total); });
  return 0;
}

// What --steps lists, which is one word with commas each time that it is given.
std::vector<std::string> SplitSteps(const std::vector<std::string>& lists) {
  std::vector<std::string> ids;
  for (const std::string& list : lists) {
    std::istringstream in(list + ',');
    for (std::string id; std::getline(in, id, ',');) {
      if (id.empty()) {
        throw InputError("--steps", "", "the ids of steps with a comma between two",
                         '"' + list + '"');
      }
      ids.push_back(id);
    }
  }
  return ids;
}

int Show(ShowOptions options) {
  options.steps = SplitSteps(options.steps);
  const std::filesystem::path out = options.out;
  RequireOutsideRuns(out);
  for (const std::string& run : {options.run, options.against}) {
    if (run.empty() || !IsFinishedRun(run)) continue;
    if (const auto mismatch = VerifyManifest(run)) {
      fmt::print(stderr, "{}: warning: {}\n", run, mismatch->Sentence());
    }
  }
  const std::string kind = out.extension().string();
  if (!options.what.empty() && kind != ".svg") {
    throw InputError("--what", "", "a drawing, --out FILE.svg", options.out);
  }
  if (kind == ".glb") {
    RefuseFlags(options, false);
    WriteMotionFilm(LoadRun(options.run), out);
    return 0;
  }
  if (kind == ".html") {
    RefuseFlags(options, false);
    WritePage(LoadRun(options.run), out);
    return 0;
  }
  if (kind == ".svg") {
    RefuseFlags(options, false);
    WriteFigure(LoadRun(options.run), options.what, out);
    return 0;
  }
  if (IsFilmFile(out)) return ShowFilm(options);
  if (!options.step.empty() && (kind == ".png" || kind == ".3Dscene")) return ShowStep(options);
  if (options.step.empty() && kind == ".png") return ShowSheet(options);
  throw InputError("--out", "",
                   "FILE.png, .svg, .html, .mp4, .webm, .gif or .glb, or with --step FILE.3Dscene",
                   '"' + options.out + '"');
}

}  // namespace

void AddShow(const Subcommand& app, Action& action) {
  auto options = std::make_shared<ShowOptions>();
  const Subcommand command = app.AddCommand(
      "show",
      "Show a finished run without planning again: a step as a picture, or the whole run as a "
      "page, a sheet of pictures, a film or an animation, by the name of the file");
  command.Add("RUN_DIR", options->run, "The run directory").Required();
  command.Add("--step", options->step,
              "Of a picture: the step's id, as in steps.jsonl: path.1.mppi.5");
  command
      .Add("--steps", options->steps,
           "Of a strip: the steps' ids with commas, all by one camera, before,after or more")
      .OneAtATime();
  command.Add("--what", options->what,
              "Of a drawing: costs, of the iterations along each path; graph, the contact states "
              "that are kept");
  command.Add("--against", options->against,
              "Of a pair: another run directory, below the first one step by step, from where they "
              "first differ to what they came to; with --steps those");
  command
      .Add("--out", options->out,
           "FILE.html, the run as a page that explains itself; FILE.png, a picture of the step, a "
           "strip of the steps, a pair of runs, or without these a sheet of the run's key steps; "
           "FILE.svg, a drawing for print; FILE.3Dscene, the step for MRPT's "
           "SceneViewer3D; FILE.mp4, .webm or .gif, the hand's motion as a film, by the program "
           "ffmpeg; FILE.glb, the same as binary glTF, for modelling programs and web viewers")
      .Required();
  command.Add("--size", options->size,
              "WIDTHxHEIGHT in pixels; a picture is as the run took it by default");
  command
      .Add("--overlay", options->overlay,
           "What to show: forces, cones, contacts, trace, ghost, fingers, axes, mesh, scores, "
           "rollouts, hand; as the run took it by default")
      .OneAtATime();
  command.Add("--camera", options->camera,
              "run (one for all key steps), front, back, left, right or top; a picture of a step "
              "has by default the one that the run took it by, one for all that nobody named "
              "another for");
  command.Add("--font-scale", options->font_scale, "Size of all type, 1 is as usual")
      .Within(PictureConfig::kFontScale);
  command.AddFlag("--no-card", options->no_card, "Without title and sentences");
  command.AddFlag("--no-legend", options->no_legend, "Without what colours mean");
  command.AddFlag("--no-footer", options->no_footer, "Without the line at the bottom");
  command.AddFlag("--no-axes", options->no_axes, "Without the world's axes");
  command.OnChosen([options, &action] { action = [options] { return Show(*options); }; });
}

}  // namespace pregrasp
