#include "app/training/object_folder.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "app/geometry/bounds.h"
#include "app/geometry/mass_properties.h"
#include "app/training/make_item.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

// A box from (0, 0, 0) to (x, y, z), whose corners' bits are x, y, z.
std::string BoxObj(double x, double y, double z) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += "v " + std::to_string(corner & 1 ? x : 0.0) + " " +
            std::to_string(corner & 2 ? y : 0.0) + " " + std::to_string(corner & 4 ? z : 0.0) +
            "\n";
  }
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

class ObjectFolderTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_.Write("brick.obj", BoxObj(0.2, 0.1, 0.05));
    folder_.Write("ash.obj", BoxObj(0.1, 0.1, 0.1));
    folder_.Write("notes.txt", "no mesh");
  }
  // The line that is said of a folder that cannot be taken.
  std::string Refusal() const {
    try {
      ReadObjectFolder(folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  TestFolder folder_;
};

TEST_F(ObjectFolderTest, TakesEveryMeshInTheOrderOfNames) {
  const std::vector<TrainingObject> objects = ReadObjectFolder(folder_.path());
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].name, "ash");
  EXPECT_EQ(objects[1].name, "brick");
  EXPECT_EQ(objects[1].family, "mesh");
  EXPECT_NEAR(objects[1].mass, kObjectDensity * 0.2 * 0.1 * 0.05, 1e-6);
  EXPECT_LT(CalcBounds(objects[1].shape).center().norm(), 1e-6);
  EXPECT_LT((CalcBounds(objects[1].shape).sizes() - Vector3(0.2, 0.1, 0.05)).norm(), 1e-6);
}

TEST_F(ObjectFolderTest, ATableSaysFamilyMassAndWhatIsLeftOut) {
  folder_.Write("third.obj", BoxObj(0.1, 0.1, 0.2));
  folder_.Write("objects.csv",
                "id,note,file,category,mass_kg,quality\r\n"
                "1,\"heavy, \"\"red\"\"\",brick.obj,block,2.5,good\r\n"
                "2,,ash.obj,,,caution\r\n"
                "3,broken,third.obj,block,1,poor\r\n");
  const std::vector<TrainingObject> objects = ReadObjectFolder(folder_.path());
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].family, "mesh");
  EXPECT_EQ(objects[1].family, "block");
  EXPECT_EQ(objects[1].mass, 2.5);
}

TEST_F(ObjectFolderTest, MistakesAreOneLineWithTheirPlace) {
  folder_.Write("objects.csv", "name,mass_kg\nx,1\n");
  EXPECT_NE(Refusal().find("objects.csv: expected a column \"file\""), std::string::npos)
      << Refusal();
  folder_.Write("objects.csv", "file,mass_kg\nbrick.obj,-1\n");
  EXPECT_NE(Refusal().find("objects.csv:2"), std::string::npos) << Refusal();
  EXPECT_NE(Refusal().find("mass_kg"), std::string::npos) << Refusal();
  folder_.Write("objects.csv", "file\nbrock.obj\n");
  EXPECT_NE(Refusal().find("brock.obj"), std::string::npos) << Refusal();
  EXPECT_THROW(ReadObjectFolder(folder_.path() / "none"), InputError);
}

TEST_F(ObjectFolderTest, ItemsTakeTheObjectsInTurnAndSaySo) {
  ItemConfig config;
  const std::string without = config.ToJson();
  config.objects =
      std::make_shared<const std::vector<TrainingObject>>(ReadObjectFolder(folder_.path()));
  EXPECT_EQ(MakeItemObject(config, 3).object.name, "brick");
  EXPECT_NE(config.ToJson(), without);
  std::vector<TrainingObject> heavier = *config.objects;
  heavier[0].mass *= 2.0;
  ItemConfig other = config;
  other.objects = std::make_shared<const std::vector<TrainingObject>>(heavier);
  EXPECT_NE(other.ToJson(), config.ToJson());
}

}  // namespace
}  // namespace pregrasp
