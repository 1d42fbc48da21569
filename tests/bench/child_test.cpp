#include "child.hpp"

#include <gtest/gtest.h>

namespace ductile::bench {
namespace {

ChildReport shell(const std::string& script) { return run_child({"/bin/sh", "-c", script}); }

TEST(Child, TellsHowItEnded) {
  EXPECT_EQ(shell("exit 0").status, 0);
  EXPECT_EQ(shell("exit 7").status, 7);
  EXPECT_EQ(shell("kill -TERM $$").status, 128 + 15);
  EXPECT_EQ(run_child({"/no/such/program"}).status, 127);
}

TEST(Child, CountsProcessorTimeNotWaiting) {
  const ChildReport idle = shell("sleep 0.2");
  EXPECT_GE(idle.wall_seconds, 0.19);
  EXPECT_LT(idle.processor_seconds, 0.15);
  const ChildReport busy = shell("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done");
  EXPECT_GT(busy.processor_seconds, 0.02);
  EXPECT_GT(busy.peak_memory, 100000U);
}

TEST(Child, FindsProgramsOnThePath) {
  EXPECT_TRUE(find_program("sh").has_value());
  EXPECT_FALSE(find_program("no-such-program-here").has_value());
}

}  // namespace
}  // namespace ductile::bench
