/// @file
/// ductile-mpi: adapts meshes on several ranks of MPI. The first rank reads the command line and
/// files and prints messages.
#include <petscsys.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "command.hpp"
#include "first_rank.hpp"
#include "program.hpp"

namespace {

using ductile::petsc::Communicator;
namespace cli = ductile::cli;

constexpr const char* overview =
    "ductile-mpi: adapts triangle and tetrahedral meshes on several ranks of MPI.\n\n"
    "  mpirun -n N ductile-mpi adapt MESH [-sol METRIC] [-o OUT]\n"
    "  ductile-mpi help adapt     shows its options\n\n"
    "ductile does the same on one machine, and more: ductile help.\n"
    "Exit status: 0 the output is written; 1 it could not be done;\n"
    "2 the command line or the input is wrong.\n";

bool asks_for_help(const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (word == "help" || word == "-h" || word == "-help" || word == "--help") return true;
  return false;
}

int run(const Communicator& comm, const std::vector<std::string>& words) {
  const bool speaks = comm.rank() == 0;
  if (words.empty() || asks_for_help(words)) {
    if (speaks && words.size() > 1)
      ductile::petsc::print_help_of_adapt();
    else if (speaks)
      std::fputs(overview, words.empty() ? stderr : stdout);
    return words.empty() ? cli::misused : cli::done;
  }
  if (words[0] != "adapt") {
    if (speaks)
      std::fprintf(stderr, "ductile-mpi: unknown command '%s'; there is adapt\n", words[0].c_str());
    return cli::misused;
  }
  try {
    ductile::petsc::adapt_files(comm, std::span(words).subspan(1));
  } catch (const ductile::petsc::Ended& end) {
    return end.status;
  } catch (const ductile::petsc::AgreedError& error) {
    if (speaks) std::fprintf(stderr, "ductile-mpi: %s\n", error.what());
    return cli::failed;
  }
  return cli::done;
}

/// A failure known to one rank only aborts all, because the others may wait for it.
int run_or_abort(int argument_count, char** argument) {
  try {
    const Communicator comm(MPI_COMM_WORLD);
    return run(comm, {argument + 1, argument + argument_count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ductile-mpi: %s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, cli::failed);
  }
  return cli::failed;
}

}  // namespace

int main(int argument_count, char** argument) {
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  if (PetscInitialize(nullptr, nullptr, nullptr, nullptr) != 0) return cli::failed;
  const int status = run_or_abort(argument_count, argument);
  PetscFinalize();
  MPI_Finalize();
  return status;
}
