// lua/meta/pregrasp.lua against what is registered: the same names, both ways.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "app/core/error.h"
#include "app/session/picture_file.h"
#include "bindings/manual.h"
#include "bindings/planner_options.h"
#include "bindings/script.h"
#include "tests/bindings/lua_text.h"

namespace pregrasp {
namespace {

// "pregrasp.open(scene, options)", "Session:settle(options)", "Session.name", "BodyTable.mass".
std::set<std::string> NamesInMeta() {
  std::stringstream in;
  in << std::ifstream(std::filesystem::path(PREGRASP_SOURCE_DIR) / "lua/meta/pregrasp.lua").rdbuf()
     << OptionAnnotations();
  const std::regex class_line(R"(---@class (\w+).*)"), field_line(R"(---@field (\w+)\??\s.*)"),
      function_line(R"(function (\w+[.:]\w+\(.*\)) end)"), param_line(R"(---@param (\w+)\??\s.*)");
  std::set<std::string> names;
  std::string current, parameters;
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_match(line, match, class_line)) {
      current = match[1];
      EXPECT_TRUE(names.insert(current).second) << current << " is there twice";
    } else if (std::regex_match(line, match, field_line)) {
      EXPECT_TRUE(names.insert(current + "." + std::string(match[1])).second) << line;
    } else if (std::regex_match(line, match, param_line)) {
      parameters += (parameters.empty() ? "" : ", ");
      parameters += match[1];
    } else if (std::regex_match(line, match, function_line)) {
      const std::string name = match[1];
      EXPECT_TRUE(names.insert(name).second) << line;
      EXPECT_EQ(name.substr(name.find('(')), "(" + parameters + ")") << "its @param lines differ";
      parameters.clear();
    }
  }
  return names;
}

std::set<std::string> NamesRegistered() {
  const Api& api = GetApi();
  std::set<std::string> names = {api.module->name};
  for (const std::string& key : api.module->keys) names.insert(api.module->name + "." + key);
  for (const FunctionInfo* function : api.functions) {
    names.erase(api.module->name + "." + function->name);
    names.insert(api.module->name + "." + function->name + "(" + function->parameters + ")");
  }
  for (const ClassInfo* info : api.classes) {
    names.insert(info->name);
    for (const FunctionInfo& method : info->methods) {
      names.insert(info->name + ":" + method.name + "(" + method.parameters + ")");
    }
    for (const FunctionInfo& property : info->properties) {
      names.insert(info->name + "." + property.name);
    }
  }
  for (const Schema* schema : api.schemas) {
    names.insert(schema->name);
    for (const std::string& key : schema->keys) names.insert(schema->name + "." + key);
  }
  return names;
}

TEST(MetaTest, AnnotationsNameExactlyWhatIsRegistered) {
  const std::set<std::string> meta = NamesInMeta(), registered = NamesRegistered();
  EXPECT_GT(registered.size(), 100U);
  for (const std::string& name : registered) {
    EXPECT_TRUE(meta.count(name)) << name << " is not in lua/meta/pregrasp.lua";
  }
  for (const std::string& name : meta) {
    EXPECT_TRUE(registered.count(name)) << name << " of lua/meta/pregrasp.lua is not registered";
  }
}

TEST(MetaTest, OptionsOfThePlannersStagesSayWhatTheTableOfSettingsSays) {
  const std::string text = OptionAnnotations();
  const auto has = [&](const std::string& line) {
    return text.find('\n' + line + '\n') != std::string::npos;
  };
  EXPECT_EQ(text.rfind("---@meta pregrasp\n", 0), 0U);
  std::size_t num_options = 0;
  for (const Schema* schema : StageOptionSchemas()) {
    EXPECT_TRUE(has("---@class " + schema->name));
    num_options += schema->keys.size();
  }
  EXPECT_GT(num_options, 50U);
  const std::regex field(
      R"(---@field \w+\? (integer|number|boolean|fun\(.+\): boolean\?|"\w+"(\|"\w+")*) .+; \S+)");
  std::istringstream lines(text);
  std::size_t num_fields = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("---@field", 0) != 0) continue;
    ++num_fields;
    EXPECT_TRUE(std::regex_match(line, field)) << line;
  }
  EXPECT_EQ(num_fields, num_options);
  EXPECT_TRUE(has("---@field triangles? integer of the contact mesh, 12 to 200, even; 40")) << text;
  EXPECT_TRUE(
      has("---@field temperature? number lambda over the standard deviation of the better "
          "half's costs, 1e-06 to 1e+06; 0.5"));
}

TEST(MetaTest, SaysOfEveryFunctionAndCostTermWhatItIs) {
  for (const auto& [name, entry] : Manual::Get().entries()) {
    EXPECT_FALSE(entry.is_function() && entry.text.empty()) << name;
  }
  for (const auto& part : Manual::Get().Find("CostTerms")->parts) {
    EXPECT_FALSE(part.text.empty()) << part.name;
  }
}

TEST(MetaTest, TheOverlaysOfTheManualAreThoseOfPictures) {
  std::string names;
  const ManualEntry* overlay = Manual::Get().Find("Overlay");
  ASSERT_NE(overlay, nullptr);
  for (const auto& part : overlay->parts) {
    EXPECT_FALSE(part.text.empty()) << part.name;
    names += (names.empty() ? "" : ", ") + part.name;
  }
  PictureConfig config;
  try {
    SetOverlays(config, {"nothing"});
    ADD_FAILURE() << "it was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.expected(), "some of " + names);
  }
}

TEST(MetaTest, TheConditionsOfTheManualAreThoseOfBreakWhen) {
  const ManualEntry* condition = Manual::Get().Find("Condition");
  ASSERT_NE(condition, nullptr);
  std::string names;
  for (const auto& part : condition->parts) {
    EXPECT_FALSE(part.text.empty()) << part.name;
    names += (names.empty() ? "" : ", ") + part.name;
  }
  const TestFolder folder;
  const auto script = folder.Write(
      "test.lua", "local s = require 'pregrasp'.open 'scenes/ruler.lua' s:break_when 'nothing'");
  try {
    RunScript(script, {}, {});
    ADD_FAILURE() << "it was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected one of " + names + ", got"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace pregrasp
