#include "app/batch/shard.h"

#include <gtest/gtest.h>

#include "app/core/error.h"

namespace pregrasp {
namespace {

TEST(ShardTest, EveryItemBelongsToExactlyOne) {
  for (const int count : {1, 2, 3, 7}) {
    for (std::int64_t item = 0; item < 30; ++item) {
      int holders = 0;
      for (int number = 1; number <= count; ++number) holders += Shard{number, count}.Holds(item);
      EXPECT_EQ(holders, 1) << item << " of " << count;
    }
  }
}

TEST(ShardTest, IsReadFromText) {
  const Shard shard = ParseShard("2/5");
  EXPECT_EQ(shard.number, 2);
  EXPECT_EQ(shard.count, 5);
}

TEST(ShardTest, NonsenseIsRefusedByTheFlagsName) {
  for (const char* text : {"", "/", "1", "1/", "/2", "0/2", "3/2", "-1/2", "1/0", "1/-2", "1/2/3",
                           " 1/2", "1/2 ", "1.5/2", "a/b", "1/99999999999999999999"}) {
    try {
      ParseShard(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), "--shard") << text;
    }
  }
}

}  // namespace
}  // namespace pregrasp
