/* The public header in C, and a program that links the library: it asks for the adaptor by name. */
#include <petscdmplex.h>

#include "ductile_petsc.h"

int main(int argc, char** argv) {
  const PetscInt cells[] = {0, 1, 2, 1, 3, 2};
  const PetscReal places[] = {0, 0, 1, 0, 0, 1, 1, 1};
  DM dm, adapted;
  Vec metric;
  PetscInt begin, end;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(DuctilePetscRegister());
  PetscCall(DuctilePetscRegister());
  PetscCall(PetscOptionsSetValue(NULL, "-dm_adaptor", "ductile"));
  PetscCall(DMPlexCreateFromCellListPetsc(PETSC_COMM_SELF, 2, 2, 4, 3, PETSC_TRUE, cells, 2, places, &dm));
  PetscCall(DMPlexMetricSetUniform(dm, PETSC_TRUE));
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 1, &metric));
  PetscCall(VecSet(metric, 100));  /* edges of 0.1 */
  PetscCall(DMAdaptMetric(dm, metric, NULL, NULL, &adapted));
  PetscCall(DMPlexCheck(adapted));
  PetscCall(DMPlexGetHeightStratum(adapted, 0, &begin, &end));
  PetscCheck(end - begin > 150 && end - begin < 350, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "expected some 230 triangles, found %d", (int)(end - begin));
  PetscCall(VecDestroy(&metric));
  PetscCall(DMDestroy(&adapted));
  PetscCall(DMDestroy(&dm));
  PetscCall(PetscFinalize());
  return 0;
}
