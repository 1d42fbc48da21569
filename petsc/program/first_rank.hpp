/// @file
/// Work of the first rank alone, and how the others learn its result: only it uses files and the
/// command line.
#pragma once

#include <cstdio>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "command.hpp"
#include "communicator.hpp"

namespace ductile::petsc {

/// An error that the first rank has printed; all ranks end with this status.
struct Ended {
  int status;
};

/// Calls work() on the first rank; work() may not communicate. Its exceptions are printed there;
/// then Ended is thrown on all ranks. Collective.
template <class Work>
void on_first_rank(const Communicator& comm, Work&& work) {
  int status = cli::done;
  const auto failed = [&](const char* message, int as) {
    std::fprintf(stderr, "ductile-mpi: %s\n", message);
    status = as;
  };
  if (comm.rank() == 0) try {
      work();
    } catch (const cli::UsageError& error) {
      failed(error.what(), cli::misused);
    } catch (const meshadapt::InputError& error) {
      failed(error.in_file(), cli::misused);
    } catch (const std::bad_alloc&) {
      failed("out of memory on the first rank, which reads and gathers", cli::failed);
    } catch (const std::exception& error) {
      failed(error.what(), cli::failed);
    }
  MPI_Bcast(&status, 1, MPI_INT, 0, comm.handle());
  if (status != cli::done) throw Ended{status};
}

/// Sends the first rank's values to all ranks. Collective.
template <class T>
void from_first_rank(const Communicator& comm, std::vector<T>& values) {
  PerRank<T> to(static_cast<std::size_t>(comm.size()));
  if (comm.rank() == 0)
    comm.on_all([&] { to.assign(to.size(), values); });
  else
    comm.on_all([] {});
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
