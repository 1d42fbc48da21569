#include "operators/marked_set.hpp"

#include <gtest/gtest.h>

#include "support/metrics.hpp"

namespace ductile::meshadapt::marked_set_test {
namespace {

TEST(MarkedSet, NumbersWhatIsMarkedInOrder) {
  test::Random random(4);
  for (const std::size_t n : {0, 1, 63, 64, 65, 1000, 100000})
    for (const double share : {0.0, 0.01, 0.5, 1.0}) {
      std::vector<std::uint8_t> marks(n);
      for (auto& mark : marks) mark = test::chance(random, share);
      std::vector<std::uint32_t> marked;
      for (std::size_t i = 0; i < n; ++i)
        if (marks[i]) marked.push_back(static_cast<std::uint32_t>(i));
      for (const int threads : {1, 2, 8}) {
        const MarkedSet set(runtime::Executor({.threads = threads}), marks);
        ASSERT_EQ(set.size(), marked.size());
        for (std::uint32_t place = 0; place < marked.size(); ++place) {
          EXPECT_EQ(set[place], marked[place]);
          EXPECT_EQ(set.place_of(marked[place]), place);
        }
      }
    }
}

}  // namespace
}  // namespace ductile::meshadapt::marked_set_test
