#include "copies.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <stdexcept>
#include <vector>

#include "results.hpp"

namespace ductile::bench {
namespace {

TEST(Copies, AddsUpWhatProcessesOfTheirOwnGetDone) {
  int runs = 0;
  const auto work = [&] { return ++runs * 0.5; };  // always the first one of its process
  EXPECT_DOUBLE_EQ(speed_of_copies(work, 3), 3);
  EXPECT_EQ(runs, 0);
}

TEST(Copies, SaysThatOneFailed) {
  EXPECT_THROW(speed_of_copies([]() -> double { throw std::invalid_argument("no"); }, 2),
               std::runtime_error);
  EXPECT_THROW(speed_of_copies([]() -> double { _exit(0); }, 2), std::runtime_error);
}

TEST(Copies, StandBesideThreads) {
  Sample one, two;
  one.case_name = two.case_name = "x";
  one.wall_seconds = 6;
  two.settings.threads = 2;
  two.wall_seconds = 4;
  const auto summaries = summarise(std::vector{one, two});
  const std::vector<CopiesRow> copies{{"x", 2, 1.6}, {"not measured", 2, 1.5}};
  const Table table = copies_table(summaries, copies);
  ASSERT_EQ(table.size(), 1U);
  EXPECT_NE(table.text().find("1.5"), std::string::npos);    // times as fast on two threads
  EXPECT_NE(table.text().find("93.75"), std::string::npos);  // per cent of 1.6
}

}  // namespace
}  // namespace ductile::bench
