/// @file
/// The C interface: registration of the adaptor with PETSc, by a call or when PETSc loads the
/// library, and transfer of fields.
#include <petscdm.h>

#include "adapt_plex.hpp"
#include "ductile_petsc.h"
#include "parameters.hpp"
#include "vectors.hpp"

extern "C" {

PetscErrorCode DuctilePetscRegister() {
  static bool is_known = false;
  PetscFunctionBegin;
  if (is_known) PetscFunctionReturn(0);
  PetscCall(DMGenerateRegister("ductile", nullptr, nullptr, ductile::petsc::adapt_plex, -1));
  is_known = true;
  PetscFunctionReturn(0);
}

// NOLINTNEXTLINE(readability-function-size): a function for C says all by its arguments
PetscErrorCode DuctilePetscTransfer(DM before, Vec values, PetscBool on_cells,
                                    PetscBool conservatively, DM after, Vec* carried) {
  using namespace ductile;
  PetscFunctionBegin;
  MPI_Comm handle = MPI_COMM_NULL;
  PetscCall(PetscObjectGetComm(reinterpret_cast<PetscObject>(before), &handle));
  const auto failure = distributed::failure_of([&] {
    const distributed::Communicator comm(handle);
    const int threads = petsc::threads_of(comm, before);
    const auto executor = comm.on_all([&] { return runtime::Executor({.threads = threads}); });
    using Place = meshadapt::NamedField::Place;
    using meshadapt::Carrying;
    *carried = petsc::carry_vectors(
        comm, executor, before,
        {{"values", values, on_cells == PETSC_TRUE ? Place::elements : Place::vertices,
          conservatively == PETSC_TRUE ? Carrying::conservatively : Carrying::by_value}},
        after)[0];
  });
  PetscCheck(!failure, handle, PETSC_ERR_LIB, "Ductile: %s", failure->c_str());
  PetscFunctionReturn(0);
}

/// PETSc calls the function of this name in a library given by -dll_append.
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_ductile_petsc() {  // NOLINT: PETSc looks for it
  PetscFunctionBegin;
  PetscCall(DuctilePetscRegister());
  PetscFunctionReturn(0);
}

}  // extern "C"
