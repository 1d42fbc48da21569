#include "sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "results.hpp"

namespace ductile::bench {
namespace {

class Sampling : public testing::TestWithParam<const char*> {
 protected:
  AdaptCase made_ = make_case(runtime::Executor({.threads = 1}), GetParam());
  Sampler sampler_{made_};
};
INSTANTIATE_TEST_SUITE_P(Cases, Sampling,
                         testing::Values("uni2d@0.05", "uni3d@0.02", "ring2d@0.05", "dome3d@0.03"));

TEST_P(Sampling, PartsSumUpToTheWhole) {
  const Sample sample = sampler_.take({2, Mode::tiles}, 0);
  const PartSeconds& parts = sample.part_seconds;
  EXPECT_NEAR(std::accumulate(parts.begin(), parts.end() - 1, 0.0), parts.back(), 1e-9);
  EXPECT_LE(parts.back(), sample.wall_seconds);
  for (std::size_t k = 0; k < kernel_count; ++k) {
    const PhaseSeconds& phases = sample.phase_seconds[k];
    EXPECT_NEAR(std::accumulate(phases.begin(), phases.end(), 0.0), parts[k], 1e-9);
    EXPECT_GE(*std::min_element(phases.begin(), phases.end()), 0);
  }
}

TEST_P(Sampling, JudgesWhatCameOut) {
  const Sample sample = sampler_.take({1, Mode::tiles}, 0);
  EXPECT_TRUE(sample.figures.valid);
  EXPECT_GT(sample.elements, 100U);
  EXPECT_GT(sample.figures.share_in_range, 0.8);
  EXPECT_GT(sample.figures.mean_quality, 0.7);
  EXPECT_LT(sample.figures.least_quality, sample.figures.mean_quality);
  EXPECT_GT(sample.peak_memory, 1000000U);
}

TEST_P(Sampling, AllThreadsGiveTheSameBytes) {
  Results results;
  for (const int threads : {1, 2, 3})
    results.samples.push_back(sampler_.take({threads, Mode::tiles}, 0));
  EXPECT_EQ(results.samples[0].fingerprint, results.samples[2].fingerprint);
  EXPECT_TRUE(results.sound());
  results.samples[1].fingerprint ^= 1;
  EXPECT_FALSE(results.sound());
}

TEST(Placement, IsSaidInWords) {
  EXPECT_EQ(placement_of({0, 0}), "-");
  EXPECT_EQ(placement_of({60, 60}), "one core");
  EXPECT_EQ(placement_of({60, 400}), "one core to far");
  EXPECT_EQ(placement_of(core_distance(1)), "-");
}

}  // namespace
}  // namespace ductile::bench
