/// @file
/// Renumbering: vertices are sorted along a Hilbert curve through the bounding box, elements by
/// their lowest vertex; whatever is gone is left out.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/collect.hpp"
#include "ductile/runtime/fresh_memory.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "mesh/grouping.hpp"
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// An array that one thread alone neither fills nor touches first.
template <class T>
class Unset {
 public:
  Unset(const Executor& executor, std::size_t size)
      : values_(runtime::make_unset<T>(executor, size)), size_(size) {}
  std::size_t size() const { return size_; }
  void shrink(std::size_t size) { size_ = size; }
  T* begin() { return values_.get(); }
  std::span<T> all() { return {values_.get(), size_}; }
  std::span<const T> all() const { return {values_.get(), size_}; }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::unique_ptr<T[]> values_;
  std::size_t size_;
};
using Ids = Unset<std::uint32_t>;

template <int Dim>
Box<Dim> bounding_box(const Executor& executor, const Mesh<Dim>& mesh, auto&& is_alive) {
  return runtime::parallel_reduce(
      executor, mesh.vertex_slots(), Box<Dim>::empty(),
      [&](std::size_t v) {
        if (!is_alive(v)) return Box<Dim>::empty();
        return Box<Dim>{mesh.site_of[v].position, mesh.site_of[v].position};
      },
      [](const Box<Dim>& a, const Box<Dim>& b) { return join(a, b); });
}

/// Keys with their ids in the low bits of a word, so that sorting words sorts ids by their keys,
/// those of equal keys in order.
class KeyedWords {
 public:
  /// As many of a key's `key_bits` highest bits count as find place beside an id below `count`.
  KeyedWords(std::size_t count, unsigned key_bits)
      : id_bits_(static_cast<unsigned>(std::bit_width(count))), key_bits_(key_bits) {}

  std::uint64_t word(std::uint64_t key, std::uint64_t id) const {
    return fits() ? key << id_bits_ | id : (key << (64 - key_bits_) & ~ids()) | id;
  }
  /// Greater than all others; the greatest id is below the number that all its bits would make.
  std::uint64_t gone() const { return word(greatest_key(), ids()); }
  std::uint64_t greatest_key() const { return (std::uint64_t{1} << key_bits_) - 1; }
  unsigned id_bits() const { return id_bits_; }
  std::uint32_t id(std::uint64_t word) const { return static_cast<std::uint32_t>(word & ids()); }

 private:
  bool fits() const { return key_bits_ + id_bits_ < 64; }
  std::uint64_t ids() const { return (std::uint64_t{1} << id_bits_) - 1; }

  unsigned id_bits_, key_bits_;
};

/// Moves the words that are not `gone` to the front, in order, and returns their end. Mostly all
/// are gone.
std::uint64_t* remove_gone(const Executor& executor, std::span<std::uint64_t> words,
                           std::uint64_t gone) {
  const auto living = runtime::parallel_collect<std::uint64_t>(executor, words.size(),
                                                               [&](std::size_t i, auto&& append) {
                                                                 if (words[i] != gone)
                                                                   append(words[i]);
                                                               });
  return std::to_address(std::copy(living.begin(), living.end(), words.begin()));
}

/// The ids below `count` that are alive, by key_of(id); is_alive(id) says whether one is.
Ids sorted_ids(const Executor& executor, std::size_t count, unsigned key_bits, auto&& is_alive,
               auto&& key_of) {
  const KeyedWords keyed(count, key_bits);
  Unset<std::uint64_t> words(executor, count);
  parallel_for(executor, count, [&](std::size_t id) {
    words[id] = is_alive(id) ? keyed.word(key_of(id), id) : keyed.gone();
  });
  const std::span all(words.begin(), count);
  runtime::parallel_sort_above(executor, all, keyed.id_bits());  // ids are in order
  // Those that are gone may lie among living ones of the greatest key.
  const auto last = std::lower_bound(all.begin(), all.end(), keyed.word(keyed.greatest_key(), 0));
  const auto end = remove_gone(executor, std::span(last, all.end()), keyed.gone());
  Ids order(executor, static_cast<std::size_t>(end - words.begin()));
  parallel_for(executor, order.size(), [&](std::size_t i) { order[i] = keyed.id(words[i]); });
  return order;
}

/// Vertices that have elements, in the order of the curve.
template <int Dim>
Ids sorted_vertices(const Executor& executor, const Mesh<Dim>& mesh, VertexId unlisted) {
  const auto is_alive = [&mesh, unlisted](std::size_t v) {
    return v >= unlisted || mesh.vertex_alive(static_cast<VertexId>(v));
  };
  const Box<Dim> box = bounding_box(executor, mesh, is_alive);
  return sorted_ids(executor, mesh.vertex_slots(), hilbert_bits<Dim>, is_alive,
                    [&](std::size_t v) { return hilbert_key(mesh.site_of[v].position, box); });
}

/// Puts living elements by their lowest vertex, those of a vertex in order, into an array of room
/// for all, and shrinks it. lowest_of is none for others.
void sort_elements(Ids& order, const Executor& executor, const Ids& lowest_of,
                   std::size_t vertex_count) {
  Ids end_of(executor, vertex_count);  // [vertex], in the order; at first how many elements it has
  Grouping grouping(executor, GroupingBounds::even(executor, lowest_of.size(), vertex_count),
                    end_of.all(), [&lowest_of](ElementId element, auto&& visit) {
                      if (lowest_of[element] != none) visit(lowest_of[element]);
                    });
  order.shrink(grouping.size());
  const auto begin_lists = [&](VertexId begin, VertexId end, std::uint32_t before) {
    for (VertexId v = begin; v < end; ++v) end_of[v] = std::exchange(before, before + end_of[v]);
  };
  grouping.visit(begin_lists, [&](VertexId v, ElementId element) { order[end_of[v]++] = element; });
}

/// For each old id its place in the order, for those that are in it.
Ids places_in(const Executor& executor, const Ids& order, std::size_t count) {
  Ids place_of(executor, count);
  parallel_for(executor, order.size(),
               [&](std::size_t i) { place_of[order[i]] = static_cast<std::uint32_t>(i); });
  return place_of;
}

/// Puts arrays in a new order by way of a scratch array. There and back again: pages that are there
/// cost less than new ones.
class Permutation {
 public:
  /// At most so many bytes are moved at once for each place.
  Permutation(const Executor& executor, const Ids& order, std::size_t largest)
      : executor_(executor),
        order_(order),
        largest_(largest),
        scratch_(runtime::make_unset<std::byte>(executor, order.size() * largest)) {}

  /// values[i] becomes the old values[order[i]], of several arrays at once.
  template <class... T>
  void operator()(GrowingArray<T>&... values) {
    permute<T...>([&values](std::size_t i) -> T& { return values[i]; }...);
    (values.resize(order_.size()), ...);
  }

  /// The same of members, but leaves the array as long as it was.
  template <class T, class... Members>
  void members(GrowingArray<T>& values, Members T::*... members) {
    permute<Members...>(
        [&values, members](std::size_t i) -> Members& { return values[i].*members; }...);
  }

 private:
  /// The most strictly aligned come first.
  template <class... T>
  void permute(auto&&... value_at) {
    assert((sizeof(T) + ...) <= largest_);
    std::byte* end = scratch_.get();
    const auto take = [&](std::size_t bytes) { return std::exchange(end, end + bytes); };
    const std::tuple moved{reinterpret_cast<T*>(take(order_.size() * sizeof(T)))...};
    std::apply(
        [&](T* const... to) {
          parallel_for(executor_, order_.size(), [&](std::size_t i) {
            (std::construct_at(to + i, value_at(order_[i])), ...);
          });
          parallel_for(executor_, order_.size(),
                       [&](std::size_t i) { ((value_at(i) = to[i]), ...); });
        },
        moved);
  }

  const Executor& executor_;
  const Ids& order_;
  [[maybe_unused]] std::size_t largest_;
  std::unique_ptr<std::byte[]> scratch_;
};

void renumber_links(const Executor& executor, Mesh<3>& mesh, const Ids& vertices,
                    const Ids& new_vertex) {
  struct Moved {
    VertexId from;
    CurveLink link;
  };
  const auto moved = runtime::parallel_collect<Moved>(
      executor, vertices.size(), [&](std::size_t i, auto&& append) {
        for (const CurveLink& link : mesh.links_of.of(vertices[i]))
          append(Moved{static_cast<VertexId>(i), {new_vertex[link.to], link.curve}});
      });
  mesh.links_of.reset(executor, vertices.size());
  parallel_for(executor, moved.size(), [&](std::size_t first) {
    const VertexId from = moved[first].from;
    if (first != 0 && moved[first - 1].from == from) return;
    for (std::size_t i = first; i < moved.size() && moved[i].from == from; ++i)
      mesh.links_of.insert(from, moved[i].link);
  });
}

template <int Dim>
void permute_vertices(const Executor& executor, Mesh<Dim>& mesh, const Ids& order) {
  Permutation permute(executor, order, sizeof(Metric<Dim>));
  permute.members(mesh.site_of, &Site<Dim>::metric);
  permute.members(mesh.site_of, &Site<Dim>::position, &Site<Dim>::density);
  mesh.site_of.resize(order.size());
  permute(mesh.entity_of, mesh.reference_of, mesh.host_of, mesh.kind_of);
}

/// Vertices. Returns what they were renumbered to.
template <int Dim>
Ids renumber_vertices(const Executor& executor, Mesh<Dim>& mesh, VertexId unlisted) {
  const auto order = sorted_vertices(executor, mesh, unlisted);
  Ids new_vertex = places_in(executor, order, mesh.vertex_slots());
  if constexpr (Dim == 3) renumber_links(executor, mesh, order, new_vertex);
  permute_vertices(executor, mesh, order);
  return new_vertex;
}

/// The corners of living elements. Returns the lowest of each, none for those that are gone.
template <int Dim>
Ids renumber_corners(const Executor& executor, Mesh<Dim>& mesh, const Ids& new_vertex) {
  Ids lowest_of(executor, mesh.element_slots());
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

/// Elements and, if there are any, their neighbours.
template <int Dim>
void renumber_elements(const Executor& executor, Mesh<Dim>& mesh, const Ids& order,
                       Neighbours<Dim>* neighbours) {
  Permutation permute(executor, order, sizeof(Corners<Dim>));
  permute(mesh.corners_of);
  permute(mesh.patches_of);
  permute(mesh.region_of, mesh.shape_of, mesh.changed_at);
  if (neighbours == nullptr) return;
  const Ids new_element = places_in(executor, order, neighbours->size());
  permute(*neighbours);
  parallel_for(executor, neighbours->size(), [&](std::size_t e) {
    for (ElementId& other : (*neighbours)[e])
      if (other != none) other = new_element[other];
  });
}

template <int Dim>
void renumber_all(const Executor& executor, Mesh<Dim>& mesh, VertexId unlisted,
                  Neighbours<Dim>* neighbours) {
  const auto sorted = [&] {
    const Ids new_vertex = renumber_vertices(executor, mesh, unlisted);
    Ids order(executor,
              mesh.element_slots());  // first, as what is freed behind it is one piece then
    const Ids lowest_of = renumber_corners(executor, mesh, new_vertex);
    sort_elements(order, executor, lowest_of, mesh.vertex_slots());
    return order;
  };
  renumber_elements(executor, mesh, sorted(), neighbours);
  rebuild_elements_of(executor, mesh);
}

}  // namespace

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh, VertexId unlisted) {
  renumber_all<Dim>(executor, mesh, unlisted, nullptr);
}

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>& neighbours) {
  renumber_all<Dim>(executor, mesh, none, &neighbours);
}

template void renumber(const Executor&, Mesh<2>&, VertexId);
template void renumber(const Executor&, Mesh<3>&, VertexId);
template void renumber(const Executor&, Mesh<2>&, Neighbours<2>&);
template void renumber(const Executor&, Mesh<3>&, Neighbours<3>&);

}  // namespace ductile::meshadapt
