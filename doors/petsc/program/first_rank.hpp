/// @file
/// Work of the first rank alone, and how the others learn its result: only it uses files.
#pragma once

#include <exception>
#include <string>
#include <type_traits>
#include <vector>

#include "distributed/communicator.hpp"

namespace ductile::petsc {

using namespace distributed;

/// Calls work() on the first rank; work() may not communicate. If it throws, its exception is
/// nested in an AgreedError there, and the other ranks throw one too. Collective.
template <class Work>
void on_first_rank(const Communicator& comm, Work&& work) {
  const auto tell = [&](int has_failed) {
    MPI_Bcast(&has_failed, 1, MPI_INT, 0, comm.handle());
    return has_failed != 0;
  };
  if (comm.rank() == 0) try {
      work();
    } catch (...) {
      tell(1);
      std::throw_with_nested(AgreedError("the first rank has failed"));
    }
  if (tell(0)) throw AgreedError("the first rank has failed");
}

/// Sends the first rank's values to all ranks. Collective.
template <class T>
void from_first_rank(const Communicator& comm, std::vector<T>& values) {
  PerRank<T> to = comm.on_all(
      [&] { return PerRank<T>(comm.size(), comm.rank() == 0 ? values : std::vector<T>()); });
  values = comm.exchange(to).items;
}

/// The same for a text.
inline void from_first_rank(const Communicator& comm, std::string& text) {
  std::vector<char> characters(text.begin(), text.end());
  from_first_rank(comm, characters);
  text.assign(characters.begin(), characters.end());
}

/// The same for one value.
template <class T>
requires std::is_trivially_copyable_v<T>
void from_first_rank(const Communicator& comm, T& value) {
  MPI_Bcast(&value, sizeof(T), MPI_BYTE, 0, comm.handle());
}

}  // namespace ductile::petsc
