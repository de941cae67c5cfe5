// What the console says while one waits.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "launched_ranks.h"
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

LaunchedRanks launched_by(const std::map<std::string, std::string>& environment) {
  return launched_ranks([&](const char* name) {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
}

// A run of one task is a run of its own, whatever started it.
TEST(LaunchedRanks, AreSeveralWhereOthersAreNamed) {
  EXPECT_FALSE(launched_by({}).by_mpi);
  EXPECT_FALSE(launched_by({{"SLURM_STEP_NUM_TASKS", "4"}}).by_mpi);
  for (const std::map<std::string, std::string>& one :
       {std::map<std::string, std::string>{{"OMPI_COMM_WORLD_SIZE", "1"}},
        {{"PMI_SIZE", "1"}, {"PMI_RANK", "0"}},
        {{"PMIX_RANK", "0"}},
        {{"PMIX_RANK", "0"}, {"SLURM_STEP_NUM_TASKS", "1"}}}) {
    EXPECT_TRUE(launched_by(one).by_mpi);
    EXPECT_FALSE(launched_by(one).several) << one.begin()->first;
  }
  for (const std::map<std::string, std::string>& many :
       {std::map<std::string, std::string>{{"OMPI_COMM_WORLD_SIZE", "2"}},
        {{"PMI_SIZE", "12"}, {"PMI_RANK", "0"}},
        {{"PMI_RANK", "1"}},
        {{"PMIX_RANK", "3"}},
        {{"PMIX_RANK", "0"}, {"SLURM_STEP_NUM_TASKS", "8"}}})
    EXPECT_TRUE(launched_by(many).several) << many.begin()->first;
}

}  // namespace
}  // namespace bentaxis::cli
