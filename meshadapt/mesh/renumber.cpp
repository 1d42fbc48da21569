/// @file
/// Permutes the arrays of a mesh into the order of its new numbers.
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <memory>
#include <tuple>
#include <utility>

#include "core/first_bad.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"
#include "mesh/mesh.hpp"
#include "mesh/numbering.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

/// Permutes arrays through a scratch array and back, because reusing its pages is cheaper than new
/// ones.
class Permutation {
 public:
  /// Moves at most this many bytes per entry at once.
  Permutation(const Executor& executor, const Ids& order, std::size_t largest)
      : executor_(executor),
        order_(order),
        largest_(largest),
        scratch_(runtime::make_unset_vector<std::byte>(executor, order.size() * largest)) {}

  /// Sets values[i] to the old values[order[i]], for several arrays at once.
  template <class... T>
  void operator()(GrowingArray<T>&... values) {
    permute<T...>([&values](std::size_t i) -> T& { return values[i]; }...);
    (values.resize(order_.size()), ...);
  }

  /// The same for an array of arrays, two members at a time.
  template <class T, std::size_t N>
  void by_pairs(GrowingArray<std::array<T, N>>& values) {
    const auto member = [&values](std::size_t k) {
      return [&values, k](std::size_t i) -> T& { return values[i][k]; };
    };
    for (std::size_t k = 0; k + 1 < N; k += 2) permute<T, T>(member(k), member(k + 1));
    if constexpr (N % 2 == 1) permute<T>(member(N - 1));
    values.resize(order_.size());
  }

  /// The same for members, but the array keeps its length.
  template <class T, class... Members>
  void members(GrowingArray<T>& values, Members T::*... members) {
    permute<Members...>(
        [&values, members](std::size_t i) -> Members& { return values[i].*members; }...);
  }

 private:
  /// Types with the strictest alignment come first.
  template <class... T>
  void permute(auto&&... value_at) {
    assert((sizeof(T) + ...) <= largest_);
    std::byte* end = scratch_.data();
    const auto take = [&](std::size_t bytes) { return std::exchange(end, end + bytes); };
    const std::tuple moved{reinterpret_cast<T*>(take(order_.size() * sizeof(T)))...};
    std::apply(
        [&](T* const... to) {
          parallel_for(
              executor_, order_.size(),
              [&](std::size_t i) { (std::construct_at(to + i, value_at(order_[i])), ...); },
              runtime::few_nanoseconds);
          parallel_for(
              executor_, order_.size(), [&](std::size_t i) { ((value_at(i) = to[i]), ...); },
              runtime::few_nanoseconds);
        },
        moved);
  }

  const Executor& executor_;
  const Ids& order_;
  [[maybe_unused]] std::size_t largest_;
  runtime::UnsetVector<std::byte> scratch_;
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

template <int Dim, int Space>
void permute_vertices(const Executor& executor, Mesh<Dim, Space>& mesh, const Ids& order) {
  Permutation permute(executor, order, sizeof(Metric<Space>));
  permute.members(mesh.site_of, &Site<Space>::metric);
  permute.members(mesh.site_of, &Site<Space>::position, &Site<Space>::scale);
  mesh.site_of.resize(order.size());
  permute(mesh.entity_of, mesh.reference_of, mesh.host_of, mesh.kind_of);
}

/// Renumbers vertices; returns their new numbers.
template <int Dim, int Space>
Ids renumber_vertices(const Executor& executor, Mesh<Dim, Space>& mesh, Ids order) {
  Ids new_vertex = places_in(executor, order, mesh.vertex_slots());
  if constexpr (Dim == 3) renumber_links(executor, mesh, order, new_vertex);
  permute_vertices(executor, mesh, order);
  return new_vertex;
}

/// Renumbers elements and, if given, their neighbours.
template <int Dim, int Space>
void renumber_elements(const Executor& executor, Mesh<Dim, Space>& mesh, const Ids& order,
                       Neighbours<Dim>* neighbours) {
  Permutation permute(executor, order, 2 * sizeof(VertexId));
  permute.by_pairs(mesh.corners_of);
  permute.by_pairs(mesh.patches_of);
  permute(mesh.region_of, mesh.quality_of);
  permute(mesh.changed_at);
  if (neighbours == nullptr) return;
  const Ids new_element = places_in(executor, order, neighbours->size());
  permute.by_pairs(*neighbours);
  parallel_for(executor, neighbours->size(), [&](std::size_t e) {
    for (ElementId& other : (*neighbours)[e])
      if (other != none) other = new_element[other];
  });
}

template <int Dim, int Space>
void renumber_all(const Executor& executor, Mesh<Dim, Space>& mesh, Ids order_of_vertices,
                  Neighbours<Dim>* neighbours) {
  const auto ordered = [&] {
    const Ids new_vertex = renumber_vertices(executor, mesh, std::move(order_of_vertices));
    return renumber_corners(executor, mesh, new_vertex, mesh.vertex_slots());
  };
  renumber_elements(executor, mesh, ordered(), neighbours);
  rebuild_elements_of(executor, mesh);
}

/// Is every vertex in its place already?
bool keeps_all(const Executor& executor, const Ids& order, std::size_t count) {
  return order.size() == count &&
         first_bad(executor, count, [&](std::size_t i) { return order[i] != i; }) == no_index;
}

/// Are elements in the order of their lowest corners, and none deleted?
template <int Dim, int Space>
bool elements_are_in_order(const Executor& executor, const Mesh<Dim, Space>& mesh) {
  const auto lowest_of = [&](std::size_t element) {
    return *std::min_element(mesh.corners_of[element].begin(), mesh.corners_of[element].end());
  };
  return first_bad(executor, mesh.element_slots(), [&](std::size_t e) {
           return !mesh.alive(static_cast<ElementId>(e)) ||
                  (e != 0 && lowest_of(e) < lowest_of(e - 1));
         }) == no_index;
}

}  // namespace

template <int Dim, int Space>
void renumber(const Executor& executor, Mesh<Dim, Space>& mesh, VertexId unlisted) {
  renumber_all<Dim, Space>(executor, mesh, order_of_vertices(executor, mesh, unlisted), nullptr);
}

template <int Dim, int Space>
void renumber(const Executor& executor, Mesh<Dim, Space>& mesh, Neighbours<Dim>& neighbours) {
  Ids order = order_of_vertices(executor, mesh, none);
  // True if the mesh has been adapted before.
  if (keeps_all(executor, order, mesh.vertex_slots()) && elements_are_in_order(executor, mesh))
    return;
  renumber_all(executor, mesh, std::move(order), &neighbours);
}

template void renumber(const Executor&, Mesh<2>&, VertexId);
template void renumber(const Executor&, Mesh<2, 3>&, VertexId);
template void renumber(const Executor&, Mesh<3>&, VertexId);
template void renumber(const Executor&, Mesh<2>&, Neighbours<2>&);
template void renumber(const Executor&, Mesh<2, 3>&, Neighbours<2>&);
template void renumber(const Executor&, Mesh<3>&, Neighbours<3>&);

}  // namespace ductile::meshadapt
