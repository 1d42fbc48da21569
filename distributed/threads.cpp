#include "distributed/threads.hpp"

#include <sched.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "ductile/runtime/executor.hpp"

namespace ductile::distributed {

namespace {

/// Number of ranks on this machine that share this rank's cores, including it: all or none do.
int ranks_on_same_cores(const Communicator& comm) {
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(comm.handle(), MPI_COMM_TYPE_SHARED, comm.rank(), MPI_INFO_NULL, &machine);
  int ranks = 1;
  MPI_Comm_size(machine, &ranks);
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof(cores), &cores);
  std::array<std::uint64_t, sizeof(cores) / sizeof(std::uint64_t)> own{}, all{}, any{};
  std::memcpy(own.data(), &cores, sizeof(cores));
  const auto words = static_cast<int>(own.size());
  MPI_Allreduce(own.data(), all.data(), words, MPI_UINT64_T, MPI_BAND, machine);
  MPI_Allreduce(own.data(), any.data(), words, MPI_UINT64_T, MPI_BOR, machine);
  MPI_Comm_free(&machine);
  return all == any ? ranks : 1;
}

}  // namespace

int threads_of(const Communicator& comm, std::optional<int> given) {
  const int sharing = ranks_on_same_cores(comm);
  if (given) return *given;
  if (const char* const said = std::getenv("OMP_NUM_THREADS"); said != nullptr)
    if (const int number = std::atoi(said); number > 0) return number;
  return std::max(1, runtime::available_cores() / sharing);
}

}  // namespace ductile::distributed
