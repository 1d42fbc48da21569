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
#include "mesh/hilbert.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim>
Box<Dim> bounding_box(const Executor& executor, const Mesh<Dim>& mesh) {
  return runtime::parallel_reduce(
      executor, mesh.vertex_slots(), Box<Dim>::empty(),
      [&](std::size_t v) {
        if (!mesh.vertex_alive(static_cast<VertexId>(v))) return Box<Dim>::empty();
        return Box<Dim>{mesh.site_of[v].position, mesh.site_of[v].position};
      },
      [](const Box<Dim>& a, const Box<Dim>& b) { return join(a, b); });
}

/// An array that one thread alone neither fills nor touches first.
template <class T>
class Unset {
 public:
  explicit Unset(std::size_t size)
      : values_(std::make_unique_for_overwrite<T[]>(size)), size_(size) {}
  std::size_t size() const { return size_; }
  T* begin() { return values_.get(); }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }

 private:
  std::unique_ptr<T[]> values_;
  std::size_t size_;
};
using Ids = Unset<std::uint32_t>;

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

/// Living vertices in the order of the curve.
template <int Dim>
Ids sorted_vertices(const Executor& executor, const Mesh<Dim>& mesh) {
  const Box<Dim> box = bounding_box(executor, mesh);
  return sorted_ids(
      executor, mesh.vertex_slots(), hilbert_bits<Dim>,
      [&](std::size_t v) { return mesh.vertex_alive(static_cast<VertexId>(v)); },
      [&](std::size_t v) { return hilbert_key(mesh.site_of[v].position, box); });
}

/// Living elements by their lowest vertex in the new numbering.
template <int Dim>
Ids sorted_elements(const Executor& executor, const Mesh<Dim>& mesh, const Ids& new_id) {
  const auto lowest_vertex = [&](std::size_t e) {
    VertexId lowest = none;
    for (const VertexId v : mesh.corners_of[e]) lowest = std::min(lowest, new_id[v]);
    return lowest;
  };
  return sorted_ids(
      executor, mesh.element_slots(), static_cast<unsigned>(std::bit_width(new_id.size())),
      [&](std::size_t e) { return mesh.alive(static_cast<ElementId>(e)); }, lowest_vertex);
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
    assert(sizeof(T) <= largest_);
    T* const moved = reinterpret_cast<T*>(scratch_.get());
    const std::size_t n = order_.size();
    parallel_for(executor_, n,
                 [&](std::size_t i) { std::construct_at(moved + i, values[order_[i]]); });
    values.resize(n);
    runtime::parallel_for_ranges(executor_, n, [&](std::size_t begin, std::size_t end) {
      std::copy(moved + begin, moved + end, values.begin() + begin);
    });
  }

 private:
  const Executor& executor_;
  const Ids& order_;
  [[maybe_unused]] std::size_t largest_;  // bytes of a value there is room for
  std::unique_ptr<std::byte[]> scratch_;
};

/// The lists of elements in the new order of vertices, with the new ids of elements.
template <int Dim>
void renumber_elements_of(const Executor& executor, Mesh<Dim>& mesh, const Ids& vertices,
                          const Ids& new_element) {
  ListPool<ElementId> moved;
  moved.reset(vertices.size());
  const auto old_list = [&](VertexId v) { return mesh.elements_of.of(vertices[v]); };
  const auto move = [&](std::size_t, std::size_t begin, std::size_t end) {
    const auto first = static_cast<VertexId>(begin), last = static_cast<VertexId>(end);
    moved.reserve_all(first, last, [&](VertexId v) {
      return static_cast<std::uint32_t>(old_list(v).size()) + list_slack<Dim>;
    });
    for (VertexId v = first; v < last; ++v)
      for (const ElementId e : old_list(v)) moved.insert(v, new_element[e]);
  };
  runtime::parallel_for_blocks(executor, vertices.size(), list_block, move);
  std::swap(mesh.elements_of, moved);
}

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
void permute_elements(const Executor& executor, Mesh<Dim>& mesh, const Ids& order) {
  Permutation permute(executor, order, sizeof(Corners<Dim>));
  permute(mesh.corners_of);
  permute(mesh.patches_of);
  permute(mesh.region_of);
  permute(mesh.shape_of);
  permute(mesh.changed_at);
}

template <int Dim>
void permute_vertices(const Executor& executor, Mesh<Dim>& mesh, const Ids& order) {
  Permutation permute(executor, order, sizeof(Site<Dim>));
  permute(mesh.site_of);
  permute(mesh.kind_of);
  permute(mesh.entity_of);
  permute(mesh.reference_of);
  permute(mesh.host_of);
}

/// Neighbours are left alone if there are none.
template <int Dim>
void renumber_all(const Executor& executor, Mesh<Dim>& mesh, Neighbours<Dim>* neighbours) {
  const auto vertices = sorted_vertices(executor, mesh);
  const auto new_vertex = places_in(executor, vertices, mesh.vertex_slots());
  const auto elements = sorted_elements(executor, mesh, new_vertex);
  const auto new_element = places_in(executor, elements, mesh.element_slots());
  renumber_elements_of(executor, mesh, vertices, new_element);
  if constexpr (Dim == 3) renumber_links(executor, mesh, vertices, new_vertex);
  permute_elements(executor, mesh, elements);
  parallel_for(executor, elements.size(), [&](std::size_t e) {
    for (VertexId& v : mesh.corners_of[e]) v = new_vertex[v];
  });
  permute_vertices(executor, mesh, vertices);
  if (neighbours == nullptr) return;
  Permutation(executor, elements, sizeof(Corners<Dim>))(*neighbours);
  parallel_for(executor, elements.size(), [&](std::size_t e) {
    for (ElementId& other : (*neighbours)[e])
      if (other != none) other = new_element[other];
  });
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
