#include "app/recording/step_record.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/recording/json_text.h"
#include "tests/recording/sample_run.h"

namespace pregrasp {
namespace {

nlohmann::json Json(const StepRecord& step, int number) {
  return ParseJson(FormatJson(StepToJson(step, number)), "step");
}

TEST(StepRecordTest, ReadsBackWhatWasWritten) {
  for (int i = 0; i < 50; ++i) {
    const StepRecord step = SampleStep(i);
    const StepRecord back = StepFromJson(Json(step, i + 1), "step");
    EXPECT_EQ(back.id, step.id);
    EXPECT_EQ(back.stage, step.stage);
    EXPECT_EQ(back.t, step.t);
    EXPECT_EQ(back.details, step.details);
    ASSERT_EQ(back.bodies.size(), step.bodies.size());
    for (std::size_t k = 0; k < step.bodies.size(); ++k) {
      EXPECT_EQ(back.bodies[k].name, step.bodies[k].name);
      EXPECT_EQ(back.bodies[k].X_WB.translation(), step.bodies[k].X_WB.translation());
      EXPECT_LT((back.bodies[k].X_WB.linear() - step.bodies[k].X_WB.linear()).cwiseAbs().maxCoeff(),
                4e-15);  // by way of a quaternion
    }
    ASSERT_EQ(back.fingers.size(), step.fingers.size());
    for (std::size_t k = 0; k < step.fingers.size(); ++k) {
      EXPECT_EQ(back.fingers[k].finger, step.fingers[k].finger);
      EXPECT_EQ(back.fingers[k].on, step.fingers[k].on);
      EXPECT_EQ(back.fingers[k].p_OC, step.fingers[k].p_OC);
      EXPECT_EQ(back.fingers[k].p_WTarget, step.fingers[k].p_WTarget);
      EXPECT_EQ(back.fingers[k].f_W, step.fingers[k].f_W);
    }
  }
}

TEST(StepRecordTest, QuaternionsHaveAPositiveRealPart) {
  for (int i = 0; i < 50; ++i) {
    const nlohmann::json json = Json(SampleStep(i), 1);
    for (const auto& body : json["bodies"]) EXPECT_GE(body["q_WB"][0].get<double>(), 0.0);
  }
}

TEST(StepRecordTest, APictureIsNamedByNumberAndId) {
  EXPECT_EQ(PictureName(1, "scene.start"), "0001_scene-start.png");
  EXPECT_EQ(PictureName(12345, "path.2.mppi.7"), "12345_path-2-mppi-7.png");
  EXPECT_EQ(Json(SampleStep(3), 4)["picture"], "frames/0004_sim-3.png");
}

TEST(StepRecordTest, ADamagedStepIsReportedWithItsPlaceAndField) {
  const auto error_of = [](const nlohmann::json& json) -> std::string {
    try {
      StepFromJson(json, "steps.jsonl:7");
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  const nlohmann::json good = Json(SampleStep(1), 2);
  EXPECT_EQ(error_of(good), "none");
  nlohmann::json json = good;
  json.erase("t");
  EXPECT_EQ(error_of(json), "steps.jsonl:7: t: expected a value, got none");
  json = good;
  json["bodies"][1]["p_WB"] = {1, 2};
  EXPECT_EQ(error_of(json), "steps.jsonl:7: bodies[1].p_WB: expected three numbers, got [1,2]");
  json = good;
  json["bodies"][0]["q_WB"] = {1, 1, 0, 0};
  EXPECT_NE(error_of(json).find("bodies[0].q_WB: expected a quaternion"), std::string::npos);
  json = good;
  json["fingers"][0]["finger"] = "toe";
  EXPECT_NE(error_of(json).find("fingers[0].finger"), std::string::npos);
  json = good;
  json["fingers"][1]["f_W"][2] = "big";
  EXPECT_EQ(error_of(json), "steps.jsonl:7: fingers[1].f_W[2]: expected a number, got \"big\"");
}

}  // namespace
}  // namespace pregrasp
