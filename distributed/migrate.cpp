#include "distributed/migrate.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "distributed/listed.hpp"

namespace ductile::distributed {

namespace {

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
struct Vertex {
  std::int64_t number;
  std::array<double, Dim> position;
  Metric<Dim> wanted;
  std::int32_t reference;
  std::uint8_t is_held;
};

/// The lists that a part sends to each rank.
template <int Dim>
struct Sent {
  PerRank<Simplex<Dim + 1>> elements;
  PerRank<Listed<Dim>> facets;
  PerRank<Listed<2>> edges;  // in 3D
  PerRank<Vertex<Dim>> vertices;

  explicit Sent(std::size_t ranks)
      : elements(ranks), facets(ranks), edges(ranks), vertices(ranks) {}
};

/// Makes the lists for one rank after another.
template <int Dim>
class Sender {
 public:
  Sender(const runtime::Executor& executor, const Part& part, const std::vector<int>& target_of,
         std::size_t ranks)
      : part_(part), elements_to_(ranks), place_of_(part.number_of.size(), 0) {
    for (std::uint32_t e = 0; e < target_of.size(); ++e)
      elements_to_[static_cast<std::size_t>(target_of[e])].push_back(e);
    const auto around = elements_around<Dim>(executor, part.mesh);
    facets_to_ = targets(meshadapt::facets_in<Dim>(part.mesh), around, target_of);
    if (Dim == 3) edges_to_ = targets(part.mesh.edges, around, target_of);
  }

  Sent<Dim> lists() {
    Sent<Dim> sent(elements_to_.size());
    for (std::size_t rank = 0; rank < elements_to_.size(); ++rank) {
      const std::vector<VertexId> needed = vertices_of(elements_to_[rank]);
      for (const VertexId v : needed) sent.vertices[rank].push_back(vertex(v));
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
  /// Facets and edges with a label go wherever one of their elements goes.
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
            wanted_at<Dim>(part_, v), part_.mesh.vertex_reference[v],
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
  std::vector<std::uint32_t> place_of_;  // [vertex], position in the current list plus 1; 0: not in
                                         // it
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
      if (part_.number_of.empty() || part_.number_of.back() != vertex.number) add(vertex);
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
  std::vector<VertexId> now_;  // [received vertex]
};

/// Makes the part from the lists of all ranks. Collective.
template <int Dim>
Part received(const Communicator& comm, const Sent<Dim>& sent) {
  const auto elements = comm.exchange(sent.elements);
  const auto facets = comm.exchange(sent.facets);
  const auto vertices = comm.exchange(sent.vertices);
  const auto edges = Dim == 3 ? comm.exchange(sent.edges) : Received<Listed<2>>();
  return comm.on_all([&] {
    Assembly<Dim> assembly(vertices);
    assembly.add_elements(elements);
    assembly.add_listed(facets);
    if (Dim == 3) assembly.add_listed(edges);
    return assembly.part();
  });
}

template <int Dim>
Part migrated(const Communicator& comm, const runtime::Executor& executor, const Part& part,
              const std::vector<int>& target_of) {
  return received<Dim>(comm, comm.on_all([&] {
    return Sender<Dim>(executor, part, target_of, static_cast<std::size_t>(comm.size())).lists();
  }));
}

template <int Dim>
Part gathered_everywhere(const Communicator& comm, const runtime::Executor& executor,
                         const Part& part) {
  return received<Dim>(comm, comm.on_all([&] {
    const std::vector<int> to_one(part.element_count(), 0);
    Sent<Dim> sent = Sender<Dim>(executor, part, to_one, 1).lists();
    const auto ranks = static_cast<std::size_t>(comm.size());
    sent.elements.resize(ranks, sent.elements.front());
    sent.facets.resize(ranks, sent.facets.front());
    sent.edges.resize(ranks, sent.edges.front());
    sent.vertices.resize(ranks, sent.vertices.front());
    return sent;
  }));
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

Part migrate(const Communicator& comm, const runtime::Executor& executor, const Part& part,
             const std::vector<int>& target_of) {
  Part result = part.mesh.dimension == 2 ? migrated<2>(comm, executor, part, target_of)
                                         : migrated<3>(comm, executor, part, target_of);
  result.mesh.name = part.mesh.name;
  return result;
}

Part gather_on_first(const Communicator& comm, const runtime::Executor& executor,
                     const Part& part) {
  if (comm.size() == 1) return part;
  return migrate(comm, executor, part, std::vector<int>(part.element_count(), 0));
}

Part gather_everywhere(const Communicator& comm, const runtime::Executor& executor,
                       const Part& part) {
  return part.mesh.dimension == 2 ? gathered_everywhere<2>(comm, executor, part)
                                  : gathered_everywhere<3>(comm, executor, part);
}

}  // namespace ductile::distributed
