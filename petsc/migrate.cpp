#include "migrate.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

#include "ductile/meshadapt/metric.hpp"
#include "elements_around.hpp"

namespace ductile::petsc {

namespace {

using meshadapt::Metric;

/// An element, or a facet, as others know it.
template <std::size_t N>
struct Simplex {
  std::array<std::int64_t, N> corners;
  std::int32_t reference;
};

template <int Dim>
struct Vertex {
  std::int64_t number;
  std::array<double, Dim> position;
  Metric<Dim> wanted;
  std::int32_t reference;
  std::uint8_t was_shared;
};

template <std::size_t N>
Simplex<N> numbered(const Part& part, const std::array<VertexId, N>& corners,
                    std::int32_t reference) {
  Simplex<N> result{{}, reference};
  for (std::size_t i = 0; i < N; ++i) result.corners[i] = part.number_of[corners[i]];
  return result;
}

template <int Dim>
PerRank<Simplex<Dim + 1>> elements_to(const Part& part, const std::vector<int>& target_of,
                                      std::size_t ranks) {
  PerRank<Simplex<Dim + 1>> to(ranks);
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh);
  for (std::size_t e = 0; e < elements.size(); ++e)
    to[static_cast<std::size_t>(target_of[e])].push_back(
        numbered(part, elements.vertices[e], elements.reference[e]));
  return to;
}

/// Facets with a label go wherever one of their elements goes.
template <int Dim>
PerRank<Simplex<Dim>> facets_to(const Part& part, const std::vector<int>& target_of,
                                std::size_t ranks) {
  PerRank<Simplex<Dim>> to(ranks);
  const auto& facets = meshadapt::facets_in<Dim>(part.mesh);
  const ElementsAround<Dim> around(part.mesh);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (facets.reference[f] == unlabelled) continue;
    int sent_to = -1;
    around.visit_beside(facets.vertices[f], [&](std::uint32_t element) {
      const int target = target_of[element];
      if (std::exchange(sent_to, target) != target)
        to[static_cast<std::size_t>(target)].push_back(
            numbered(part, facets.vertices[f], facets.reference[f]));
    });
  }
  return to;
}

template <int Dim>
PerRank<Vertex<Dim>> vertices_to(const Part& part, const std::vector<int>& target_of,
                                 std::size_t ranks) {
  PerRank<VertexId> needed(ranks);
  const auto& elements = meshadapt::elements_in<Dim>(part.mesh);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    auto& list = needed[static_cast<std::size_t>(target_of[e])];
    list.insert(list.end(), elements.vertices[e].begin(), elements.vertices[e].end());
  }
  PerRank<Vertex<Dim>> to(ranks);
  for (std::size_t rank = 0; rank < ranks; ++rank) {
    auto& list = needed[rank];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (const VertexId v : list) {
      Vertex<Dim> vertex{part.number_of[v],
                         meshadapt::position_in<Dim>(part.mesh, v).x,
                         {},
                         part.mesh.vertex_reference[v],
                         part.was_shared.empty() ? std::uint8_t{0} : part.was_shared[v]};
      std::copy_n(&part.wanted.values[v * Metric<Dim>::size], Metric<Dim>::size,
                  vertex.wanted.m.begin());
      to[rank].push_back(vertex);
    }
  }
  return to;
}

/// A part made of what ranks have sent; what is shared comes several times.
template <int Dim>
Part assemble(std::vector<Vertex<Dim>> vertices, const std::vector<Simplex<Dim + 1>>& elements,
              std::vector<Simplex<Dim>> facets) {
  std::stable_sort(vertices.begin(), vertices.end(),
                   [](const auto& a, const auto& b) { return a.number < b.number; });
  Part part = empty_part(Dim);
  for (const Vertex<Dim>& vertex : vertices) {
    if (!part.number_of.empty() && part.number_of.back() == vertex.number) continue;
    part.number_of.push_back(vertex.number);
    part.was_shared.push_back(vertex.was_shared);
    part.mesh.vertex_reference.push_back(vertex.reference);
    part.mesh.coordinates.insert(part.mesh.coordinates.end(), vertex.position.begin(),
                                 vertex.position.end());
    part.wanted.values.insert(part.wanted.values.end(), vertex.wanted.m.begin(),
                              vertex.wanted.m.end());
  }
  part.wanted.vertex_count = part.number_of.size();
  const auto add = [&]<std::size_t N>(const Simplex<N>& simplex, auto& cells) {
    std::array<VertexId, N> corners;
    for (std::size_t i = 0; i < N; ++i)
      corners[i] = static_cast<VertexId>(
          std::lower_bound(part.number_of.begin(), part.number_of.end(), simplex.corners[i]) -
          part.number_of.begin());
    cells.add(corners, simplex.reference);
  };
  for (const auto& element : elements) add(element, meshadapt::elements_in<Dim>(part.mesh));
  const auto key = [](const Simplex<Dim>& facet) {
    auto corners = facet.corners;
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::stable_sort(facets.begin(), facets.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
  const auto end = std::unique(facets.begin(), facets.end(),
                               [&](const auto& a, const auto& b) { return key(a) == key(b); });
  for (auto facet = facets.begin(); facet != end; ++facet)
    add(*facet, meshadapt::facets_in<Dim>(part.mesh));
  return part;
}

/// The part made of what comes where elements go as target_of says; lists(those of all targets)
/// are the lists for all ranks. Collective.
template <int Dim>
Part sent(const Communicator& comm, const Part& part, const std::vector<int>& target_of,
          std::size_t targets, auto&& lists) {
  const auto elements =
      comm.exchange(comm.on_all([&] { return lists(elements_to<Dim>(part, target_of, targets)); }));
  auto facets =
      comm.exchange(comm.on_all([&] { return lists(facets_to<Dim>(part, target_of, targets)); }));
  auto vertices =
      comm.exchange(comm.on_all([&] { return lists(vertices_to<Dim>(part, target_of, targets)); }));
  return comm.on_all([&] {
    return assemble<Dim>(std::move(vertices.items), elements.items, std::move(facets.items));
  });
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
  return sent<Dim>(comm, part, target_of, static_cast<std::size_t>(comm.size()),
                   [](auto lists) { return lists; });
}

template <int Dim>
Part gather_everywhere(const Communicator& comm, const Part& part) {
  const std::vector<int> to_one(part.element_count(), 0);
  return sent<Dim>(comm, part, to_one, 1, [&](const auto& lists) {
    return std::decay_t<decltype(lists)>(static_cast<std::size_t>(comm.size()), lists.front());
  });
}

template Part gather_everywhere<2>(const Communicator&, const Part&);
template Part gather_everywhere<3>(const Communicator&, const Part&);
template Part migrate<2>(const Communicator&, const Part&, const std::vector<int>&);
template Part migrate<3>(const Communicator&, const Part&, const std::vector<int>&);

}  // namespace ductile::petsc
