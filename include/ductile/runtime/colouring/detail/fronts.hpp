/// @file
/// Fronts: how threads share the vertices of a graph in speculative colouring. Each has its own
/// part and takes windows of it one after the other.
/// First-fit makes a pattern that grows from its start; two patterns that started apart need more
/// colours where they meet. If neighbours have nearby ids, two threads therefore start beside the
/// same vertices, the seed, which is coloured first, and move away from it, one up and one down. A
/// thread that has finished its part helps another from the far end, where no pattern is yet.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "ductile/runtime/colouring/graph.hpp"

namespace ductile::runtime::detail {

/// Vertices [begin, end), to be coloured in ascending order, or in descending order.
struct Window {
  std::uint32_t begin, end;
  bool ascending = true;

  std::uint32_t size() const { return end - begin; }
  /// The vertex after i others.
  std::uint32_t operator[](std::uint32_t i) const { return ascending ? begin + i : end - 1 - i; }
};

/// A part of the vertices, cut into windows. Thread safety: any thread; the counters only carry
/// window numbers, so their orders are relaxed.
class Front {
 public:
  /// Others may help only while at least `least_help` windows are left.
  Front(const Window& part, std::uint32_t window_size, std::uint32_t least_help)
      : part_(part),
        window_size_(window_size),
        least_help_(least_help),
        left_(word(0, (part.size() + window_size - 1) / window_size)) {}

  /// Number of windows left to help with. 0 if its own thread has not begun: if one thread runs all
  /// parts one by one, each starts at its proper end.
  std::uint32_t worth_help() const {
    const std::uint64_t left = left_.load(std::memory_order_relaxed);
    return begin(left) == 0 || size(left) < least_help_ ? 0 : size(left);
  }
  /// The next window of its own thread, if any is left.
  std::optional<Window> take_first() {
    return take([](std::uint64_t left) { return left + word(1, 0); },
                [this](std::uint64_t left) { return window(begin(left)); });
  }
  /// The helper's next window, in the opposite order because its following window is the one
  /// before.
  std::optional<Window> take_last() {
    return take([](std::uint64_t left) { return left - 1; },
                [this](std::uint64_t left) {
                  Window last = window(end(left) - 1);
                  last.ascending = !last.ascending;
                  return last;
                });
  }

 private:
  // Window numbers [begin, end), in one word.
  static constexpr std::uint64_t word(std::uint64_t begin, std::uint64_t end) {
    return begin << 32U | end;
  }
  static std::uint32_t begin(std::uint64_t word) { return static_cast<std::uint32_t>(word >> 32U); }
  static std::uint32_t end(std::uint64_t word) { return static_cast<std::uint32_t>(word); }
  static std::uint32_t size(std::uint64_t word) { return end(word) - begin(word); }

  template <class Rest, class Taken>
  std::optional<Window> take(Rest rest_of, Taken taken_of) {
    std::uint64_t left = left_.load(std::memory_order_relaxed);
    while (size(left) > 0)
      if (left_.compare_exchange_weak(left, rest_of(left), std::memory_order_relaxed))
        return taken_of(left);
    return std::nullopt;
  }

  Window window(std::uint32_t number) const {
    const std::uint32_t from = number * window_size_;
    const std::uint32_t to = from + std::min(window_size_, part_.size() - from);
    return part_.ascending ? Window{part_.begin + from, part_.begin + to, true}
                           : Window{part_.end - to, part_.end - from, false};
  }

  Window part_;
  std::uint32_t window_size_, least_help_;
  alignas(128) std::atomic<std::uint64_t> left_;
};

/// The fronts of a graph, one for each thread, and their seeds.
class Fronts {
 public:
  template <Graph G>
  Fronts(const G& graph, std::uint32_t count)
      : window_size_(static_cast<std::uint32_t>(
            std::clamp<std::size_t>(graph.vertex_count() / (32 * std::size_t{count}), 64, 1024))) {
    const std::uint64_t n = graph.vertex_count();  // may be of a shorter type
    const auto border = [&](std::uint32_t front) {
      return static_cast<std::uint32_t>(n * std::min(front, count) / count);
    };
    for (std::uint32_t front = 0; front < count; front += 2) {
      const std::uint32_t begin = border(front), middle = border(front + 1),
                          end = border(front + 2);
      const std::uint32_t seed_end = end_of_neighbours_below(graph, begin, middle);
      if (seed_end > middle && seed_end - middle <= (end - middle) / 8) {
        seeds_.push_back({middle, seed_end});
        add({begin, middle, false}, near_help);
        add({seed_end, end}, near_help);
      } else {
        add({begin, middle}, 1);
        if (front + 1 < count) add({middle, end}, 1);
      }
    }
  }

  /// Seeds are coloured before any front.
  const std::vector<Window>& seeds() const { return seeds_; }
  std::size_t count() const { return fronts_.size(); }
  Front& operator[](std::size_t front) { return fronts_[front]; }

  /// The front with most left; null if none is worth help. Thread safety: any thread.
  Front* slowest() {
    Front* slowest = nullptr;
    std::uint32_t most = 0;
    for (Front& front : fronts_)
      if (const std::uint32_t left = front.worth_help(); left > most) most = left, slowest = &front;
    return slowest;
  }

 private:
  /// Help that creates a border between patterns is allowed only with this many windows left.
  static constexpr std::uint32_t near_help = 2;

  void add(const Window& part, std::uint32_t help_share) {
    fronts_.emplace_back(part, window_size_,
                         help_share == 1 ? 1 : part.size() / window_size_ / help_share + 1);
  }

  /// One more than the greatest neighbour of the last few vertices of [begin, middle).
  template <Graph G>
  static std::uint32_t end_of_neighbours_below(const G& graph, std::uint32_t begin,
                                               std::uint32_t middle) {
    constexpr std::uint32_t few = 64;
    std::uint32_t end = 0;
    for (std::uint32_t v = middle - std::min(few, middle - begin); v < middle; ++v)
      graph.for_each_neighbour(v, [&](std::uint32_t u) { end = std::max(end, u + 1); });
    return end;
  }

  std::uint32_t window_size_;
  std::vector<Window> seeds_;
  std::deque<Front> fronts_;  // a deque, because they must not move
};

}  // namespace ductile::runtime::detail
