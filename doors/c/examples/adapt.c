/* A mesh from arrays, adapted to sizes, with the solution carried over: C99 and libductile alone.
 */
#include <stdio.h>
#include <stdlib.h>

#include "ductile.h"

/* Ends the program with the reason if a call has failed. */
static void check(int code) {
  if (code == DUCTILE_OK) return;
  fprintf(stderr, "%s\n", ductile_last_error());
  exit(code);
}

static int go_on(const char* step, int iteration, int64_t changes, void* context) {
  (void)step, (void)iteration, (void)changes;
  ++*(int*)context;
  return 1; /* 0 would cancel */
}

int main(void) {
  /* ---- In: two triangles, one edge of the boundary by its reference ---- */
  const double points[] = {0, 0, 1, 0, 1, 1, 0, 1};
  const int32_t triangles[] = {0, 1, 2, 0, 2, 3}, inflow[] = {3, 0}, reference[] = {7};
  ductile_mesh *mesh = NULL, *adapted = NULL;
  check(ductile_mesh_create(2, &mesh));
  check(ductile_mesh_set_vertices(mesh, 4, points, NULL));
  check(ductile_mesh_set_elements(mesh, 2, triangles, NULL));
  check(ductile_mesh_set_facets(mesh, 1, inflow, reference));

  /* ---- Sizes wanted at the vertices ---- */
  const double sizes[] = {.02, .1, .1, .02};
  int steps = 0;
  ductile_options* options = NULL;
  check(ductile_options_create(&options));
  check(ductile_options_set(options, "hgrad", 1.3));
  check(ductile_options_set_progress(options, go_on, &steps));
  check(ductile_adapt(mesh, 1, sizes, options, &adapted));

  /* ---- Out: arrays, and a value for each old triangle carried to the new ones ---- */
  const int64_t elements = ductile_mesh_count(adapted, DUCTILE_ELEMENTS);
  const double density[] = {1, 3};
  double* carried = malloc((size_t)elements * sizeof *carried);
  if (carried == NULL) return DUCTILE_FAILED;
  ductile_transfer* transfer = NULL;
  check(ductile_transfer_create(mesh, adapted, &transfer));
  check(ductile_transfer_carry(transfer, DUCTILE_ELEMENTS + DUCTILE_CONSERVATIVE, 1, density,
                               carried));
  const double* x = ductile_mesh_coordinates(adapted);
  const int32_t* corners = ductile_mesh_corners(adapted, DUCTILE_ELEMENTS);
  double amount = 0;
  for (int64_t e = 0; e < elements; ++e) {
    const double *a = x + 2 * corners[3 * e], *b = x + 2 * corners[3 * e + 1],
                 *c = x + 2 * corners[3 * e + 2];
    amount += carried[e] * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  printf("%lld triangles after %d steps; the amount was 2 and is %.12f\n", (long long)elements,
         steps, amount);

  free(carried);
  ductile_transfer_destroy(transfer);
  ductile_options_destroy(options);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(mesh);
  return steps > 0 && amount > 2 - 1e-12 && amount < 2 + 1e-12 ? 0 : 1;
}
