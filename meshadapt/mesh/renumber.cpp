/// @file
/// Renumbering: vertices are sorted along a Hilbert curve through the bounding box, elements by
/// their lowest vertex; whatever is gone is left out.
#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <memory>
#include <span>

#include "ductile/meshadapt/mesh.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "mesh/element_lists.hpp"
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// An array that one thread alone neither fills nor touches first.
template <class T>
class Unset {
 public:
  explicit Unset(std::size_t size)
      : values_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}
  std::size_t size() const { return size_; }
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
Box<Dim> bounding_box(const Executor& executor, const Mesh<Dim>& mesh, const Ids& count_of) {
  return runtime::parallel_reduce(
      executor, mesh.vertex_slots(), Box<Dim>::empty(),
      [&](std::size_t v) {
        if (count_of[v] == 0) return Box<Dim>::empty();
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
  std::uint64_t gone() const {
    return fits() ? std::uint64_t{1} << (key_bits_ + id_bits_) : ~std::uint64_t{0};
  }
  std::uint32_t id(std::uint64_t word) const { return static_cast<std::uint32_t>(word & ids()); }

 private:
  bool fits() const { return key_bits_ + id_bits_ < 64; }
  std::uint64_t ids() const { return (std::uint64_t{1} << id_bits_) - 1; }

  unsigned id_bits_, key_bits_;
};

/// The ids below `count` that are alive, by key_of(id); is_alive(id) says whether one is.
Ids sorted_ids(const Executor& executor, std::size_t count, unsigned key_bits, auto&& is_alive,
               auto&& key_of) {
  const KeyedWords keyed(count, key_bits);
  Unset<std::uint64_t> words(count);
  parallel_for(executor, count, [&](std::size_t id) {
    words[id] = is_alive(id) ? keyed.word(key_of(id), id) : keyed.gone();
  });
  const std::span all(words.begin(), count);
  runtime::parallel_sort(executor, all);
  const auto end = std::lower_bound(all.begin(), all.end(), keyed.gone());
  Ids order(static_cast<std::size_t>(end - all.begin()));
  parallel_for(executor, order.size(), [&](std::size_t i) { order[i] = keyed.id(words[i]); });
  return order;
}

/// Vertices that have elements, in the order of the curve.
template <int Dim>
Ids sorted_vertices(const Executor& executor, const Mesh<Dim>& mesh, const Ids& count_of) {
  const Box<Dim> box = bounding_box(executor, mesh, count_of);
  return sorted_ids(
      executor, mesh.vertex_slots(), hilbert_bits<Dim>,
      [&](std::size_t v) { return count_of[v] != 0; },
      [&](std::size_t v) { return hilbert_key(mesh.site_of[v].position, box); });
}

/// Living elements by their lowest vertex, those of a vertex in order.
template <int Dim>
Ids sorted_elements(const Executor& executor, const Mesh<Dim>& mesh) {
  const bool alone = executor.threads() == 1;
  const auto each = [&](auto&& visit) {
    parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
      const auto element = static_cast<ElementId>(e);
      const Corners<Dim>& corners = mesh.corners_of[e];
      if (mesh.alive(element)) visit(*std::min_element(corners.begin(), corners.end()), element);
    });
  };
  Ids end_of(mesh.vertex_slots());  // [vertex], in the order; at first how many elements it has
  parallel_for(executor, end_of.size(), [&](std::size_t v) { end_of[v] = 0; });
  each([&](VertexId v, ElementId) { count_up(end_of[v], alone); });
  Ids order(runtime::exclusive_scan(executor, end_of.all()));
  each([&](VertexId v, ElementId element) { order[count_up(end_of[v], alone)] = element; });
  if (alone) return order;
  parallel_for(executor, end_of.size(), [&](std::size_t v) {
    const std::uint32_t begin = v == 0 ? 0 : end_of[v - 1];
    sort_short(order.all().subspan(begin, end_of[v] - begin));
  });
  return order;
}

/// For each old id its place in the order, for those that are in it.
Ids places_in(const Executor& executor, const Ids& order, std::size_t count) {
  Ids place_of(count);
  parallel_for(executor, order.size(),
               [&](std::size_t i) { place_of[order[i]] = static_cast<std::uint32_t>(i); });
  return place_of;
}

/// Puts arrays in a new order by way of a scratch array. There and back again: pages that are there
/// cost less than new ones.
class Permutation {
 public:
  Permutation(const Executor& executor, const Ids& order, std::size_t largest)
      : executor_(executor),
        order_(order),
        largest_(largest),
        scratch_(std::make_unique_for_overwrite<std::byte[]>(order.size() * largest)) {}

  /// values[i] becomes the old values[order[i]].
  template <class T>
  void operator()(GrowingArray<T>& values) {
    permute<T>([&](std::size_t i) -> T& { return values[i]; });
    values.resize(order_.size());
  }

  /// The same, member by member, for which there must be room.
  template <class T, class... Members>
  void operator()(GrowingArray<T>& values, Members T::*... members) {
    (permute<Members>([&](std::size_t i) -> Members& { return values[i].*members; }), ...);
    values.resize(order_.size());
  }

 private:
  template <class T>
  void permute(auto&& value_at) {
    assert(sizeof(T) <= largest_);
    T* const moved = reinterpret_cast<T*>(scratch_.get());
    parallel_for(executor_, order_.size(),
                 [&](std::size_t i) { std::construct_at(moved + i, value_at(order_[i])); });
    parallel_for(executor_, order_.size(), [&](std::size_t i) { value_at(i) = moved[i]; });
  }

  const Executor& executor_;
  const Ids& order_;
  [[maybe_unused]] std::size_t largest_;  // bytes of a value there is room for
  std::unique_ptr<std::byte[]> scratch_;
};

void renumber_links(const Executor& executor, Mesh<3>& mesh, const Ids& vertices,
                    const Ids& new_vertex) {
  ListPool<CurveLink> moved;
  moved.reset(vertices.size());
  parallel_for(executor, vertices.size(), [&](std::size_t i) {
    for (const CurveLink& link : mesh.links_of.of(vertices[i]))
      moved.insert(static_cast<VertexId>(i), {new_vertex[link.to], link.curve});
  });
  std::swap(mesh.links_of, moved);
}

template <int Dim>
void permute_vertices(const Executor& executor, Mesh<Dim>& mesh, const Ids& order) {
  Permutation permute(executor, order, sizeof(Metric<Dim>));
  permute(mesh.site_of, &Site<Dim>::position, &Site<Dim>::metric, &Site<Dim>::density);
  permute(mesh.kind_of);
  permute(mesh.entity_of);
  permute(mesh.reference_of);
  permute(mesh.host_of);
}

/// How many elements each vertex has.
template <int Dim>
Ids element_counts(const Executor& executor, const Mesh<Dim>& mesh) {
  Ids count_of(mesh.vertex_slots());
  parallel_for(executor, count_of.size(), [&](std::size_t v) { count_of[v] = 0; });
  count_elements<Dim>(executor, mesh, count_of.all());
  return count_of;
}

/// Vertices and corners. Returns how many elements each vertex has, in the new order.
template <int Dim>
Ids renumber_vertices(const Executor& executor, Mesh<Dim>& mesh) {
  const Ids old_count_of = element_counts(executor, mesh);
  const auto order = sorted_vertices(executor, mesh, old_count_of);
  Ids count_of(order.size());
  parallel_for(executor, order.size(),
               [&](std::size_t v) { count_of[v] = old_count_of[order[v]]; });
  const Ids new_vertex = places_in(executor, order, mesh.vertex_slots());
  parallel_for(executor, mesh.element_slots(), [&](std::size_t e) {
    if (mesh.alive(static_cast<ElementId>(e)))
      for (VertexId& v : mesh.corners_of[e]) v = new_vertex[v];
  });
  if constexpr (Dim == 3) renumber_links(executor, mesh, order, new_vertex);
  permute_vertices(executor, mesh, order);
  return count_of;
}

/// Neighbours are left alone if there are none.
template <int Dim>
void renumber_elements(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>* neighbours) {
  const auto order = sorted_elements(executor, mesh);
  Permutation permute(executor, order, sizeof(Corners<Dim>));
  permute(mesh.corners_of);
  permute(mesh.patches_of);
  permute(mesh.region_of);
  permute(mesh.shape_of);
  permute(mesh.changed_at);
  if (neighbours == nullptr) return;
  const Ids new_element = places_in(executor, order, neighbours->size());
  permute(*neighbours);
  parallel_for(executor, neighbours->size(), [&](std::size_t e) {
    for (ElementId& other : (*neighbours)[e])
      if (other != none) other = new_element[other];
  });
}

/// Lists of elements are made anew in the memory that they had: there is no room for both.
template <int Dim>
void renumber_all(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>* neighbours) {
  const Ids count_of = renumber_vertices(executor, mesh);
  renumber_elements(executor, mesh, neighbours);
  list_elements<Dim>(executor, mesh, count_of.all());
}

}  // namespace

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh) {
  renumber_all<Dim>(executor, mesh, nullptr);
}

template <int Dim>
void renumber(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>& neighbours) {
  renumber_all<Dim>(executor, mesh, &neighbours);
}

template void renumber(const Executor&, Mesh<2>&);
template void renumber(const Executor&, Mesh<3>&);
template void renumber(const Executor&, Mesh<2>&, Neighbours<2>&);
template void renumber(const Executor&, Mesh<3>&, Neighbours<3>&);

}  // namespace ductile::meshadapt
