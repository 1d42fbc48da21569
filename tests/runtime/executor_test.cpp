#include "ductile/runtime/executor.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "cgroup.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime {
namespace {

namespace fs = std::filesystem;

cpu_set_t affinity() {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  return set;
}

bool same(const cpu_set_t& a, const cpu_set_t& b) { return CPU_EQUAL(&a, &b) != 0; }

TEST(Executor, RefusesThreadCountsThatMakeNoSense) {
  EXPECT_THROW(Executor({.threads = -1}), std::invalid_argument);
  EXPECT_THROW(Executor({.threads = 5000}), std::invalid_argument);
  EXPECT_EQ(Executor({.threads = 3}).threads(), 3);
  EXPECT_EQ(Executor().threads(), available_cores());
  EXPECT_GE(available_cores(), 1);
}

TEST(Executor, BindsThreadsForTheLoopAndNoLonger) {
  const cpu_set_t before = affinity();
  for (const Placement placement : {Placement::compact, Placement::scatter})
    for (int threads : {1, 2, 3, 8}) {
      std::vector<cpu_set_t> during(static_cast<std::size_t>(threads), before);
      {
        const Executor executor({.threads = threads, .placement = placement});
        parallel_for(
            executor, 1000,
            [&](std::size_t) { during[static_cast<std::size_t>(this_thread())] = affinity(); },
            {.grain = 1});
        EXPECT_TRUE(same(affinity(), before));
      }
      // A thread that got no work, or a system that refuses, leaves the mask as it was.
      for (const cpu_set_t& mask : during) EXPECT_TRUE(CPU_COUNT(&mask) == 1 || same(mask, before));
      std::vector<cpu_set_t> after(static_cast<std::size_t>(threads), before);
      parallel_for(
          Executor({.threads = threads}), 1000,
          [&](std::size_t) { after[static_cast<std::size_t>(this_thread())] = affinity(); },
          {.grain = 1});
      for (const cpu_set_t& mask : after) EXPECT_TRUE(same(mask, before));
    }
}

class Cgroup : public testing::Test {
 protected:
  Cgroup() : root_(fs::path(testing::TempDir()) / ("ductile_cgroup_" + std::to_string(getpid()))) {}
  ~Cgroup() override { fs::remove_all(root_); }

  void write(const fs::path& file, const std::string& text) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  double limit() { return cgroup_cpu_limit(root_ / "sys", root_ / "membership"); }

  fs::path root_;
};

TEST_F(Cgroup, SetsNoLimitWhereThereIsNothingToRead) {
  EXPECT_EQ(limit(), 0);
  write("membership", "rubbish\n\n0::\n:::::\n");
  EXPECT_EQ(limit(), 0);
  write("membership", "0::/a\n");
  write("sys/a/cpu.max", "max 100000\n");
  EXPECT_EQ(limit(), 0);
}

TEST_F(Cgroup, LimitsByTheLeastOfTheGroupsUpwards) {
  write("membership", "0::/a/b/c\n");
  write("sys/a/b/c/cpu.max", "max 100000\n");
  write("sys/a/b/cpu.max", "150000 100000\n");
  write("sys/a/cpu.max", "400000 100000\n");
  EXPECT_EQ(limit(), 1.5);
  write("sys/cpu.max", "50000 100000\n");
  EXPECT_EQ(limit(), 0.5);
}

TEST_F(Cgroup, ReadsTheFirstVersionToo) {
  write("membership", "5:cpuset:/x\n4:cpu,cpuacct:/x\n");
  write("sys/cpu,cpuacct/x/cpu.cfs_quota_us", "-1\n");
  write("sys/cpu,cpuacct/x/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(limit(), 0);
  write("sys/cpu,cpuacct/x/cpu.cfs_quota_us", "250000\n");
  EXPECT_EQ(limit(), 2.5);
}

}  // namespace
}  // namespace ductile::runtime
