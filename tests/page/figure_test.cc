#include "app/page/figure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/core/error.h"
#include "tests/page/recorded_graph.h"

namespace pregrasp {
namespace {

// A run that scored and pruned a graph, and took two iterations along a path.
LoadedRun MakeRun() {
  const RecordedGraph recorded;
  LoadedRun run;
  run.scene.name = "a<b";
  run.summary.seed = 5;
  const auto add = [&](const StepFacts& step) {
    run.steps.push_back(step);
    run.number_of[step.id] = static_cast<int>(run.steps.size());
  };
  add(recorded.Get("graph.mesh"));
  for (const std::string& id : recorded.ids) add(recorded.Get(id));
  for (int i = 1; i <= 2; ++i) {
    IterationFacts facts;
    facts.path = 3;
    facts.iteration = i;
    facts.best_cost = -0.5 * i;
    StepFacts step;
    step.command = {Verb::kIterate, run.steps.back().id};
    step.id = "path.3.mppi." + std::to_string(i);
    step.details = facts;
    add(step);
  }
  run.manifest["step"] = run.steps.back().id;
  return run;
}

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

// With colours as values, which programs that know no variables can read.
void ExpectStandsAlone(const std::string& svg) {
  EXPECT_EQ(svg.rfind("<?xml", 0), 0U);
  EXPECT_NE(svg.find("xmlns=\"http://www.w3.org/2000/svg\""), std::string::npos);
  EXPECT_EQ(svg.find("var("), std::string::npos);
  EXPECT_NE(svg.find("stroke: #d9d6cf"), std::string::npos);  // page.css's --line
  EXPECT_EQ(svg.find("a<b"), std::string::npos);
  EXPECT_NE(svg.find("a&lt;b, seed 5"), std::string::npos);
  EXPECT_EQ(Count(svg, "<svg"), Count(svg, "</svg>"));
  EXPECT_EQ(Count(svg, "<text"), Count(svg, "</text>"));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(FigureTest, CostsAreAPlotForEachPathThatWasOptimised) {
  const LoadedRun run = MakeRun();
  const std::string svg = MakeFigure(run, "costs");
  ExpectStandsAlone(svg);
  EXPECT_EQ(svg, MakeFigure(run, "costs"));
  EXPECT_NE(svg.find("along path 3"), std::string::npos);
  EXPECT_NE(svg.find("iteration 2: best so far -1<"), std::string::npos);
}

TEST(FigureTest, TheGraphHasASquareForEveryStateThatWasKept) {
  const RecordedGraph recorded;
  const ContactGraph& graph = recorded.graphs.back();
  const std::string svg = MakeFigure(MakeRun(), "graph");
  ExpectStandsAlone(svg);
  const auto later = std::count_if(graph.kept().begin(), graph.kept().end(),
                                   [&](int id) { return !graph.nodes()[id].initial; });
  EXPECT_EQ(Count(svg, "class=\"later\""), later);
  EXPECT_NE(svg.find(std::to_string(graph.kept().size()) + " of " +
                     std::to_string(graph.nodes().size()) + " contact states kept"),
            std::string::npos);
}

TEST(FigureTest, WhatARunDoesNotHaveIsRefused) {
  LoadedRun run = MakeRun();
  EXPECT_THROW(MakeFigure(run, "paths"), InputError);
  EXPECT_THROW(MakeFigure(run, ""), InputError);
  run.steps.resize(1);
  run.manifest["step"] = run.steps.back().id;
  EXPECT_THROW(MakeFigure(run, "costs"), InputError);
  EXPECT_THROW(MakeFigure(run, "graph"), InputError);
}

}  // namespace
}  // namespace pregrasp
