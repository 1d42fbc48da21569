/// @file
/// Interfaces: entities shared by parts. Ranks find them by sending the facets and vertices on the
/// boundaries of their parts to a rank determined by their numbers, which tells each sender the
/// other senders. Both sides list shared entities in the same order, so values are exchanged
/// without names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "distributed/communicator.hpp"
#include "distributed/part.hpp"

namespace ductile::distributed {

struct SharedVertex {
  VertexId vertex;         ///< in this part
  std::vector<int> ranks;  ///< that have it, including this one, ascending
};

struct SharedFacet {
  std::uint32_t facet;  ///< index into the facets of the mesh
  int rank;             ///< on the other side
};

struct Interfaces {
  std::vector<SharedVertex> vertices;  ///< in the order of their numbers
  std::vector<SharedFacet> facets;     ///< in the order of the numbers of their vertices
};

/// Finds shared vertices and facets of a part that lists its whole boundary; with several ranks,
/// collective.
Interfaces find_interfaces(const Communicator& comm, const Part& part);

/// Exchanges values of shared vertices: calls visit(index, rank, values) for each vertex and each
/// rank that has it, this one included, in the order of the ranks. `values` has `each` for a
/// vertex, in the order of Interfaces::vertices, to which `index` refers. Collective.
template <class T, class Visit>
void visit_at_vertices(const Communicator& comm, const Interfaces& interfaces,
                       const std::vector<T>& values, Visit&& visit, std::size_t each = 1) {
  const auto to = comm.on_all([&] {
    PerRank<T> lists(static_cast<std::size_t>(comm.size()));
    auto own = values.begin();
    for (const SharedVertex& shared : interfaces.vertices) {
      const auto end = own + static_cast<std::ptrdiff_t>(each);
      for (const int rank : shared.ranks) {
        auto& list = lists[static_cast<std::size_t>(rank)];
        list.insert(list.end(), own, end);
      }
      own = end;
    }
    return lists;
  });
  const Received<T> received = comm.exchange(to);
  std::vector<std::size_t> next = received.begin;  // [rank]
  for (std::size_t i = 0; i < interfaces.vertices.size(); ++i)
    for (const int rank : interfaces.vertices[i].ranks) {
      std::size_t& at = next[static_cast<std::size_t>(rank)];
      visit(i, rank, &received.items[at]);
      at += each;
    }
}

/// For each key of a list, all ranks that have it, ascending, if other ranks do; otherwise empty.
/// No rank has a key twice. Collective.
using Key = std::array<std::int64_t, 3>;
std::vector<std::vector<int>> holders_of(const Communicator& comm, const std::vector<Key>& keys);

}  // namespace ductile::distributed
