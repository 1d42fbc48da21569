#include "copies.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <stdexcept>

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

}  // namespace
}  // namespace ductile::bench
