/// @file
/// First-fit in order on many threads, with the serial colours: threads take windows of vertices
/// one after the other, and a vertex waits for earlier neighbours that are still uncoloured in
/// other threads' windows. A window is marked before the next one can be taken, so reading a
/// vertex's neighbours shows whether it has to wait; see Words.
/// In a random order hardly any vertex waits for one in a short window. In a grid a window is a
/// row: its thread stays some vertices behind the thread of the previous row.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <thread>

#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/detail/in_order.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::runtime::detail {

/// A window is taken when the one this many before it is done. There are twice as many marks, so
/// that marks of earlier and later windows differ.
constexpr std::uint32_t open_windows = 8;
constexpr std::uint32_t window_marks = 2 * open_windows;
constexpr std::uint32_t short_window = 256;

/// Colours all vertices of the graph in windows of this size.
template <class Width, Graph G>
class WindowsRun {
 public:
  using Word = typename Width::Word;
  static_assert(Width::marks == 2 * window_marks);

  WindowsRun(const Executor& executor, const G& graph, Colours<Width> colours, std::uint32_t size)
      : executor_(executor), graph_(graph), colours_(colours), size_(size) {}

  /// Throws TooManyColours and what the graph throws.
  void run() {
    parallel_for(executor_, static_cast<std::size_t>(executor_.threads()),
                 [&](std::size_t) {
                   try {
                     for (auto number = take(); number < count_; number = take()) colour(number);
                   } catch (const WaitsInVain&) {
                   } catch (...) {
                     failed_.store(true);
                     throw;
                   }
                 },
                 {.grain = 1});
  }

 private:
  /// Thrown by a wait for vertices whose thread has failed.
  struct WaitsInVain {};

  Window window(std::uint32_t number) const {
    const std::uint32_t begin = number * size_;
    return {begin, begin + std::min(size_, n_ - begin)};
  }

  /// The number of the next window, which it marks; `count_` if there is none.
  std::uint32_t take() {
    constexpr std::uint64_t being_marked = 1;
    std::uint64_t next = next_.load(std::memory_order_relaxed);
    // Pairs with the store below: a thread that takes a window sees the marks of all before it.
    while ((next & being_marked) != 0 ||
           !next_.compare_exchange_weak(next, next | being_marked, std::memory_order_acquire)) {
      if (failed_.load(std::memory_order_relaxed)) return count_;
      next = next_.load(std::memory_order_relaxed);
    }
    const auto number = static_cast<std::uint32_t>(next / 2);
    if (number < count_) {
      if (number >= open_windows) wait_for(window(number - open_windows).end - 1);
      const Window taken = window(number);
      colours_.fill(taken.begin, taken.end, Colours<Width>::mark(number % window_marks));
    }
    next_.store(number < count_ ? next + 2 : next, std::memory_order_release);
    return number;
  }

  /// Works in pieces and prefetches before each the colours of the previous row, which another core
  /// has just written.
  void colour(std::uint32_t number) {
    using Seen = TakenColours<Colours<Width>>;
    const std::uint32_t mark = number % window_marks;
    std::uint64_t earlier = 0;
    for (std::uint32_t i = 1; i < open_windows; ++i)
      earlier |= Seen::bit_of_mark((number - i) % window_marks) |
                 Seen::bit_of_mark((number - i) % window_marks + window_marks);
    const auto colour_late = [this](std::uint32_t v) { return this->colour_late(v); };
    const Window all = window(number);
    for (std::uint32_t begin = all.begin; begin < all.end; begin += short_window) {
      const Window piece{begin, std::min(begin + short_window, all.end)};
      if (size_ > short_window && number > 0) prefetch_colours(piece.begin - size_);
      first_fit_in_order(graph_, colours_, piece,
                         HeedingPainter{{{mark, window_marks + mark}, after(piece)}, earlier},
                         colour_late);
    }
  }

  /// The probable next vertex of the thread after a piece.
  std::uint32_t after(const Window& piece) const {
    constexpr std::uint32_t near = 64;
    const auto threads = static_cast<std::uint32_t>(executor_.threads());
    const std::uint32_t ahead = size_ > short_window ? near : threads * size_;
    return piece.begin + std::min(ahead, n_ - piece.begin);
  }

  void prefetch_colours(std::uint32_t begin) const {
    constexpr std::uint32_t line = 64 / sizeof(Word);
    const Word* const words = colours_.words().data();
    for (std::uint32_t v = begin; v < begin + short_window && v < n_; v += line)
      __builtin_prefetch(words + v);
  }

  /// Colours v when all earlier neighbours have colours; returns its colour.
  [[gnu::noinline]] Word colour_late(std::uint32_t v) {
    wait_for_earlier(v);
    const Word colour = least_free(graph_, v, colours_);
    colours_.set(v, colour);
    return colour;
  }

  /// A thread that waits within a row lets the previous one get far ahead, so as not to wait for
  /// every vertex. It polls the first word of a cache line, because polling slows down its writer.
  void wait_for_earlier(std::uint32_t v) const {
    graph_.for_each_neighbour(v, [&](std::uint32_t u) {
      if (u >= v || has_colour(u)) return;
      const auto threads = static_cast<std::uint32_t>(executor_.threads());
      const std::uint32_t ahead = size_ > short_window ? size_ / threads : 0;
      if (ahead > 0) wait_for(std::min(begin_of_line(u + ahead), window(u / size_).end - 1));
      wait_for(u);
    });
  }

  std::uint32_t begin_of_line(std::uint32_t v) const {
    constexpr std::size_t line = 64;
    const auto address = reinterpret_cast<std::uintptr_t>(colours_.words().data() + v);
    return v - static_cast<std::uint32_t>(address % line / sizeof(Word));
  }

  bool has_colour(std::uint32_t v) const { return colours_[v] <= Width::most; }

  [[gnu::noinline]] void wait_for(std::uint32_t v) const {
    constexpr int few = 200;
    for (int look = 0; !has_colour(v); ++look) {
      if (failed_.load(std::memory_order_relaxed)) throw WaitsInVain{};
      if (look > few) std::this_thread::yield();
    }
  }

  const Executor& executor_;
  const G& graph_;
  Colours<Width> colours_;
  std::uint32_t size_;
  std::uint32_t n_ = static_cast<std::uint32_t>(graph_.vertex_count());
  std::uint32_t count_ = n_ / size_ + (n_ % size_ != 0 ? 1 : 0);
  alignas(128) std::atomic<std::uint64_t> next_{0};  // twice the number, and being_marked
  std::atomic<bool> failed_{false};
};

}  // namespace ductile::runtime::detail
