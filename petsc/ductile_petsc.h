/* Ductile as an adaptor of PETSc's meshes (DMPlex), for C and all that calls C.
 *
 * A program that links this library calls DuctilePetscRegister() after PetscInitialize() and is run
 * with -dm_adaptor ductile; one that does not is run with
 *   -dll_append .../libductile_petsc.so -dm_adaptor ductile
 * in its arguments or in PETSC_OPTIONS. DMAdaptMetric() and DMAdaptLabel() then adapt by Ductile. */
#ifndef DUCTILE_PETSC_H
#define DUCTILE_PETSC_H

#include <petscsys.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Makes "ductile" known as an adaptor; once is enough, more do nothing. Call it on all ranks. */
PetscErrorCode DuctilePetscRegister(void);

#ifdef __cplusplus
}
#endif
#endif
