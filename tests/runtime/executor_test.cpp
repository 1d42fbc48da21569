#include "ductile/runtime/executor.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "binding.hpp"
#include "cgroup.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::executor_test {
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

/// [thread] Its affinity mask in a loop of which it gets a part.
std::vector<cpu_set_t> masks(const Executor& executor) {
  std::vector<cpu_set_t> mask_of(static_cast<std::size_t>(executor.threads()));
  parallel_for(executor, mask_of.size(),
               [&](std::size_t) { mask_of[static_cast<std::size_t>(this_thread())] = affinity(); },
               {.grain = 1, .schedule = Schedule::omp_static});
  return mask_of;
}

/// Does the system let a thread choose among several processing units?
bool can_bind() {
  bool can = false;
  std::thread([&] {
    cpu_set_t one = affinity();
    if (CPU_COUNT(&one) < 2) return;
    for (std::size_t cpu = 0; CPU_COUNT(&one) > 1; ++cpu) CPU_CLR(cpu, &one);
    can = sched_setaffinity(0, sizeof one, &one) == 0 && same(affinity(), one);
  }).join();
  return can;
}

TEST(Executor, BindsThreadsForTheLoopAndNoLonger) {
  const cpu_set_t before = affinity();
  const bool binds = can_bind();
  for (const Placement placement : {Placement::compact, Placement::scatter})
    for (int threads : {1, 2, 3, 8}) {
      {
        const Executor executor({.threads = threads, .placement = placement});
        const auto during = masks(executor);
        EXPECT_TRUE(same(affinity(), before));
        const bool bound = binds && threads > 1;  // one thread runs as its caller
        for (const cpu_set_t& mask : during)
          EXPECT_TRUE(bound ? CPU_COUNT(&mask) == 1 : same(mask, before));
        for (std::size_t t = 1; bound && t < during.size(); ++t) {
          const bool again = t % static_cast<std::size_t>(CPU_COUNT(&before)) == 0;
          EXPECT_EQ(same(during[t], during[0]), again) << "thread " << t << " of " << threads;
        }
      }
      for (const cpu_set_t& mask : masks(Executor({.threads = threads})))
        EXPECT_TRUE(same(mask, before));
    }
  if (!binds) GTEST_SKIP() << "threads cannot be bound here";
}

/// Makes hwloc report a fictitious machine until destruction.
class Machine {
 public:
  explicit Machine(const char* description) { setenv("HWLOC_SYNTHETIC", description, 1); }
  ~Machine() { unsetenv("HWLOC_SYNTHETIC"); }
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;
};

TEST(Places, ArePhysicalCoresBeforeTheirSecondHyperthreads) {
  using Processors = std::vector<unsigned>;
  const auto places = [](Placement placement) {
    return detail::processors(*detail::make_places(placement));
  };
  {
    const Machine two_packages("package:2 core:3 pu:2");
    EXPECT_EQ(places(Placement::compact), (Processors{0, 2, 4, 6, 8, 10, 1, 3, 5, 7, 9, 11}));
    EXPECT_EQ(places(Placement::scatter), (Processors{0, 6, 2, 8, 4, 10, 1, 7, 3, 9, 5, 11}));
  }
  const Machine cores_alone("pu:3");
  EXPECT_EQ(places(Placement::compact), (Processors{0, 1, 2}));
  EXPECT_EQ(places(Placement::scatter), (Processors{0, 1, 2}));
  EXPECT_EQ(detail::make_places(Placement::none), nullptr);
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

TEST_F(Cgroup, LimitsMemoryInBothVersions) {
  const auto memory = [&] { return cgroup_memory_limit(root_ / "sys", root_ / "membership"); };
  EXPECT_EQ(memory(), 0);
  write("membership", "4:memory:/x\n0::/a/b\n");
  write("sys/a/b/memory.max", "max\n");
  write("sys/memory/x/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(memory(), 0);
  write("sys/a/memory.max", "3000000000\n");
  EXPECT_EQ(memory(), 3e9);
  write("sys/memory/x/memory.limit_in_bytes", "2000000000\n");
  EXPECT_EQ(memory(), 2e9);
}

}  // namespace
}  // namespace ductile::runtime::executor_test
