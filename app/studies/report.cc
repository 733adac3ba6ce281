#include "app/studies/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "app/batch/item_folder.h"
#include "app/core/error.h"
#include "app/core/json_reader.h"
#include "app/core/json_text.h"
#include "app/job/planner_settings.h"
#include "app/recording/loaded_run.h"
#include "app/recording/manifest.h"
#include "app/session/picture_file.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

// "mppi.sigma = 0.5, paths.order = paper": what is not as by default.
std::string ChangedSettings(const nlohmann::json& settings) {
  const nlohmann::json defaults = PlannerSettings({});
  std::string text;
  for (const auto& [name, value] : settings.items()) {
    if (defaults.contains(name) && defaults[name] == value) continue;
    text += (text.empty() ? "" : ", ") + fmt::format("{} = {}", name, value.dump());
  }
  return text.empty() ? "all settings as by default" : text;
}

std::string DescribeStudy(const nlohmann::json& description, const std::string& where) {
  const JsonReader fields(description, where);
  return fmt::format("Seeds {} to {}, at most {:.0f} paths; {}. Program {} of commit {}.\n\n",
                     description.value("first_seed", std::uint64_t{0}),
                     description.value("first_seed", std::uint64_t{0}) +
                         static_cast<std::uint64_t>(fields["seeds"].Number()) - 1,
                     fields["paths"].Number(), ChangedSettings(fields["settings"].json()),
                     fields["version"].Text(), fields["git"].Text());
}

// The run of each scene that is shown, in the order of the folders' names.
std::map<std::string, LoadedRun> ChooseRuns(const fs::path& runs) {
  std::map<std::string, LoadedRun> chosen;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(runs)) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders) {
    if (!IsFinishedRun(folder)) continue;
    LoadedRun run = LoadRun(folder);
    const auto known = chosen.find(run.summary.scene);
    if (known == chosen.end()) {
      chosen.emplace(run.summary.scene, std::move(run));
    } else if (known->second.summary.status != "ok" && run.summary.status == "ok") {
      known->second = std::move(run);
    }
  }
  return chosen;
}

// Draws the runs and refers to the pictures.
std::string ShowRuns(const fs::path& runs, const fs::path& pictures, const std::string& study) {
  std::string text;
  fs::create_directories(pictures);
  for (const auto& [scene, run] : ChooseRuns(runs)) {
    Shot shot;
    shot.config.width = 640;
    shot.config.height = 360;
    const std::string name = fmt::format("{}-{}-{}.png", study, scene, run.summary.seed);
    PictureDrawer drawer(run.scene, {run.summary.seed, scene, run.manifest.value("command", "")});
    drawer.Draw(run.steps.back(), run, shot, pictures / name);
    text +=
        fmt::format("\n{} with seed {}: {}\n\n![{}]({}/{})\n", scene, run.summary.seed,
                    run.summary.status.value_or("-"), scene, pictures.filename().string(), name);
  }
  return text;
}

// Copies the study's plots to the pictures and refers to them.
std::string ShowPlots(const fs::path& folder, const fs::path& pictures) {
  std::vector<fs::path> plots;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".svg") plots.push_back(entry.path());
  }
  std::sort(plots.begin(), plots.end());
  std::string text;
  for (const fs::path& plot : plots) {
    fs::create_directories(pictures);
    WriteWholeFile(pictures / plot.filename(), ReadWholeFile(plot));
    text += fmt::format("\n![{}]({}/{})\n", plot.stem().string(), pictures.filename().string(),
                        plot.filename().string());
  }
  return text;
}

}  // namespace

void WriteReport(const std::vector<fs::path>& folders, const fs::path& file) {
  std::string text = "# Results\n\nMade by `pregrasp eval report";
  for (const fs::path& folder : folders) text += fmt::format(" {}", folder.string());
  text +=
      fmt::format(" --out {}`; the tables are what `pregrasp eval` left there.\n", file.string());
  for (const fs::path& folder : folders) {
    const fs::path description_file = folder / "items" / "description.json";
    const nlohmann::json description =
        ParseJson(ReadWholeFile(description_file), description_file.string());
    const std::string study = JsonReader(description, description_file.string())["study"].Text();
    text += fmt::format("\n## {}\n\n", study) +
            DescribeStudy(description, description_file.string()) +
            ReadWholeFile(folder / (study + ".md"));
    const fs::path pictures = fs::path(file).replace_extension();
    text += ShowPlots(folder, pictures);
    if (fs::is_directory(folder / "runs")) text += ShowRuns(folder / "runs", pictures, study);
  }
  WriteWholeFile(file, text);
}

}  // namespace pregrasp
