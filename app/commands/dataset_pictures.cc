#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands/dataset.h"
#include "app/commands/progress.h"
#include "app/core/error.h"
#include "app/geometry/tessellate.h"
#include "app/pictures/camera.h"
#include "app/training/dataset_run.h"
#include "render/hand_bodies.h"
#include "render/palette.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr int kColumns = 4, kRows = 3;  // of a contact sheet
constexpr int kWidth = 640, kHeight = 480;

struct PictureOptions {
  ItemOptions items;
  fs::path grasps, generator, out;
  int count = 48;
};

std::string Shares(const LabelRecord& label) {
  std::string text;
  for (int r = 0; r < kNumReliefs; ++r) {
    text +=
        fmt::format("{}{:.0f} mm: {}", r == 0 ? "" : ", ", 1e3 * kReliefs[r], label.feasible[r]);
  }
  return fmt::format("feasible of {}: {}", label.tries, text);
}

// The scene at the least relief that has a feasible completion, with its hand; else as it is.
RenderScene Compose(const SceneLabeler& labeler, const std::string& title, const LabelRecord& label,
                    const std::optional<LabelExample>& example) {
  const Scene& scene = labeler.world().scene();
  const auto X_WB = MoveSurroundingsAway(scene, labeler.cloud().P, example ? example->relief : 0.0);
  RenderScene picture;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    RenderBody body;
    body.mesh = std::make_shared<TriangleMesh>(Tessellate(scene.bodies[b].shape));
    body.X_WB = X_WB[b];
    picture.bodies.push_back(WithLook(body, b == 0 ? ObjectColor() : TableColor()));
  }
  const TriangleMesh object_W{TransformPoints(X_WB[0], picture.bodies[0].mesh->V),
                              picture.bodies[0].mesh->F};
  MatrixX3 focus_W = FocusAround(object_W.V, 0.15, 0.04);
  if (example) {
    AddHand(picture, HandOf(scene), example->hand);
    focus_W = FocusAround(focus_W, 0.25, 0.0);
    for (const GraspContact& contact : example->contacts) {
      picture.points.push_back({X_WB[0] * contact.p_OC, 0.003F, FingerColor(contact.finger)});
    }
  }
  for (int f = 0; f < kNumPlanningFingers; ++f) {
    if (!label.contacts[f]) continue;
    const Finger finger = static_cast<Finger>(f);
    const Vector3 p_W = X_WB[0] * label.contacts[f]->p_OC;
    const Vector3 nhat_W = X_WB[0].linear() * label.contacts[f]->nhat_O;
    picture.arrows.push_back({p_W + 0.05 * nhat_W, -0.05 * nhat_W, 0.002F, FingerColor(finger)});
    picture.labels.push_back({p_W + 0.05 * nhat_W, FingerName(finger), FingerColor(finger)});
  }
  const Vector3 view_W =
      ChooseViewDirection(object_W, EnvironmentDistance(scene), Vector3::UnitZ());
  picture.camera = FrameCamera(focus_W, view_W, static_cast<double>(kWidth) / kHeight);
  picture.axes = false;
  picture.caption.title = fmt::format("{:.2f}  {}", label.Value(), title);
  picture.caption.footer = Shares(label);
  return picture;
}

void Paste(const Image& image, int column, int row, Image& sheet) {
  for (int y = 0; y < image.height; ++y) {
    const auto from = image.rgb.begin() + static_cast<std::ptrdiff_t>(3) * image.width * y;
    const std::ptrdiff_t to = (row * image.height + y) * sheet.width + column * image.width;
    std::copy_n(from, 3 * image.width, sheet.rgb.begin() + 3 * to);
  }
}

int MakePictures(const PictureOptions& options) {
  const ItemConfig config = options.items.Resolve();
  const Dataset dataset = ReadDataset(options.grasps);
  RequireDescription(dataset, config, options.grasps);
  const GraspGenerator generator = GraspGenerator::Load(options.generator);
  fs::create_directories(options.out);
  Renderer renderer;
  ProgressLine line;
  Image sheet;
  for (int k = 0; k < options.count; ++k) {
    Rng rng(config.seed, RngStream::kPicturedItems, k);
    const DatasetItem& item =
        dataset.items[rng.UniformInt(static_cast<std::uint32_t>(dataset.items.size()))];
    std::vector<int> contexts;
    for (std::size_t c = 0; c < item.contexts.size(); ++c) {
      if (item.contexts[c].relief == 0.0) contexts.push_back(static_cast<int>(c));
    }
    const int context = contexts[rng.UniformInt(static_cast<std::uint32_t>(contexts.size()))];
    const SceneObject object = MakeItemObject(config, item.index);
    const SceneLabeler labeler(config, item, object, context, generator);
    std::optional<LabelExample> example;
    const LabelRecord label = labeler.MakeLabel(
        static_cast<int>(rng.UniformInt(static_cast<std::uint32_t>(config.labels.per_scene))),
        &example);
    const std::string title =
        fmt::format("{} {}, {}", item.index, item.name, item.contexts[context].kind);
    const int cell = k % (kColumns * kRows);
    if (cell == 0) {
      sheet = {kColumns * kWidth, kRows * kHeight, {}};
      sheet.rgb.assign(static_cast<std::size_t>(3) * sheet.width * sheet.height, 255);
    }
    Paste(renderer.Render(Compose(labeler, title, label, example),
                          {kWidth, kHeight, RenderQuality::kDraft}),
          cell % kColumns, cell / kColumns, sheet);
    if (cell == kColumns * kRows - 1 || k == options.count - 1) {
      WritePng(sheet, options.out / fmt::format("labels-{}.png", k / (kColumns * kRows) + 1));
    }
    line.Show("labels", k + 1, options.count);
  }
  return 0;
}

}  // namespace

void AddDatasetPictures(const Subcommand& dataset, Action& action) {
  auto options = std::make_shared<PictureOptions>();
  const Subcommand command = dataset.AddCommand(
      "pictures", "Contact sheets of random labels, each with a hand that made it");
  command.Add("GRASPS", options->grasps, "Merged data set of grasps").Required();
  command.Add("--generator", options->generator, "Weights of the grasp generators").Required();
  command.Add("--out", options->out, "Folder of the sheets").Required();
  command.Add("--count", options->count, "Labels").Within({1, 100'000, 1}).ShowDefault();
  options->items.AddTo(command);
  options->items.AddLabelsTo(command);
  command.OnChosen([options, &action] { action = [options] { return MakePictures(*options); }; });
}

}  // namespace pregrasp
