/// @file
/// First-fit in order of priority, on many threads (Jones and Plassmann, SIAM J. Sci. Comput. 14,
/// 1993): a vertex waits for its uncoloured neighbours of higher priority and ignores lower ones,
/// which wait for it. It counts the neighbours it waits for; the last of them releases it, so each
/// neighbour is read twice, however long the wait. A thread goes on with the vertices it has
/// released, except for those beyond its capacity, which all threads share in the next round.
/// The result is that of serial first-fit in descending order of priority.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/colouring/detail/first_fit.hpp"
#include "ductile/runtime/colouring/graph.hpp"
#include "ductile/runtime/executor.hpp"
#include "ductile/runtime/hash.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::runtime::detail {

/// Has u the higher priority?
inline bool outranks(std::uint32_t u, std::uint32_t v) { return mix32(u) < mix32(v); }

/// Number of neighbours that each vertex waits for, by vertex.
class AwaitedByVertex {
 public:
  AwaitedByVertex(std::size_t vertex_count, std::span<const std::uint32_t>)
      : count_(std::make_unique_for_overwrite<std::uint32_t[]>(vertex_count)) {}
  void begin(std::uint32_t v) { count_[v] = 0; }
  std::uint32_t& operator[](std::uint32_t v) { return count_[v]; }

 private:
  std::unique_ptr<std::uint32_t[]> count_;
};

/// The same for a few of the vertices, in ascending order and hardly ever neighbours: minimal
/// memory, with a search for those that wait.
class AwaitedByPlace {
 public:
  AwaitedByPlace(std::size_t, std::span<const std::uint32_t> vertices)
      : vertices_(vertices), count_(vertices.size()) {}
  void begin(std::uint32_t) {}
  std::uint32_t& operator[](std::uint32_t v) {
    const auto at = std::lower_bound(vertices_.begin(), vertices_.end(), v);
    return count_[static_cast<std::size_t>(at - vertices_.begin())];
  }

 private:
  std::span<const std::uint32_t> vertices_;
  std::vector<std::uint32_t> count_;
};

/// Removes the colours of vertices and gives them new ones.
template <class Awaited, class Width, Graph G>
class PriorityRun {
 public:
  PriorityRun(const Executor& executor, const G& graph, std::span<const std::uint32_t> vertices,
              Colours<Width> colours)
      : executor_(executor),
        graph_(graph),
        vertices_(vertices),
        colours_(colours),
        awaited_(colours.vertex_count(), vertices),
        free_(executor) {}

  void run() {
    for_each(vertices_, [&](std::uint32_t v) {
      colours_.set(v, Colours<Width>::waiting);
      awaited_.begin(v);
    });
    for_each(vertices_, [&](std::uint32_t v) { colour_or_announce(v); });
    for_each(vertices_, [&](std::uint32_t v) {
      if (colours_[v] == Colours<Width>::waiting && awaited_[v] == 0) free_.mine().append(v);
    });
    for (free_.collect(); !free_.empty(); free_.collect()) {
      const UnsetVector<std::uint32_t> now = free_.take();
      for_each(now, [&](std::uint32_t v) { colour_from(v); });
    }
  }

 private:
  /// Small grains for few vertices, so that each thread gets some.
  template <class Body>
  void for_each(std::span<const std::uint32_t> vertices, Body body) const {
    const std::size_t grain = std::clamp<std::size_t>(vertices.size() / 512, 8, 64);
    parallel_for(executor_, vertices.size(),
                 [&](std::size_t i) {
                   prefetch_after(graph_, {vertices.size(), vertices.data()}, i);
                   body(vertices[i]);
                 },
                 {.grain = grain, .serial_below = 64});
  }

  /// Counts v at those that wait for it as often as v will release them: its row may repeat a
  /// neighbour more often than that neighbour's repeats v. If none waits, colours v at once.
  void colour_or_announce(std::uint32_t v) {
    bool missed = false;
    TakenColours<Colours<Width>> seen;
    graph_.for_each_neighbour(v, [&](std::uint32_t u) {
      const std::uint32_t colour = colours_[u];
      seen.add(colour);
      if (colour != Colours<Width>::waiting || u == v) return;
      missed = true;
      if (outranks(v, u)) atomic_count(awaited_[u]);
    });
    if (!missed) colours_.set(v, least_free(graph_, v, colours_, seen));
  }

  /// Colours v and the vertices it releases.
  void colour_from(std::uint32_t v) {
    std::array<std::uint32_t, 64> stack;
    std::size_t size = 0;
    for (stack[size++] = v; size > 0;) {
      v = stack[--size];
      colours_.set(v, least_free(graph_, v, colours_));
      graph_.for_each_neighbour(v, [&](std::uint32_t u) {
        if (colours_[u] != Colours<Width>::waiting || !hand_on(u)) return;
        if (size < stack.size()) {
          stack[size++] = u;
        } else {
          free_.mine().append(u);
        }
      });
    }
  }

  /// Notes that a neighbour of u has its colour; true if u waited for no other. Each call sees
  /// earlier releases, so the last one knows the colours of all.
  bool hand_on(std::uint32_t u) {
    return std::atomic_ref(awaited_[u]).fetch_sub(1, std::memory_order_acq_rel) == 1;
  }

  const Executor& executor_;
  const G& graph_;
  std::span<const std::uint32_t> vertices_;
  Colours<Width> colours_;
  Awaited awaited_;               // counts of neighbours that the given vertices wait for
  Worklist<std::uint32_t> free_;  // vertices that wait for nobody
};

template <class Awaited, class Width, Graph G>
void colour_by_priority(const Executor& executor, const G& graph,
                        std::span<const std::uint32_t> vertices, Colours<Width> colours) {
  PriorityRun<Awaited, Width, G>(executor, graph, vertices, colours).run();
}

struct ByPriority {
  static constexpr std::uint32_t marks = 0;
  static constexpr bool bound_by_memory = true;  ///< faster words would not help

  template <class Width, Graph G>
  static void run(const Executor& executor, const G& graph, VertexSet vertices,
                  Colours<Width> colours) {
    std::vector<std::uint32_t> listed(vertices.count);
    for (std::size_t i = 0; i < listed.size(); ++i) listed[i] = vertices[i];
    colour_by_priority<AwaitedByVertex>(executor, graph, listed, colours);
  }
};

}  // namespace ductile::runtime::detail
