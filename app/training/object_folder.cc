#include "app/training/object_folder.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "app/batch/item_folder.h"
#include "app/core/error.h"
#include "app/core/text.h"
#include "app/geometry/bounds.h"
#include "app/geometry/load_shape.h"
#include "app/geometry/mass_properties.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTable = "objects.csv";
constexpr double kLeastMass = 0.005;  // [kg]

// The cells of a line of a CSV table; those in quotes may hold commas, and "" for one quote.
std::vector<std::string> SplitCells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += line[++i];
      } else {
        quoted = !quoted;
      }
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

// What is known of a mesh before it is read.
struct MeshEntry {
  std::string file;
  std::string family = "mesh";
  std::optional<double> mass = std::nullopt;
};

double ParseMass(const std::string& word, const std::string& where) {
  double mass = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), mass);
  if (error != std::errc() || end != word.data() + word.size() || !(mass > 0.0 && mass < 100.0)) {
    throw InputError(where, "mass_kg", "a mass from 0 to 100 kg", '"' + word + '"');
  }
  return mass;
}

std::vector<MeshEntry> ReadTable(const fs::path& table) {
  std::istringstream lines(ReadWholeFile(table));
  std::string line;
  std::getline(lines, line);
  std::map<std::string, std::size_t> columns;
  for (const std::string& name : SplitCells(line)) columns.emplace(name, columns.size());
  if (!columns.count("file")) {
    throw InputError(table.string(), "", "a column \"file\" in the first line", OneLine(line));
  }
  std::vector<MeshEntry> entries;
  for (int number = 2; std::getline(lines, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::vector<std::string> cells = SplitCells(line);
    const auto cell = [&](const char* name) {
      const auto column = columns.find(name);
      return column != columns.end() && column->second < cells.size() ? cells[column->second]
                                                                      : std::string();
    };
    if (cell("quality") == "poor") continue;
    MeshEntry entry{cell("file")};
    if (!cell("category").empty()) entry.family = cell("category");
    const std::string where = table.string() + ":" + std::to_string(number);
    if (entry.file.empty()) throw InputError(where, "file", "the name of a mesh", "nothing");
    if (!cell("mass_kg").empty()) entry.mass = ParseMass(cell("mass_kg"), where);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<MeshEntry> ListMeshes(const fs::path& folder) {
  constexpr std::array kExtensions{".ply", ".obj", ".stl", ".off", ".dae"};
  std::vector<MeshEntry> entries;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end()) continue;
    entries.push_back({entry.path().filename().string()});
  }
  return entries;
}

TrainingObject ReadObject(const fs::path& folder, const MeshEntry& entry) {
  Mesh mesh;
  mesh.file = entry.file;
  TrainingObject object{entry.family, fs::path(entry.file).stem().string(), mesh};
  LoadShape(object.shape, folder, (folder / entry.file).string(), "");
  const Vector3 centre = CalcBounds(object.shape).center();
  if (auto* whole = std::get_if<Union>(&object.shape)) {  // a file of several solids
    for (PlacedShape& part : whole->parts) part.X_BP.translation() -= centre;
  } else {
    std::get<Mesh>(object.shape).mesh.V.rowwise() -= centre.transpose();
  }
  object.mass =
      entry.mass.value_or(std::max(kLeastMass, kObjectDensity * CalcVolume(object.shape)));
  return object;
}

}  // namespace

std::vector<TrainingObject> ReadObjectFolder(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string(), "", "a folder of meshes", "none");
  }
  std::vector<MeshEntry> entries =
      fs::exists(folder / kTable) ? ReadTable(folder / kTable) : ListMeshes(folder);
  if (entries.empty()) throw InputError(folder.string(), "", "meshes", "none");
  std::sort(entries.begin(), entries.end(),
            [](const MeshEntry& a, const MeshEntry& b) { return a.file < b.file; });
  std::vector<TrainingObject> objects;
  for (const MeshEntry& entry : entries) objects.push_back(ReadObject(folder, entry));
  return objects;
}

}  // namespace pregrasp
