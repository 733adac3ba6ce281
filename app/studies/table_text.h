#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pregrasp {

/// "0.817 (0.144)": mean and standard deviation; "0.817" of one value, "-" of none.
std::string MeanText(const std::vector<double>& values);

/// A table in Markdown; the first row is its head, and all have as many cells.
std::string MarkdownTable(const std::vector<std::vector<std::string>>& rows);

/// Records with the same keys as comma-separated values (RFC 4180 but for its line ends), the keys
/// first. A list is one cell, with blanks between; null is an empty one.
std::string CsvTable(const std::vector<nlohmann::ordered_json>& records);

}  // namespace pregrasp
