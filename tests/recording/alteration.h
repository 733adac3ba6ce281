#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/core/json_text.h"
#include "app/core/rng.h"
#include "app/recording/manifest.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {

/// Writes a run's manifest again, with the sums of the files as they are now: what somebody does
/// who alters a record and hides it.
inline void Reseal(const std::filesystem::path& run) {
  nlohmann::ordered_json fields = nlohmann::ordered_json::parse(ReadFile(run / "manifest.json"));
  for (const char* own : {"schema", "files"}) fields.erase(own);
  WriteManifest(run, fields);
}

/// All values of a document that hold no others, each with its path as comparisons name it.
inline void ListLeaves(nlohmann::ordered_json& value, const std::string& path,
                       std::vector<std::pair<std::string, nlohmann::ordered_json*>>& leaves) {
  if (value.is_object() && !value.empty()) {
    for (auto& [key, child] : value.items()) {
      ListLeaves(child, path.empty() ? key : path + '.' + key, leaves);
    }
  } else if (value.is_array() && !value.empty()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      ListLeaves(value[i], path + '[' + std::to_string(i) + ']', leaves);
    }
  } else {
    leaves.emplace_back(path, &value);
  }
}

/// Another value, as near as can be.
inline void Alter(nlohmann::ordered_json& value) {
  if (value.is_number_float()) {
    value = std::nextafter(value.get<double>(), 1e300);
  } else if (value.is_number_unsigned()) {
    value = value.get<std::uint64_t>() + 1;
  } else if (value.is_number_integer()) {
    value = value.get<std::int64_t>() + 1;
  } else if (value.is_boolean()) {
    value = !value.get<bool>();
  } else if (value.is_string()) {
    value = value.get<std::string>() + "x";
  } else {  // null, or an empty list or object
    value = 0.5;
  }
}

inline std::vector<std::string> SplitLines(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  }
  return lines;
}

inline std::string JoinLines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

/// What was altered in a file of JSON lines.
struct Alteration {
  std::size_t line = 0;  ///< from 0
  std::string id;        ///< that the line has, or had
  std::string field;
};

/// Alters a random field of a random line.
inline Alteration AlterRandomField(const std::filesystem::path& file, Rng& rng) {
  std::vector<std::string> lines = SplitLines(ReadFile(file));
  Alteration alteration;
  alteration.line = rng.UniformInt(static_cast<std::uint32_t>(lines.size()));
  nlohmann::ordered_json value = nlohmann::ordered_json::parse(lines[alteration.line]);
  alteration.id = value.value("id", "");
  std::vector<std::pair<std::string, nlohmann::ordered_json*>> leaves;
  ListLeaves(value, "", leaves);
  const auto& [field, leaf] = leaves[rng.UniformInt(static_cast<std::uint32_t>(leaves.size()))];
  alteration.field = field;
  Alter(*leaf);
  lines[alteration.line] = FormatJson(value);
  WriteFile(file, JoinLines(lines));
  return alteration;
}

/// The bytes with one random bit turned over.
inline std::string FlipRandomBit(std::string bytes, Rng& rng) {
  bytes[rng.UniformInt(static_cast<std::uint32_t>(bytes.size()))] ^=
      static_cast<char>(1U << rng.UniformInt(8));
  return bytes;
}

/// Alters a random cell of a table, its header left alone. @returns "line 7: COLUMN".
inline std::string AlterRandomCell(const std::filesystem::path& file, Rng& rng) {
  std::vector<std::string> lines = SplitLines(ReadFile(file));
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
      if (c == ',') {
        cells.emplace_back();
      } else {
        cells.back() += c;
      }
    }
    return cells;
  };
  const std::vector<std::string> columns = split(lines[0]);
  const std::size_t row = 1 + rng.UniformInt(static_cast<std::uint32_t>(lines.size() - 1));
  const std::size_t column = rng.UniformInt(static_cast<std::uint32_t>(columns.size()));
  std::vector<std::string> cells = split(lines[row]);
  cells[column] += '1';
  lines[row].clear();
  for (const std::string& cell : cells) lines[row] += (lines[row].empty() ? "" : ",") + cell;
  WriteFile(file, JoinLines(lines));
  return "line " + std::to_string(row + 1) + ": " + columns[column];
}

}  // namespace pregrasp
