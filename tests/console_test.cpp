// What the console says while one waits.
#include <gtest/gtest.h>

#include "time_left.h"

namespace bentaxis::cli {
namespace {

// Seconds, then minutes, then hours and minutes; each is rounded up.
TEST(TimeLeft, AsIfTheRestWentAsFast) {
  EXPECT_EQ(time_left(10, 0.5), ", 10 s left");
  EXPECT_EQ(time_left(10, 0.8), ", 3 s left");
  EXPECT_EQ(time_left(19.5, 0.25), ", 59 s left");
  EXPECT_EQ(time_left(20, 0.25), ", 1 min left");
  EXPECT_EQ(time_left(20.5, 0.25), ", 2 min left");
  EXPECT_EQ(time_left(1180, 0.25), ", 59 min left");
  EXPECT_EQ(time_left(1200, 0.25), ", 1 h 0 min left");
  EXPECT_EQ(time_left(2380, 0.25), ", 1 h 59 min left");
  EXPECT_EQ(time_left(3600, 0.25), ", 3 h 0 min left");
}

TEST(TimeLeft, NothingIsSaidTooEarly) {
  EXPECT_EQ(time_left(1.9, 0.5), "");
  EXPECT_EQ(time_left(2, 0.5), ", 2 s left");
  EXPECT_EQ(time_left(100, 0.009), "");
  EXPECT_NE(time_left(100, 0.01), "");
}

}  // namespace
}  // namespace bentaxis::cli
