#include "ductile/runtime/parallel_for.hpp"

#include <gtest/gtest.h>

namespace ductile::runtime {
namespace {

TEST(ParallelFor, VisitsEachIterationOnce) {
  for (int threads : {1, 2, 8}) {
    const Executor executor({.threads = threads});
    std::vector<int> visits(10007, 0);
    parallel_for(executor, visits.size(), [&](std::size_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(10007, 1));
  }
}

}  // namespace
}  // namespace ductile::runtime
