#include "distributed/migrate.hpp"

#include <algorithm>

#include "distributed/element_lists.hpp"

namespace ductile::distributed {

namespace {

/// Makes the part from the lists of all ranks. Collective.
template <int Dim>
Part received(const Communicator& comm, const SentElements<Dim>& sent) {
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

/// The lists for so many ranks, with facets and edges.
template <int Dim>
SentElements<Dim> lists_for(const runtime::Executor& executor, const Part& part,
                            const std::vector<int>& target_of, std::size_t ranks) {
  PerRank<std::uint32_t> elements_to(ranks);
  for (std::uint32_t e = 0; e < target_of.size(); ++e)
    elements_to[static_cast<std::size_t>(target_of[e])].push_back(e);
  Sender<Dim> sender(part, std::move(elements_to));
  sender.add_listed(executor, target_of);
  return sender.lists([](std::size_t, VertexId) {});
}

template <int Dim>
Part migrated(const Communicator& comm, const runtime::Executor& executor, const Part& part,
              const std::vector<int>& target_of) {
  return received<Dim>(comm, comm.on_all([&] {
    return lists_for<Dim>(executor, part, target_of, static_cast<std::size_t>(comm.size()));
  }));
}

template <int Dim>
Part gathered_everywhere(const Communicator& comm, const runtime::Executor& executor,
                         const Part& part) {
  return received<Dim>(comm, comm.on_all([&] {
    const std::vector<int> to_one(part.element_count(), 0);
    SentElements<Dim> sent = lists_for<Dim>(executor, part, to_one, 1);
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
  visit_at_vertices(comm, interfaces, number_of_shared,
                    [&](std::size_t i, int rank, const std::int64_t* number) {
                      const SharedVertex& shared = interfaces.vertices[i];
                      if (shared.ranks.front() == rank) part.number_of[shared.vertex] = *number;
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
