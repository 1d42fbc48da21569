/// @file
/// Work stealing by compare-and-swap. Each of min(threads, chunks) threads starts with an equal
/// part of the chunks, packed into one word, and takes chunks from its front: many at once while it
/// has many, which makes taking cheap, single ones at the end. A thread without work takes the back
/// half of the longest part. The very last chunk is begun first: in order it would be begun last,
/// and if it is long, all would wait for it. A thread leaves when there is nothing to take, so it
/// waits only at the join. The words carry only chunk numbers, so all orders are relaxed: the start
/// of the loop and the join order the bodies' data.

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>

#include "loop.hpp"

namespace ductile::runtime {

namespace {

/// Chunks [begin, end), in one word.
struct Part {
  std::uint32_t begin, end;

  static Part of(std::uint64_t word) {
    return {static_cast<std::uint32_t>(word >> 32U), static_cast<std::uint32_t>(word)};
  }
  std::uint64_t word() const { return std::uint64_t{begin} << 32U | end; }
  std::uint32_t size() const { return end - begin; }
};

struct alignas(128) PartOfThread {
  std::atomic<std::uint64_t> word{0};

  /// Takes a 64th of the part from its front, at least one chunk; an empty part if there is none.
  Part take_front() {
    std::uint64_t seen = word.load(std::memory_order_relaxed);
    for (;;) {
      const Part part = Part::of(seen);
      const std::uint32_t end = part.begin + part.size() / 64 + (part.size() % 64 != 0);
      if (part.size() == 0 ||
          word.compare_exchange_weak(seen, Part{end, part.end}.word(), std::memory_order_relaxed))
        return {part.begin, end};
    }
  }

  /// Takes the part's last chunk, if there is one.
  Part take_last() {
    std::uint64_t seen = word.load(std::memory_order_relaxed);
    for (;;) {
      const Part part = Part::of(seen);
      if (part.size() == 0) return part;
      if (word.compare_exchange_weak(seen, Part{part.begin, part.end - 1}.word(),
                                     std::memory_order_relaxed))
        return {part.end - 1, part.end};
    }
  }
};

using Parts = std::span<PartOfThread>;

/// Moves the back half of the longest part to `mine`, which is empty; false if all are empty. A
/// word never recurs with different remaining chunks, so a compare-and-swap that succeeds is right
/// even if the word changed and came back in between.
bool steal(Parts parts, PartOfThread& mine) {
  for (;;) {
    PartOfThread* victim = nullptr;
    Part longest{0, 0};
    for (PartOfThread& part : parts) {
      const Part now = Part::of(part.word.load(std::memory_order_relaxed));
      if (now.size() > longest.size()) victim = &part, longest = now;
    }
    if (victim == nullptr) return false;
    const std::uint32_t middle = longest.begin + longest.size() / 2;
    std::uint64_t expected = longest.word();
    if (victim->word.compare_exchange_strong(expected, Part{longest.begin, middle}.word(),
                                             std::memory_order_relaxed)) {
      mine.word.store(Part{middle, longest.end}.word(), std::memory_order_relaxed);
      return true;
    }
  }
}

/// False if the loop must stop.
bool run_chunks(Loop& loop, Part part) {
  return part.size() == 0 ||
         loop.run(part.begin * loop.grain, std::min(loop.n, part.end * loop.grain));
}

void work_and_steal(Loop& loop, Parts parts, PartOfThread& mine) {
  do {
    for (Part taken = mine.take_front(); taken.size() > 0; taken = mine.take_front())
      if (!run_chunks(loop, taken)) return;
  } while (steal(parts, mine));
}

}  // namespace

void run_steal_by_atomics(const Executor& executor, Loop& loop) {
  const auto threads = static_cast<std::size_t>(executor.threads());
  while (loop.chunk_count() > UINT32_MAX) loop.grain *= 2;
  const std::size_t chunks = loop.chunk_count(), wanted = std::min(threads, chunks);
  // Up to 64 lie on the stack, so that a loop allocates no memory.
  alignas(PartOfThread) std::array<std::byte, 64 * sizeof(PartOfThread)> room;
  std::pmr::monotonic_buffer_resource pool(room.data(), room.size());
  std::pmr::vector<PartOfThread> of_threads(wanted, &pool);
  const Parts parts(of_threads);
  for (std::size_t t = 0; t < wanted; ++t) {
    const auto bound = [&](std::size_t i) {
      return static_cast<std::uint32_t>(chunks * i / wanted);
    };
    parts[t].word.store(Part{bound(t), bound(t + 1)}.word(), std::memory_order_relaxed);
  }
  // Parts of threads that do not come in time are stolen.
  run_team(executor, Turnout::whoever_comes, wanted, [&](int thread) {
    const auto own = static_cast<std::size_t>(thread);
    PartOfThread& mine = parts[own];
    if (own + 1 == wanted && !run_chunks(loop, mine.take_last())) return;
    work_and_steal(loop, parts, mine);
  });
}

}  // namespace ductile::runtime
