#include "summary.hpp"

#include <gtest/gtest.h>

namespace ductile::bench {
namespace {

Sample sample(int threads, double seconds, double before_ns, double after_ns) {
  Sample made;
  made.case_name = "x";
  made.settings.threads = threads;
  made.wall_seconds = seconds;
  made.before = {before_ns, before_ns};
  made.after = {after_ns, after_ns};
  return made;
}

TEST(Summary, MedianIsTheMiddle) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(median({3, 1, 9}), 3);
  EXPECT_EQ(median({4, 1, 2, 9}), 3);
}

TEST(Summary, LeavesOutSamplesWhoseCoresMoved) {
  const std::vector samples{sample(2, 1, 100, 100), sample(2, 50, 100, 300),
                            sample(2, 3, 110, 120)};
  const auto summaries = summarise(samples);
  ASSERT_EQ(summaries.size(), 1U);
  EXPECT_EQ(summaries[0].placement, "near");
  EXPECT_EQ(summaries[0].used, 2U);
  EXPECT_EQ(summaries[0].taken, 3U);
  EXPECT_EQ(summaries[0].median.wall_seconds, 2);
}

TEST(Summary, UsesThePlacementThatWasMetMostOften) {
  const std::vector samples{sample(2, 9, 60, 60), sample(2, 1, 400, 400), sample(2, 3, 300, 310)};
  const auto summaries = summarise(samples);
  EXPECT_EQ(summaries[0].placement, "far");
  EXPECT_EQ(summaries[0].median.wall_seconds, 2);
}

TEST(Summary, SaysThatAllMoved) {
  const auto summaries = summarise(std::vector{sample(2, 5, 60, 100), sample(2, 7, 100, 300)});
  EXPECT_EQ(summaries[0].placement, "moving");
  EXPECT_EQ(summaries[0].used, 2U);
}

TEST(Summary, KeepsThreadsAndModesApart) {
  std::vector samples{sample(1, 4, 0, 0), sample(2, 2, 100, 100), sample(1, 6, 0, 0)};
  samples.push_back(sample(2, 1, 100, 100));
  samples.back().settings.mode = Mode::colours;
  const auto summaries = summarise(samples);
  ASSERT_EQ(summaries.size(), 3U);
  EXPECT_EQ(find(summaries, "x", {1, Mode::tiles})->median.wall_seconds, 5);
  EXPECT_EQ(find(summaries, "x", {2, Mode::colours})->median.wall_seconds, 1);
  EXPECT_EQ(find(summaries, "x", {4, Mode::tiles}), nullptr);
}

TEST(Summary, IsValidOnlyIfAllSamplesAre) {
  std::vector samples{sample(1, 1, 0, 0), sample(1, 1, 0, 0)};
  samples[0].figures.valid = true;
  EXPECT_FALSE(summarise(samples)[0].median.figures.valid);
  samples[1].figures.valid = true;
  EXPECT_TRUE(summarise(samples)[0].median.figures.valid);
}

TEST(Summary, NoticesOtherBytes) {
  std::vector samples{sample(1, 1, 0, 0), sample(1, 1, 0, 0)};
  EXPECT_TRUE(summarise(samples)[0].same_bytes);
  samples[1].fingerprint = 1;
  EXPECT_FALSE(summarise(samples)[0].same_bytes);
}

}  // namespace
}  // namespace ductile::bench
