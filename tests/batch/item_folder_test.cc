#include "app/batch/item_folder.h"

#include <gtest/gtest.h>

#include "app/core/error.h"
#include "tests/test_folder.h"

namespace pregrasp {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSeed1 = R"({"seed":1,"mppi":{"sigma":0.5}})";

TEST(ItemFolderTest, AnItemIsThereWhenItsFileIs) {
  const TestFolder root;
  const ItemFolder folder(root.path() / "a" / "b", kSeed1, ".txt");
  EXPECT_FALSE(folder.Has(7));
  WriteWholeFile(folder.PathOf(7), "seven");
  EXPECT_TRUE(folder.Has(7));
  EXPECT_FALSE(folder.Has(8));
  EXPECT_TRUE(ItemFolder(root.path() / "a" / "b", kSeed1, ".txt").Has(7));
  EXPECT_EQ(ReadWholeFile(folder.PathOf(7)), "seven");
}

TEST(ItemFolderTest, AFolderOfAnotherBatchIsRefusedWithTheDifference) {
  const TestFolder root;
  const ItemFolder first(root.path(), kSeed1, ".txt");
  try {
    const ItemFolder second(root.path(), R"({"seed":1,"mppi":{"sigma":0.25}})", ".txt");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("mppi.sigma: 0.25 and 0.5"), std::string::npos)
        << error.what();
  }
}

TEST(ItemFolderTest, LookingMakesNothing) {
  const TestFolder root;
  const auto look = ItemFolder::Purpose::kLook;
  EXPECT_FALSE(ItemFolder(root.path() / "none", kSeed1, ".txt", look).Has(0));
  EXPECT_FALSE(fs::exists(root.path() / "none"));
  const ItemFolder made(root.path() / "made", kSeed1, ".txt");
  WriteWholeFile(made.PathOf(0), "");
  EXPECT_TRUE(ItemFolder(root.path() / "made", kSeed1, ".txt", look).Has(0));
  EXPECT_THROW(ItemFolder(root.path() / "made", "{}", ".txt", look), InputError);
  EXPECT_EQ(std::distance(fs::directory_iterator(root.path() / "made"), {}), 2);
}

TEST(ItemFolderTest, WritingLeavesNoOtherFile) {
  const TestFolder root;
  WriteWholeFile(root.path() / "x", "old");
  WriteWholeFile(root.path() / "x", "new");
  EXPECT_EQ(ReadWholeFile(root.path() / "x"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(root.path()), fs::directory_iterator()), 1);
  EXPECT_THROW(WriteWholeFile(root.path() / "no" / "x", "new"), InputError);
  EXPECT_THROW(ReadWholeFile(root.path() / "nothing"), InputError);
}

TEST(ItemFoldersTest, ItemsAreFoundInAnyFolderOfOneBatch) {
  const TestFolder root;
  const fs::path a = root.path() / "a", b = root.path() / "b", c = root.path() / "c";
  WriteWholeFile(ItemFolder(a, kSeed1, ".txt").PathOf(0), "from a");
  WriteWholeFile(ItemFolder(b, kSeed1, ".txt").PathOf(1), "from b");
  const ItemFolders both({b, a}, ".txt", "batch");
  EXPECT_EQ(both.description(), kSeed1);
  EXPECT_EQ(ReadWholeFile(both.Find(0)), "from a");
  EXPECT_EQ(ReadWholeFile(both.Find(1)), "from b");
  EXPECT_THROW(both.Find(2), InputError);
  const ItemFolder other(c, R"({"seed":2})", ".txt");
  EXPECT_THROW(ItemFolders({a, c}, ".txt", "batch"), InputError);
  EXPECT_THROW(ItemFolders({a, root.path() / "d"}, ".txt", "batch"), InputError);
}

TEST(DescribeDifferenceTest, NamesTheFirstFieldThatDiffers) {
  EXPECT_EQ(DescribeDifference(kSeed1, kSeed1), "");
  EXPECT_EQ(DescribeDifference(R"({"a":1,"b":[1,2]})", R"({"a":1,"b":[1,3]})"), "b.1: 2 and 3");
  EXPECT_EQ(DescribeDifference(R"({"a":1})", R"({"a":1,"b":"x"})"), "b: none and \"x\"");
  EXPECT_EQ(DescribeDifference(R"({"a":1,"b":"x"})", R"({"a":1})"), "b: \"x\" and none");
  EXPECT_EQ(DescribeDifference("{", R"({"a":1})"), "description.json differs");
}

}  // namespace
}  // namespace pregrasp
