#include "migrate.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "ductile/meshadapt/metric.hpp"
#include "elements_around.hpp"

namespace ductile::petsc {

namespace {

using meshadapt::Metric;

/// An element, or a facet: corners are places in the list of vertices that the same rank sends.
template <std::size_t N>
struct Simplex {
  std::array<std::uint32_t, N> corners;
  std::int32_t reference;
};

template <int Dim>
struct Vertex {
  std::int64_t number;
  std::array<double, Dim> position;
  Metric<Dim> wanted;
  std::int32_t reference;
  std::uint8_t is_held;
};

/// What a part sends to each rank.
template <int Dim>
struct Sent {
  PerRank<Simplex<Dim + 1>> elements;
  PerRank<Simplex<Dim>> facets;
  PerRank<Vertex<Dim>> vertices;
};

/// Lists for one rank after the other.
template <int Dim>
class Sender {
 public:
  Sender(const Part& part, const std::vector<int>& target_of, std::size_t ranks)
      : part_(part), elements_to_(ranks), facets_to_(ranks), place_of_(part.number_of.size(), 0) {
    for (std::uint32_t e = 0; e < target_of.size(); ++e)
      elements_to_[static_cast<std::size_t>(target_of[e])].push_back(e);
    list_facets(target_of);
  }

  Sent<Dim> lists() {
    const std::size_t ranks = elements_to_.size();
    Sent<Dim> sent{PerRank<Simplex<Dim + 1>>(ranks), PerRank<Simplex<Dim>>(ranks),
                   PerRank<Vertex<Dim>>(ranks)};
    for (std::size_t rank = 0; rank < ranks; ++rank) {
      const std::vector<VertexId> needed = vertices_of(elements_to_[rank]);
      for (const VertexId v : needed) sent.vertices[rank].push_back(vertex(v));
      add(meshadapt::elements_in<Dim>(part_.mesh), elements_to_[rank], sent.elements[rank]);
      add(meshadapt::facets_in<Dim>(part_.mesh), facets_to_[rank], sent.facets[rank]);
      for (const VertexId v : needed) place_of_[v] = 0;
    }
    return sent;
  }

 private:
  /// Facets with a label go wherever one of their elements goes.
  void list_facets(const std::vector<int>& target_of) {
    const auto& facets = meshadapt::facets_in<Dim>(part_.mesh);
    const ElementsAround<Dim> around(part_.mesh);
    for (std::uint32_t f = 0; f < facets.size(); ++f) {
      if (facets.reference[f] == unlabelled) continue;
      int sent_to = -1;
      around.visit_beside(facets.vertices[f], [&](std::uint32_t element) {
        const int target = target_of[element];
        if (std::exchange(sent_to, target) != target)
          facets_to_[static_cast<std::size_t>(target)].push_back(f);
      });
    }
  }

  /// In the order of their numbers, with their places noted.
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
    Vertex<Dim> result{part_.number_of[v],
                       meshadapt::position_in<Dim>(part_.mesh, v).x,
                       {},
                       part_.mesh.vertex_reference[v],
                       part_.is_held.empty() ? std::uint8_t{0} : part_.is_held[v]};
    std::copy_n(&part_.wanted.values[v * Metric<Dim>::size], Metric<Dim>::size,
                result.wanted.m.begin());
    return result;
  }

  template <std::size_t N>
  void add(const auto& cells, const std::vector<std::uint32_t>& some,
           std::vector<Simplex<N>>& list) const {
    list.reserve(some.size());
    for (const std::uint32_t i : some) {
      Simplex<N> simplex{{}, cells.reference[i]};
      for (std::size_t k = 0; k < N; ++k) simplex.corners[k] = place_of_[cells.vertices[i][k]] - 1;
      list.push_back(simplex);
    }
  }

  const Part& part_;
  PerRank<std::uint32_t> elements_to_, facets_to_;
  std::vector<std::uint32_t> place_of_;  // [vertex], in the list for one rank, and 1; 0: not there
};

/// A part made of what ranks have sent; what is shared comes several times.
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
      if (part_.number_of.empty() || part_.number_of.back() != vertex.number) add(vertex);
      part_.is_held.back() |= vertex.is_held;
      now_[i] = static_cast<VertexId>(part_.number_of.size() - 1);
    }
    part_.wanted.vertex_count = part_.number_of.size();
  }

  Part part(const Received<Simplex<Dim + 1>>& elements, const Received<Simplex<Dim>>& facets) {
    auto& own = meshadapt::elements_in<Dim>(part_.mesh);
    each(elements,
         [&](const auto& corners, std::int32_t reference) { own.add(corners, reference); });
    std::vector<std::pair<meshadapt::Facet<Dim>, LabelledFacet>> sorted;
    each(facets, [&](const auto& corners, std::int32_t reference) {
      auto key = corners;
      std::sort(key.begin(), key.end());
      sorted.push_back({key, {corners, reference}});
    });
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto twice = std::unique(sorted.begin(), sorted.end(),
                                   [](const auto& a, const auto& b) { return a.first == b.first; });
    sorted.erase(twice, sorted.end());
    for (const auto& [key, facet] : sorted)
      meshadapt::facets_in<Dim>(part_.mesh).add(facet.corners, facet.reference);
    return std::move(part_);
  }

 private:
  struct LabelledFacet {
    meshadapt::Facet<Dim> corners;
    std::int32_t reference;
  };

  void add(const Vertex<Dim>& vertex) {
    part_.number_of.push_back(vertex.number);
    part_.is_held.push_back(vertex.is_held);
    part_.mesh.vertex_reference.push_back(vertex.reference);
    part_.mesh.coordinates.insert(part_.mesh.coordinates.end(), vertex.position.begin(),
                                  vertex.position.end());
    part_.wanted.values.insert(part_.wanted.values.end(), vertex.wanted.m.begin(),
                               vertex.wanted.m.end());
  }

  template <std::size_t N>
  void each(const Received<Simplex<N>>& received, auto&& visit) const {
    for (std::size_t rank = 0; rank + 1 < vertices_.begin.size(); ++rank)
      for (const Simplex<N>& simplex : received.from(static_cast<int>(rank))) {
        std::array<VertexId, N> corners;
        for (std::size_t k = 0; k < N; ++k)
          corners[k] = now_[vertices_.begin[rank] + simplex.corners[k]];
        visit(corners, simplex.reference);
      }
  }

  const Received<Vertex<Dim>>& vertices_;
  Part part_;
  std::vector<VertexId> now_;  // [received vertex]
};

/// The part made of what all ranks send. Collective.
template <int Dim>
Part received(const Communicator& comm, const Sent<Dim>& sent) {
  const auto elements = comm.exchange(sent.elements);
  const auto facets = comm.exchange(sent.facets);
  const auto vertices = comm.exchange(sent.vertices);
  return comm.on_all([&] { return Assembly<Dim>(vertices).part(elements, facets); });
}

}  // namespace

std::int64_t number_vertices(const Communicator& comm, const Interfaces& interfaces, Part& part) {
  std::fill(part.number_of.begin(), part.number_of.end(), -1);
  constexpr std::int64_t of_another = -2;
  for (const SharedVertex& shared : interfaces.vertices)
    if (shared.ranks.front() != comm.rank()) part.number_of[shared.vertex] = of_another;
  const auto own =
      static_cast<std::int64_t>(std::count(part.number_of.begin(), part.number_of.end(), -1));
  std::int64_t next = comm.sum_before(own);
  for (std::int64_t& number : part.number_of)
    if (number == -1) number = next++;
  std::vector<std::int64_t> number_of_shared;
  for (const SharedVertex& shared : interfaces.vertices)
    number_of_shared.push_back(part.number_of[shared.vertex]);
  exchange_at_vertices(comm, interfaces, number_of_shared,
                       [&](std::size_t i, int rank, std::int64_t number) {
                         const SharedVertex& shared = interfaces.vertices[i];
                         if (shared.ranks.front() == rank) part.number_of[shared.vertex] = number;
                       });
  return own;
}

template <int Dim>
Part migrate(const Communicator& comm, const Part& part, const std::vector<int>& target_of) {
  return received<Dim>(comm, comm.on_all([&] {
    return Sender<Dim>(part, target_of, static_cast<std::size_t>(comm.size())).lists();
  }));
}

template <int Dim>
Part gather_everywhere(const Communicator& comm, const Part& part) {
  return received<Dim>(comm, comm.on_all([&] {
    Sent<Dim> sent = Sender<Dim>(part, std::vector<int>(part.element_count(), 0), 1).lists();
    const auto ranks = static_cast<std::size_t>(comm.size());
    sent.elements.resize(ranks, sent.elements.front());
    sent.facets.resize(ranks, sent.facets.front());
    sent.vertices.resize(ranks, sent.vertices.front());
    return sent;
  }));
}

template Part gather_everywhere<2>(const Communicator&, const Part&);
template Part gather_everywhere<3>(const Communicator&, const Part&);
template Part migrate<2>(const Communicator&, const Part&, const std::vector<int>&);
template Part migrate<3>(const Communicator&, const Part&, const std::vector<int>&);

}  // namespace ductile::petsc
