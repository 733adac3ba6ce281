#pragma once

#include <filesystem>
#include <vector>

#include "app/training/object_families.h"

namespace pregrasp {

/// The meshes of a folder (.ply, .obj, .stl, .off, .dae), in the order of their names, as objects
/// to be judged or learned from: each centred on its bounding box, with family "mesh" and the mass
/// of uniform kObjectDensity. Where the folder has an objects.csv with a column "file", only the
/// meshes named there count, and its columns "category" (the family), "mass_kg" and "quality"
/// (rows that say "poor" are left out) say more; empty cells say nothing.
/// @throws InputError naming the file: no folder, nothing in it, a table or mesh that cannot be
/// read.
std::vector<TrainingObject> ReadObjectFolder(const std::filesystem::path& folder);

/// Of objects whose mass is not given: things of wood and plastic, partly hollow [kg/m3].
inline constexpr double kObjectDensity = 400.0;

}  // namespace pregrasp
