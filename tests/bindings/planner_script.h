#pragma once

// Scripts that drive the planner in the real machine. The networks' weights are random: what is
// found is poor, how it is stepped is not.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "bindings/script.h"
#include "tests/bindings/lua_text.h"
#include "tests/networks/random_network.h"

namespace pregrasp {

// Small stages, so that a test takes well under a second.
inline const char* const kPlannerPrelude = R"(local pg = require "pregrasp"
local function session() return pg.open "scenes/ruler.lua" end
local function graph(s) return (s or session()):graph{ triangles = 12, samples = 1, points = 128 } end
local function pruned(s) local g = graph(s) g:score() g:prune{ top_percent = 20 } return g end
local function optimizer(s) return pruned(s):paths{ stages = 2 }:next():optimize{ samples = 6, iterations = 4, patience = 9 } end
local function run(o) while o:step() do end return o end
local function same(a, b) assert(#a == #b) for i = 1, #a do if a[i].cost ~= b[i].cost then return false end end return true end
)";

class PlannerScriptTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    weights_ = std::make_unique<TestFolder>();
    WriteRandomWeights(weights_->path());
  }
  static void TearDownTestSuite() { weights_.reset(); }

  std::string Script(const std::string& body) {
    config_.output = folder_.path() / "out";
    if (config_.weights.empty()) config_.weights = weights_->path();
    const auto file = folder_.Write("test.lua", kPlannerPrelude + body);
    testing::internal::CaptureStdout();
    try {
      RunScript(file, {}, config_);
    } catch (const std::exception&) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }

  // The line with which the script's only line fails, after its position.
  std::string Failure(const std::string& line) {
    try {
      Script(line);
    } catch (const InputError& error) {
      const std::string message = error.what();
      const std::string marker = "test.lua:8: ";
      const std::size_t at = message.find(marker);
      return at == std::string::npos ? "not of the line: " + message
                                     : message.substr(at + marker.size());
    }
    return "no failure";
  }

  inline static std::unique_ptr<TestFolder> weights_;
  TestFolder folder_;
  ScriptConfig config_;
};

}  // namespace pregrasp
