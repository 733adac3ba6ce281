#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pregrasp {

/// `text` as the content of an element or as an attribute's value between double quotes.
std::string EscapeHtml(std::string_view text);

/// `bytes` as a data URI's base64.
std::string Base64(std::string_view bytes);

/// JSON that can stand in a script element: nothing in it ends that, or begins a comment.
std::string ScriptJson(const nlohmann::ordered_json& value);

/// What DescribeStep says: sentences as paragraphs, rows as one table.
std::string LinesToHtml(const std::vector<std::string>& lines);

/// A table with a line of names and then one of each of `rows`; cells are HTML already.
/// @param caption  escaped here; none if empty.
std::string HtmlTable(const std::string& caption, const std::vector<std::string>& names,
                      const std::vector<std::vector<std::string>>& rows);

/// A table of two columns, names and values, both escaped here.
std::string FactTable(const std::string& caption,
                      const std::vector<std::pair<std::string, std::string>>& rows);

}  // namespace pregrasp
