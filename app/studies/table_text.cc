#include "app/studies/table_text.h"

#include <fmt/format.h>

#include "app/core/json_text.h"
#include "app/studies/statistics.h"

namespace pregrasp {
namespace {

std::string MarkdownRow(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

// The value without quotes, lists joined by blanks.
std::string PlainText(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return FormatJson(value);
  std::string text;
  for (const auto& element : value) text += (text.empty() ? "" : " ") + PlainText(element);
  return text;
}

std::string CsvCell(const nlohmann::ordered_json& value) {
  const std::string text = PlainText(value);
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

std::string MeanText(const std::vector<double>& values) {
  const MeanDeviation result = CalcMeanDeviation(values);
  if (!result.mean) return "-";
  std::string text = fmt::format("{:.3f}", *result.mean);
  if (result.deviation) text += fmt::format(" ({:.3f})", *result.deviation);
  return text;
}

std::string MarkdownTable(const std::vector<std::vector<std::string>>& rows) {
  std::string text = MarkdownRow(rows.front()) + "|";
  for (std::size_t i = 0; i < rows.front().size(); ++i) text += "---|";
  text += "\n";
  for (std::size_t i = 1; i < rows.size(); ++i) text += MarkdownRow(rows[i]);
  return text;
}

std::string CsvTable(const std::vector<nlohmann::ordered_json>& records) {
  std::string text;
  for (const nlohmann::ordered_json& record : records) {
    std::string head, line;
    for (const auto& [name, value] : record.items()) {
      head += (head.empty() ? "" : ",") + CsvCell(name);
      line += (line.empty() ? "" : ",") + CsvCell(value);
    }
    text += (text.empty() ? head + "\n" : "") + line + "\n";
  }
  return text;
}

}  // namespace pregrasp
