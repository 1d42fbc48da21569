/* Ductile as an adaptor of PETSc's meshes (DMPlex), for C and all that calls C.
 *
 * A program that links this library calls DuctilePetscRegister() after PetscInitialize() and is run
 * with -dm_adaptor ductile; one that does not is run with
 *   -dll_append .../libductile_petsc.so -dm_adaptor ductile
 * in its arguments or in PETSC_OPTIONS. DMAdaptMetric() and DMAdaptLabel() then adapt by Ductile. */
#ifndef DUCTILE_PETSC_H
#define DUCTILE_PETSC_H

#include <petscdm.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Makes "ductile" known as an adaptor; once is enough, more do nothing. Call it on all ranks. */
PetscErrorCode DuctilePetscRegister(void);

/* Carries a field from one mesh to another of the same domain, however both are distributed, as
 * DMAdaptMetric() does with vectors that options name (docs/petsc.md). `values` is a local vector:
 * as many values for each vertex, or for each cell, of the DMPlex `before`, overlaps included.
 * Conservatively, the integral of each component over all ranks is kept to rounding; otherwise
 * values are interpolated, those of cells taken as they are. `after` has no overlap. `carried` is a
 * sequential vector, the caller's to destroy. Collective. */
PetscErrorCode DuctilePetscTransfer(DM before, Vec values, PetscBool on_cells,
                                    PetscBool conservatively, DM after, Vec* carried);

#ifdef __cplusplus
}
#endif
#endif
