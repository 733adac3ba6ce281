#pragma once

#include <string>
#include <vector>

#include "app/job/planner.h"

namespace pregrasp {

// What a planner's step did and why, for its picture: a sentence or two made from the decision's
// own numbers, then rows of a table ("name\tvalue").

std::vector<std::string> DescribeMesh(const ContactGraph& graph);
std::vector<std::string> DescribeScores(const ContactGraph& graph);
/// The pruning step that the graph has taken last.
std::vector<std::string> DescribePruning(const ContactGraph& graph);
/// Why a node is in the graph or not, in one sentence.
std::string DescribeReason(const NodeReason& reason);
std::vector<std::string> DescribePath(const ContactGraph& graph, const ContactPath& path);
std::vector<std::string> DescribeIteration(const MppiState& state);
std::vector<std::string> DescribeCertificate(const Scene& scene, const Certificate& certificate,
                                             const ReleaseResult& release);
std::vector<std::string> DescribeGrasp(const GraspWorld& world, const CompletedGrasp& grasp);
std::vector<std::string> DescribeFrame(const MotionFrameTask& task, const MotionFrame& frame);

/// "thumb on 3, index on 17", "index on 4", of the fingers that the plan of `stage` puts on.
std::string DescribeStage(const ContactGraph& graph, const ContactPath& path, const WorldPlan& plan,
                          int stage);

}  // namespace pregrasp
