#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/graph/contact_graph.h"
#include "app/job/step_facts.h"
#include "app/scene/scene.h"

namespace pregrasp {

/// "(60, 0, -1.5) mm" from metres.
std::string FormatMillimetres(const Vector3& v);

/// What happened in a step and why: a sentence or two made from its facts, then rows of a table
/// ("index force\t0.56 N").
std::vector<std::string> DescribeStep(const Scene& scene, const StepFacts& step,
                                      const FactsSource& steps);

/// Where two steps' sentences and rows (DescribeStep) have rows of one name with other values,
/// these as "best cost: A -1.405, B -1.381; .."; at most `most` of them, "" for none.
std::string DescribeRowDifferences(const std::vector<std::string>& left,
                                   const std::vector<std::string>& right, std::size_t most);

/// A field of a step as cards and tables name it, with its unit: "details.max_force_N" is "largest
/// force [N]", "bodies[0].p_WB[1]" is "the object: place, y [m]". What has no words of its own is
/// spelt out.
std::string DescribeField(const std::string& field);

/// One of two values that differ, as FormatJson has them: of numbers four digits, or as many as
/// tell it from the other.
std::string DescribeValue(const std::string& value, const std::string& other);

/// Why a node is in the graph or not, in one sentence.
std::string DescribeReason(const NodeReason& reason);

namespace internal {

// Its parts.
std::vector<std::string> DescribeScene(const Scene& scene);
std::vector<std::string> DescribePlanning(const Scene& scene, const StepFacts& step);
std::vector<std::string> DescribeSimulation(const Scene& scene, const StepFacts& step,
                                            const StepFacts& before);

}  // namespace internal
}  // namespace pregrasp
