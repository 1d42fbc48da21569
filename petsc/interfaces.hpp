/// @file
/// Interfaces: what parts share. Ranks find out by sending the facets and vertices of their parts'
/// boundaries to a rank that the numbers say, which tells each of them who else has sent the same.
/// Both sides list what they share in the same order, so that values need no names to be exchanged.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "communicator.hpp"
#include "part.hpp"

namespace ductile::petsc {

struct SharedVertex {
  VertexId vertex;         ///< in this part
  std::vector<int> ranks;  ///< that have it, this one too, ascending
};

struct SharedFacet {
  std::uint32_t facet;  ///< index into the facets of the mesh
  int rank;             ///< on the other side
};

struct Interfaces {
  std::vector<SharedVertex> vertices;  ///< in the order of their numbers
  std::vector<SharedFacet> facets;     ///< in the order of the numbers of their vertices
};

/// The part must list all of its boundary. Collective.
template <int Dim>
Interfaces find_interfaces(const Communicator& comm, const Part& part);

/// Exchanges a value for each shared vertex: calls take(index, rank, value) for each other rank
/// that has it, in the order of the ranks; the index is that into Interfaces::vertices. Collective.
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

/// The ranks with the key at each index of a list, of keys that other ranks have, too: all of them,
/// ascending; empty for others. No rank has a key twice. Collective.
using Key = std::array<std::int64_t, 3>;
std::vector<std::vector<int>> holders_of(const Communicator& comm, const std::vector<Key>& keys);

extern template Interfaces find_interfaces<2>(const Communicator&, const Part&);
extern template Interfaces find_interfaces<3>(const Communicator&, const Part&);

}  // namespace ductile::petsc
