#include "app/page/html_text.h"

#include <cstdint>

#include "app/core/json_text.h"

namespace pregrasp {

std::string EscapeHtml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string Base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string ScriptJson(const nlohmann::ordered_json& value) {
  std::string text;
  for (const char c : FormatJson(value)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string LinesToHtml(const std::vector<std::string>& lines) {
  std::string html;
  bool in_table = false;
  for (const std::string& line : lines) {
    const auto tab = line.find('\t');
    const bool row = tab != std::string::npos;
    if (row != in_table) html += row ? "<table class=\"facts\">\n" : "</table>\n";
    in_table = row;
    html += row ? "<tr><th scope=\"row\">" + EscapeHtml(line.substr(0, tab)) + "</th><td>" +
                      EscapeHtml(line.substr(tab + 1)) + "</td></tr>\n"
                : "<p>" + EscapeHtml(line) + "</p>\n";
  }
  return in_table ? html + "</table>\n" : html;
}

std::string HtmlTable(const std::string& caption, const std::vector<std::string>& names,
                      const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"wide\"><table>\n";
  if (!caption.empty()) html += "<caption>" + EscapeHtml(caption) + "</caption>\n";
  html += "<thead><tr>";
  for (const std::string& name : names) html += "<th scope=\"col\">" + EscapeHtml(name) + "</th>";
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + cell + "</td>";
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string FactTable(const std::string& caption,
                      const std::vector<std::pair<std::string, std::string>>& rows) {
  if (rows.empty()) return "";
  std::string html = "<table class=\"facts\">\n";
  if (!caption.empty()) html += "<caption>" + EscapeHtml(caption) + "</caption>\n";
  for (const auto& [name, value] : rows) {
    html += "<tr><th scope=\"row\">" + EscapeHtml(name) + "</th><td>" + EscapeHtml(value) +
            "</td></tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace pregrasp
