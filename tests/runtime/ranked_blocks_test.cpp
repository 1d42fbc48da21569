#include "ductile/runtime/detail/ranked_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ductile/runtime/hash.hpp"

namespace ductile::runtime::detail::ranked_blocks_test {
namespace {

/// Random pairs of touching blocks, of any rank.
struct Meetings {
  std::vector<std::vector<std::size_t>> met;  // [block]
  std::vector<std::uint32_t> rank_of;         // [block]

  Meetings(std::size_t blocks, std::uint32_t ranks, std::uint32_t seed)
      : met(blocks), rank_of(blocks) {
    for (std::uint32_t b = 0; b < blocks; ++b) {
      rank_of[b] = mix32(seed + b) % ranks;
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::size_t other = mix32(seed ^ (7 * b + i)) % blocks;
        met[b].push_back(other);
        met[other].push_back(b);
      }
    }
  }
};

struct Begun {
  std::size_t block, next = 0;  // index into the blocks that it touches
};

/// Runs all blocks; calls done(block) in a block's turn.
void run(const Executor& executor, const Meetings& meetings, auto&& done) {
  RankedBlocks<Begun> blocks(executor, meetings.met.size(),
                             [&](std::size_t block) { return meetings.rank_of[block]; });
  blocks.run([](std::size_t block) { return Begun{block}; },
             [&](Begun& begun) {
               const auto& met = meetings.met[begun.block];
               const auto rank = static_cast<std::uint8_t>(meetings.rank_of[begun.block]);
               for (; begun.next < met.size(); ++begun.next)
                 if (blocks.comes_before(met[begun.next], rank)) return met[begun.next];
               done(begun.block);
               return RankedBlocks<Begun>::none;
             });
}

TEST(RankedBlocks, RunOnceAndAfterThoseOfLowerRankThatTheyMeet) {
  for (const int threads : {1, 2, 3, 4, 8})
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const Meetings meetings(50 + 40 * seed, 1 + 10 * seed, seed);
      std::vector<std::uint32_t> turn_of(meetings.met.size());
      std::atomic<std::uint32_t> turns = 0;
      std::atomic<int> repeated = 0;
      run(Executor({.threads = threads}), meetings, [&](std::size_t block) {
        repeated += turn_of[block] != 0;
        turn_of[block] = ++turns;
      });
      EXPECT_EQ(turns, turn_of.size());
      EXPECT_EQ(repeated, 0);
      for (std::size_t b = 0; b < turn_of.size(); ++b)
        for (const std::size_t other : meetings.met[b]) {
          const bool before = meetings.rank_of[other] < meetings.rank_of[b];
          EXPECT_TRUE(!before || turn_of[other] < turn_of[b])
              << threads << " threads, seed " << seed;
        }
    }
}

/// A block ends only when all blocks that do not touch it are done, so waiting threads must run
/// those.
TEST(RankedBlocks, AreDoneByThreadsThatWaitForAnother) {
  using namespace std::chrono_literals;
  constexpr std::size_t count = 40;
  for (const int threads : {2, 3, 8})
    for (std::size_t slow = 0; slow < count; ++slow) {
      Meetings meetings(0, 1, 0);
      meetings.met.resize(count);
      meetings.rank_of.assign(count, 1);
      meetings.rank_of[slow] = 0;
      for (const std::size_t block : {std::size_t{0}, count / 2, count - 1})
        if (block != slow) meetings.met[block] = {slow};
      const std::size_t others =
          count - 1 -
          static_cast<std::size_t>(
              std::count(meetings.met.begin(), meetings.met.end(), std::vector<std::size_t>{slow}));
      std::atomic<std::size_t> done = 0;
      bool in_time = true;
      run(Executor({.threads = threads}), meetings, [&](std::size_t block) {
        if (block != slow) return void(++done);
        const auto end = std::chrono::steady_clock::now() + 20s;
        while (done < others && in_time) {
          std::this_thread::yield();
          in_time = std::chrono::steady_clock::now() < end;
        }
      });
      ASSERT_TRUE(in_time) << threads << " threads, slow block " << slow;
    }
}

TEST(RankedBlocks, PassOnWhatABlockThrows) {
  const Meetings meetings(300, 20, 1);
  for (const int threads : {1, 2, 4})
    EXPECT_THROW(run(Executor({.threads = threads}), meetings,
                     [](std::size_t block) {
                       if (block == 77) throw std::runtime_error("no");
                     }),
                 std::runtime_error);
}

}  // namespace
}  // namespace ductile::runtime::detail::ranked_blocks_test
