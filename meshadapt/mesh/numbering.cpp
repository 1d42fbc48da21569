#include "mesh/numbering.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <span>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/grouping.hpp"
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim, int Space>
Box<Space> bounding_box(const Executor& executor, const Mesh<Dim, Space>& mesh, auto&& is_alive) {
  return runtime::parallel_reduce(
      executor, mesh.vertex_slots(), Box<Space>::empty(),
      [&](std::size_t v) {
        if (!is_alive(v)) return Box<Space>::empty();
        return Box<Space>{mesh.site_of[v].position, mesh.site_of[v].position};
      },
      [](const Box<Space>& a, const Box<Space>& b) { return join(a, b); });
}

/// Keys with their ids in the low bits of a word, so that sorting words sorts ids by key, equal
/// keys in order.
class KeyedWords {
 public:
  /// Uses as many of the highest of a key's `key_bits` bits as fit beside an id below `count`.
  KeyedWords(std::size_t count, unsigned key_bits)
      : id_bits_(static_cast<unsigned>(std::bit_width(count))), key_bits_(key_bits) {}

  std::uint64_t word(std::uint64_t key, std::uint64_t id) const {
    return fits() ? key << id_bits_ | id : (key << (64 - key_bits_) & ~ids()) | id;
  }
  /// Greater than all other words; the greatest id is below the number with all id bits set.
  std::uint64_t gone() const { return word(greatest_key(), ids()); }
  std::uint64_t greatest_key() const { return (std::uint64_t{1} << key_bits_) - 1; }
  unsigned id_bits() const { return id_bits_; }
  std::uint32_t id(std::uint64_t word) const { return static_cast<std::uint32_t>(word & ids()); }

 private:
  bool fits() const { return key_bits_ + id_bits_ < 64; }
  std::uint64_t ids() const { return (std::uint64_t{1} << id_bits_) - 1; }

  unsigned id_bits_, key_bits_;
};

/// Moves the words that are not `gone` to the front, in order, and returns their end. Most are
/// gone.
std::uint64_t* remove_gone(const Executor& executor, std::span<std::uint64_t> words,
                           std::uint64_t gone) {
  const auto find = [&](std::size_t i, auto&& append) {
    if (words[i] != gone) append(words[i]);
  };
  const auto living = runtime::parallel_collect<std::uint64_t>(
      executor, words.size(), find, runtime::few_nanoseconds.serial_below);
  return std::to_address(std::copy(living.begin(), living.end(), words.begin()));
}

/// The existing ids below `count`, sorted by key_of(id); is_alive(id) says whether one exists.
Ids sorted_ids(const Executor& executor, std::size_t count, unsigned key_bits, auto&& is_alive,
               auto&& key_of) {
  const KeyedWords keyed(count, key_bits);
  auto words = runtime::make_unset_vector<std::uint64_t>(executor, count);
  parallel_for(executor, count, [&](std::size_t id) {
    words[id] = is_alive(id) ? keyed.word(key_of(id), id) : keyed.gone();
  });
  const std::span all(words);
  runtime::parallel_sort_above(executor, all, keyed.id_bits());  // ids are in order
  // Deleted ids may lie among existing ones of the greatest key.
  const auto last = std::lower_bound(all.begin(), all.end(), keyed.word(keyed.greatest_key(), 0));
  const auto end = remove_gone(executor, std::span(last, all.end()), keyed.gone());
  auto order = runtime::make_unset_vector<std::uint32_t>(
      executor, static_cast<std::size_t>(end - words.data()));
  parallel_for(executor, order.size(), [&](std::size_t i) { order[i] = keyed.id(words[i]); });
  return order;
}

/// Renumbers corners. Returns the lowest corner of each element, none for deleted ones.
template <int Dim, int Space>
Ids renumbered_lowest(const Executor& executor, Mesh<Dim, Space>& mesh, const Ids& new_vertex) {
  auto lowest_of = runtime::make_unset_vector<std::uint32_t>(executor, mesh.element_slots());
  parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    Corners<Dim>& corners = mesh.corners_of[e];
    lowest_of[e] = none;
    if (!mesh.alive(static_cast<ElementId>(e))) return;
    for (VertexId& v : corners) {
      v = new_vertex[v];
      lowest_of[e] = std::min(lowest_of[e], v);
    }
  });
  return lowest_of;
}

/// Sorts existing elements by their lowest vertex, stably, into an array with room for all, and
/// shrinks it. lowest_of is none for the others.
void sort_elements(Ids& order, const Executor& executor, const Ids& lowest_of,
                   std::size_t vertex_count) {
  auto count_of = runtime::make_unset_vector<std::uint32_t>(executor, vertex_count);
  Grouping grouping(executor, GroupingBounds::even(executor, lowest_of.size(), vertex_count),
                    count_of, [&lowest_of](ElementId element, auto&& visit) {
                      if (lowest_of[element] != none) visit(lowest_of[element]);
                    });
  order.resize(grouping.size());
  grouping.list([&](std::uint32_t place, ElementId element) { order[place] = element; });
}

}  // namespace

template <int Dim, int Space>
Ids order_of_vertices(const Executor& executor, const Mesh<Dim, Space>& mesh, VertexId unlisted) {
  const auto is_alive = [&mesh, unlisted](std::size_t v) {
    return v >= unlisted || mesh.vertex_alive(static_cast<VertexId>(v));
  };
  const Box<Space> box = bounding_box(executor, mesh, is_alive);
  return sorted_ids(executor, mesh.vertex_slots(), hilbert_bits<Space>, is_alive,
                    [&](std::size_t v) { return hilbert_key(mesh.site_of[v].position, box); });
}

Ids places_in(const Executor& executor, const Ids& order, std::size_t count) {
  auto place_of = runtime::make_unset_vector<std::uint32_t>(executor, count);
  parallel_for(executor, order.size(),
               [&](std::size_t i) { place_of[order[i]] = static_cast<std::uint32_t>(i); });
  return place_of;
}

template <int Dim, int Space>
Ids renumber_corners(const Executor& executor, Mesh<Dim, Space>& mesh, const Ids& new_vertex,
                     std::size_t vertex_count) {
  // Allocated first, so that memory freed afterwards is contiguous.
  auto order = runtime::make_unset_vector<std::uint32_t>(executor, mesh.element_slots());
  const Ids lowest_of = renumbered_lowest(executor, mesh, new_vertex);
  sort_elements(order, executor, lowest_of, vertex_count);
  return order;
}

template Ids order_of_vertices(const Executor&, const Mesh<2>&, VertexId);
template Ids order_of_vertices(const Executor&, const Mesh<2, 3>&, VertexId);
template Ids order_of_vertices(const Executor&, const Mesh<3>&, VertexId);
template Ids renumber_corners(const Executor&, Mesh<2>&, const Ids&, std::size_t);
template Ids renumber_corners(const Executor&, Mesh<2, 3>&, const Ids&, std::size_t);
template Ids renumber_corners(const Executor&, Mesh<3>&, const Ids&, std::size_t);

}  // namespace ductile::meshadapt
