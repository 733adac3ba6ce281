#include "app/job/command.h"

#include <array>
#include <utility>

#include "app/core/error.h"
#include "app/core/json_reader.h"

namespace pregrasp {
namespace {

constexpr std::array<std::pair<Verb, const char*>, 20> kVerbs{{
    {Verb::kOpen, "open"},   {Verb::kSettle, "settle"},   {Verb::kVerdict, "verdict"},
    {Verb::kMesh, "mesh"},   {Verb::kScore, "score"},     {Verb::kPrune, "prune"},
    {Verb::kPath, "path"},   {Verb::kIterate, "iterate"}, {Verb::kCertify, "certify"},
    {Verb::kGrasp, "grasp"}, {Verb::kLift, "lift"},       {Verb::kKeyframe, "keyframe"},
    {Verb::kFill, "fill"},   {Verb::kSmooth, "smooth"},   {Verb::kFrame, "frame"},
    {Verb::kTouch, "touch"}, {Verb::kLetGo, "let_go"},    {Verb::kMove, "move"},
    {Verb::kWait, "wait"},   {Verb::kScreen, "screen"},
}};

}  // namespace

const char* VerbName(Verb verb) {
  for (const auto& [known, name] : kVerbs) {
    if (known == verb) return name;
  }
  return "";
}

nlohmann::ordered_json CommandToJson(const Command& command) {
  return {{"verb", VerbName(command.verb)},
          {"node", command.node},
          {"options", nlohmann::ordered_json(command.options)}};
}

Command CommandFromJson(const nlohmann::json& value, const std::string& where) {
  const JsonReader reader(value, where);
  Command command;
  const std::string verb = reader["verb"].Text();
  bool known = false;
  for (const auto& [candidate, name] : kVerbs) {
    if (verb != name) continue;
    command.verb = candidate;
    known = true;
  }
  if (!known) reader["verb"].Fail("a command's verb");
  command.node = reader["node"].Text();
  command.options = reader["options"].json();
  if (!command.options.is_object()) reader["options"].Fail("an object");
  return command;
}

const nlohmann::json& CommandOptions::Get(const char* name) const {
  const auto found = options_.find(name);
  if (found == options_.end()) throw InputError("", name, "a value", "none");
  return *found;
}

int CommandOptions::Int(const char* name) const {
  const nlohmann::json& value = Get(name);
  if (!value.is_number_integer()) throw InputError("", name, "a whole number", value.dump());
  return value.get<int>();
}

double CommandOptions::Number(const char* name) const {
  const nlohmann::json& value = Get(name);
  if (!value.is_number()) throw InputError("", name, "a number", value.dump());
  return value.get<double>();
}

std::string CommandOptions::Text(const char* name) const {
  const nlohmann::json& value = Get(name);
  if (!value.is_string()) throw InputError("", name, "a text", value.dump());
  return value.get<std::string>();
}

}  // namespace pregrasp
