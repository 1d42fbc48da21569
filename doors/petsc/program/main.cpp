/// @file
/// ductile-mpi: adapts meshes on several ranks of MPI. The first rank reads files and prints
/// messages.
#include <petscsys.h>

#include <array>

#include "first_rank.hpp"
#include "program.hpp"

int main(int argument_count, char** argument) {
  namespace petsc = ductile::petsc;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  if (PetscInitialize(nullptr, nullptr, nullptr, nullptr) != 0) return ductile::cli::failed;
  const ductile::distributed::Communicator comm(MPI_COMM_WORLD);
  const std::array commands{&petsc::adapt_command()};
  int status = ductile::cli::run_program(
      {"ductile-mpi", "adapts triangle and tetrahedral meshes on several ranks of MPI", commands,
       "mpirun -n N ", comm.rank() == 0},
      argument_count, argument);
  petsc::from_first_rank(comm, status);
  PetscFinalize();
  MPI_Finalize();
  return status;
}
