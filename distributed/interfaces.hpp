/// @file
/// Interfaces: entities shared by parts. Ranks find them by sending the facets and vertices on the
/// boundaries of their parts to a rank determined by their numbers, which tells each sender the
/// other senders. Both sides list shared entities in the same order, so values are exchanged
/// without names.
#pragma once

#include <array>
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

/// Exchanges a value for each shared vertex: calls take(index, rank, value) for each other rank
/// that has it, in the order of the ranks; index refers to Interfaces::vertices. Collective.
template <class T, class Take>
void exchange_at_vertices(const Communicator& comm, const Interfaces& interfaces,
                          const std::vector<T>& value_of, Take&& take) {
  PerRank<T> to(static_cast<std::size_t>(comm.size()));
  PerRank<std::size_t> index(to.size());
  for (std::size_t i = 0; i < interfaces.vertices.size(); ++i)
    for (const int rank : interfaces.vertices[i].ranks) {
      if (rank == comm.rank()) continue;
      to[static_cast<std::size_t>(rank)].push_back(value_of[i]);
      index[static_cast<std::size_t>(rank)].push_back(i);
    }
  const Received<T> received = comm.exchange(to);
  for (int rank = 0; rank < comm.size(); ++rank) {
    const auto values = received.from(rank);
    for (std::size_t k = 0; k < values.size(); ++k)
      take(index[static_cast<std::size_t>(rank)][k], rank, values[k]);
  }
}

/// For each key of a list, all ranks that have it, ascending, if other ranks do; otherwise empty.
/// No rank has a key twice. Collective.
using Key = std::array<std::int64_t, 3>;
std::vector<std::vector<int>> holders_of(const Communicator& comm, const std::vector<Key>& keys);

}  // namespace ductile::distributed
