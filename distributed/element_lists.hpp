/// @file
/// Elements in messages: the lists that a part sends to each rank, and the part that a rank makes
/// of those it receives.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "distributed/communicator.hpp"
#include "distributed/listed.hpp"
#include "distributed/part.hpp"
#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

using meshadapt::Metric;

/// An element; its corners are indices into the vertices sent by the same rank.
template <std::size_t N>
struct Simplex {
  std::array<std::uint32_t, N> corners;
  std::int32_t reference;
};

/// A facet or an edge.
template <std::size_t N>
struct Listed : Simplex<N> {
  Marks marks;
};

template <int Dim>
struct Vertex {  ///< in a message
  std::int64_t number;
  std::array<double, Dim> position;
  Metric<Dim> wanted;
  std::int32_t reference;
  std::uint8_t is_held;
};

/// The lists that a part sends to each rank.
template <int Dim>
struct SentElements {
  PerRank<Simplex<Dim + 1>> elements;
  PerRank<Listed<Dim>> facets;
  PerRank<Listed<2>> edges;  // in 3D
  PerRank<Vertex<Dim>> vertices;

  explicit SentElements(std::size_t ranks)
      : elements(ranks), facets(ranks), edges(ranks), vertices(ranks) {}
};

/// Makes the lists for one rank after another.
template <int Dim>
class Sender {
 public:
  /// Sends the elements in elements_to, which may go to several ranks, and their vertices.
  Sender(const Part& part, PerRank<std::uint32_t> elements_to)
      : part_(part),
        elements_to_(std::move(elements_to)),
        facets_to_(elements_to_.size()),
        edges_to_(elements_to_.size()),
        place_of_(part.number_of.size(), 0) {}

  /// Also sends labelled facets and edges, to each rank that gets one of their elements.
  void add_listed(const runtime::Executor& executor, const std::vector<int>& target_of) {
    const auto around = elements_around<Dim>(executor, part_.mesh);
    facets_to_ = targets(meshadapt::facets_in<Dim>(part_.mesh), around, target_of);
    if (Dim == 3) edges_to_ = targets(part_.mesh.edges, around, target_of);
  }

  /// Returns the lists; calls visit(rank, vertex) for their vertices, in order.
  SentElements<Dim> lists(auto&& visit) {
    SentElements<Dim> sent(elements_to_.size());
    for (std::size_t rank = 0; rank < elements_to_.size(); ++rank) {
      const std::vector<VertexId> needed = vertices_of(elements_to_[rank]);
      for (const VertexId v : needed) {
        sent.vertices[rank].push_back(vertex(v));
        visit(rank, v);
      }
      const auto& elements = meshadapt::elements_in<Dim>(part_.mesh);
      for (const std::uint32_t e : elements_to_[rank])
        sent.elements[rank].push_back({places_of(elements.vertices[e]), elements.reference[e]});
      add(meshadapt::facets_in<Dim>(part_.mesh), facets_to_[rank], sent.facets[rank]);
      if constexpr (Dim == 3) add(part_.mesh.edges, edges_to_[rank], sent.edges[rank]);
      for (const VertexId v : needed) place_of_[v] = 0;
    }
    return sent;
  }

 private:
  PerRank<std::uint32_t> targets(const auto& cells, const meshadapt::VertexElements& around,
                                 const std::vector<int>& target_of) const {
    PerRank<std::uint32_t> to(elements_to_.size());
    for (std::uint32_t i = 0; i < cells.size(); ++i) {
      if (cells.reference[i] == unlabelled) continue;
      visit_beside<Dim>(part_.mesh, around, cells.vertices[i], [&](std::uint32_t element) {
        auto& list = to[static_cast<std::size_t>(target_of[element])];
        if (list.empty() || list.back() != i) list.push_back(i);
      });
    }
    return to;
  }

  /// Vertices of elements in the order of their numbers; records their positions.
  std::vector<VertexId> vertices_of(const std::vector<std::uint32_t>& elements) {
    std::vector<VertexId> needed;
    for (const std::uint32_t e : elements)
      for (const VertexId v : meshadapt::elements_in<Dim>(part_.mesh).vertices[e])
        if (std::exchange(place_of_[v], 1) == 0) needed.push_back(v);
    std::sort(needed.begin(), needed.end(),
              [&](VertexId a, VertexId b) { return part_.number_of[a] < part_.number_of[b]; });
    for (std::uint32_t i = 0; i < needed.size(); ++i) place_of_[needed[i]] = i + 1;
    return needed;
  }

  Vertex<Dim> vertex(VertexId v) const {
    return {part_.number_of[v], meshadapt::position_in<Dim>(part_.mesh, v).x,
            part_.wanted.values.empty() ? Metric<Dim>() : wanted_at<Dim>(part_, v),
            part_.mesh.vertex_reference[v],
            part_.is_held.empty() ? std::uint8_t{0} : part_.is_held[v]};
  }

  template <std::size_t N>
  void add(const auto& cells, const std::vector<std::uint32_t>& some,
           std::vector<Listed<N>>& list) const {
    const std::vector<Marks> marks = marks_of(part_.mesh, cells);
    for (const std::uint32_t i : some)
      list.push_back({{places_of(cells.vertices[i]), cells.reference[i]}, marks[i]});
  }

  template <std::size_t N>
  std::array<std::uint32_t, N> places_of(std::array<VertexId, N> corners) const {
    for (std::uint32_t& v : corners) v = place_of_[v] - 1;
    return corners;
  }

  const Part& part_;
  PerRank<std::uint32_t> elements_to_, facets_to_, edges_to_;
  std::vector<std::uint32_t> place_of_;  // [vertex], its index in the current list plus 1, or 0
};

/// Makes a part from received lists, in which shared entities come several times.
template <int Dim>
class Assembly {
 public:
  Assembly(const Received<Vertex<Dim>>& vertices) : vertices_(vertices), part_(empty_part(Dim)) {
    std::vector<std::uint32_t> order(vertices.items.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return vertices.items[a].number < vertices.items[b].number;
    });
    now_.resize(order.size());
    for (const std::uint32_t i : order) {
      const Vertex<Dim>& vertex = vertices.items[i];
      if (part_.number_of.empty() || part_.number_of.back() != vertex.number) {
        add(vertex);
        taken_.push_back(i);
      }
      part_.is_held.back() |= vertex.is_held;
      now_[i] = static_cast<VertexId>(part_.number_of.size() - 1);
    }
    part_.wanted.vertex_count = part_.number_of.size();
  }

  void add_elements(const Received<Simplex<Dim + 1>>& elements) {
    auto& own = meshadapt::elements_in<Dim>(part_.mesh);
    each(elements,
         [&](const auto& corners, const auto& simplex) { own.add(corners, simplex.reference); });
  }

  /// Adds each facet or edge once. Repeated ones combine their marks.
  template <std::size_t N>
  void add_listed(const Received<Listed<N>>& listed) {
    std::vector<std::pair<std::array<VertexId, N>, Listed<N>>> sorted;
    each(listed, [&](const auto& corners, Listed<N> one) {
      auto key = corners;
      std::sort(key.begin(), key.end());
      one.corners = corners;
      sorted.emplace_back(key, one);
    });
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < sorted.size();) {
      const std::size_t first = i;
      Marks marks = 0;
      for (; i < sorted.size() && sorted[i].first == sorted[first].first; ++i)
        marks |= sorted[i].second.marks;
      list(part_.mesh, sorted[first].second.corners, sorted[first].second.reference, marks);
    }
  }

  Part part() { return std::move(part_); }

  /// [vertex of the part] Its index among the received vertices.
  const std::vector<std::uint32_t>& taken() const { return taken_; }

 private:
  void add(const Vertex<Dim>& vertex) {
    part_.number_of.push_back(vertex.number);
    part_.is_held.push_back(vertex.is_held);
    part_.mesh.vertex_reference.push_back(vertex.reference);
    part_.mesh.coordinates.insert(part_.mesh.coordinates.end(), vertex.position.begin(),
                                  vertex.position.end());
    part_.wanted.values.insert(part_.wanted.values.end(), vertex.wanted.m.begin(),
                               vertex.wanted.m.end());
  }

  /// Calls visit(corners, item) with the corners numbered in this part.
  template <class Item>
  void each(const Received<Item>& items, auto&& visit) const {
    for (std::size_t rank = 0; rank + 1 < items.begin.size(); ++rank)
      for (const Item& item : items.from(static_cast<int>(rank))) {
        auto corners = item.corners;
        for (auto& corner : corners) corner = now_[vertices_.begin[rank] + corner];
        visit(corners, item);
      }
  }

  const Received<Vertex<Dim>>& vertices_;
  Part part_;
  std::vector<VertexId> now_;         // [received vertex]
  std::vector<std::uint32_t> taken_;  // [vertex]
};

}  // namespace ductile::distributed
