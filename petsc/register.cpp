/// @file
/// How PETSc gets to know the adaptor: by a call, or when it loads the library.
#include <petscdm.h>

#include "adapt_plex.hpp"
#include "ductile_petsc.h"

extern "C" {

PetscErrorCode DuctilePetscRegister() {
  static bool is_known = false;
  PetscFunctionBegin;
  if (is_known) PetscFunctionReturn(0);
  PetscCall(DMGenerateRegister("ductile", nullptr, nullptr, ductile::petsc::adapt_plex, -1));
  is_known = true;
  PetscFunctionReturn(0);
}

/// PETSc calls the function of this name in a library that -dll_append names.
PETSC_EXTERN PetscErrorCode PetscDLLibraryRegister_ductile_petsc() {  // NOLINT: PETSc looks for it
  PetscFunctionBegin;
  PetscCall(DuctilePetscRegister());
  PetscFunctionReturn(0);
}

}  // extern "C"
