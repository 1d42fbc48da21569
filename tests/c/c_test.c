/* What the C library promises, in C: codes and texts of errors, that results stay as they were
 * where a call fails, cancelling, both widths of indices, origins and transfer, names and sizes. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ductile.h"

static int failures = 0;

#define EXPECT(condition)                                                      \
  do {                                                                         \
    if (!(condition)) {                                                        \
      ++failures;                                                              \
      printf("line %d: %s; %s\n", __LINE__, #condition, ductile_last_error()); \
    }                                                                          \
  } while (0)

#define EXPECT_TEXT(text)                                                             \
  do {                                                                                \
    if (strcmp(ductile_last_error(), text) != 0) {                                    \
      ++failures;                                                                     \
      printf("line %d: '%s'\n  is not '%s'\n", __LINE__, ductile_last_error(), text); \
    }                                                                                 \
  } while (0)

static const double square[] = {0, 0, 1, 0, 1, 1, 0, 1};
static const int32_t halves[] = {0, 1, 2, 0, 2, 3};
static const int64_t halves_64[] = {0, 1, 2, 0, 2, 3};

static ductile_mesh* make_square(void) {
  ductile_mesh* mesh = NULL;
  const int32_t inflow[] = {3, 0}, reference[] = {7};
  EXPECT(ductile_mesh_create(2, &mesh) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_vertices(mesh, 4, square, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_elements(mesh, 2, halves, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_facets(mesh, 1, inflow, reference) == DUCTILE_OK);
  return mesh;
}

static void test_meshes(void) {
  ductile_mesh* mesh = make_square();
  EXPECT(ductile_mesh_dimension(mesh) == 2);
  EXPECT(ductile_mesh_count(mesh, DUCTILE_VERTICES) == 4);
  EXPECT(ductile_mesh_count(mesh, DUCTILE_ELEMENTS) == 2);
  EXPECT(ductile_mesh_count(mesh, DUCTILE_FACETS) == 4);
  EXPECT(ductile_mesh_count(mesh, DUCTILE_RIDGES) == 0);
  EXPECT(ductile_mesh_count(mesh, 9) == -1);
  EXPECT(memcmp(ductile_mesh_coordinates(mesh), square, sizeof square) == 0);
  EXPECT(memcmp(ductile_mesh_corners(mesh, DUCTILE_ELEMENTS), halves, sizeof halves) == 0);
  EXPECT(ductile_mesh_references(mesh, DUCTILE_FACETS)[0] == 7);
  EXPECT(ductile_mesh_references(mesh, DUCTILE_FACETS)[1] == 0);
  EXPECT(ductile_mesh_corners(mesh, DUCTILE_VERTICES) == NULL);
  EXPECT(ductile_mesh_metric(mesh) == NULL);
  const int32_t regions[] = {5, 6};
  const int64_t inflow[] = {3, 0};
  EXPECT(ductile_mesh_set_elements_64(mesh, 2, halves_64, regions) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_facets_64(mesh, 1, inflow, NULL) == DUCTILE_OK);
  EXPECT(memcmp(ductile_mesh_corners(mesh, DUCTILE_ELEMENTS), halves, sizeof halves) == 0);
  EXPECT(ductile_mesh_references(mesh, DUCTILE_ELEMENTS)[1] == 6);
  EXPECT(ductile_mesh_count(mesh, DUCTILE_FACETS) == 5); /* with the interface */
  ductile_mesh_destroy(mesh);
  ductile_mesh_destroy(NULL);
}

/* As after a call that failed and was not looked at. */
static void test_no_handles(void) {
  EXPECT(ductile_mesh_dimension(NULL) == 0);
  EXPECT(ductile_mesh_name_at(NULL, 0, NULL, NULL) == NULL);
  EXPECT(ductile_mesh_coordinates(NULL) == NULL);
  EXPECT(ductile_mesh_metric(NULL) == NULL);
  EXPECT(ductile_mesh_warning(NULL, 0) == NULL);
  EXPECT(ductile_transfer_hosts(NULL) == NULL);
  EXPECT(ductile_transfer_weights(NULL) == NULL);
  for (int kind = DUCTILE_VERTICES; kind <= DUCTILE_ELEMENTS; ++kind) {
    EXPECT(ductile_mesh_count(NULL, kind) == -1);
    EXPECT(ductile_mesh_name(NULL, kind, 0) == NULL);
    EXPECT(ductile_mesh_corners(NULL, kind) == NULL);
    EXPECT(ductile_mesh_references(NULL, kind) == NULL);
    EXPECT(ductile_transfer_origins(NULL, kind) == NULL);
  }
  double value = 0;
  EXPECT(ductile_mesh_report(NULL, "seconds", &value) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_mesh_write(NULL, "none.mesh") == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("mesh: expected a pointer, found NULL");
}

static void test_errors(void) {
  ductile_mesh* mesh = NULL;
  const int32_t wrong[] = {0, 1, 2, 0, 2, 4}, beyond[] = {0, 4};
  const int64_t huge[] = {0, 1, 2, 0, 2, (int64_t)1 << 40};
  EXPECT(ductile_mesh_create(5, &mesh) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("dimension: expected 2 or 3, found 5");
  EXPECT(ductile_mesh_create(2, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT(mesh == NULL);
  EXPECT(ductile_mesh_set_vertices(mesh, 4, square, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("mesh: expected a pointer, found NULL");
  mesh = make_square();
  EXPECT(ductile_mesh_set_elements(mesh, 2, wrong, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("mesh: triangles.vertices[1] names vertex 4, but there are only 4, counted from 0");
  EXPECT(ductile_mesh_set_elements_64(mesh, 2, huge, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_mesh_set_vertices(mesh, -4, square, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("coordinates: expected 0 entries or more, found -4");
  EXPECT(ductile_mesh_set_vertices(mesh, 4, NULL, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("coordinates: expected a pointer, found NULL");
  EXPECT(ductile_mesh_require(mesh, DUCTILE_FACETS, 2, beyond) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("indices[1]: expected an index from 0 and below 4, found 4");
  EXPECT(ductile_mesh_require(mesh, DUCTILE_RIDGES, 0, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_mesh_set_facets(mesh, 1, beyond, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_mesh_references(mesh, DUCTILE_FACETS)[0] == 7); /* as it was */
  EXPECT(ductile_mesh_read("no such.mesh", &mesh) == DUCTILE_WRONG_INPUT);
  ductile_mesh* adapted = NULL;
  const double sizes[] = {.1, .1, -1, .1};
  EXPECT(ductile_adapt(mesh, 1, sizes, NULL, &adapted) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT(
      "metric: expected a size from 1e-75 to 1e75 at values[2], vertex 2, found -1; correct the "
      "field there");
  EXPECT(ductile_adapt(mesh, 2, sizes, NULL, &adapted) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("components: expected 1, 3 or 4, found 2");
  EXPECT(adapted == NULL);
  ductile_mesh_destroy(mesh);
}

static int stop_at_third(const char* step, int iteration, int64_t changes, void* context) {
  EXPECT(step != NULL && iteration >= 0 && changes >= 0);
  return ++*(int*)context < 3;
}

static void test_options(void) {
  ductile_options* options = NULL;
  EXPECT(ductile_options_create(&options) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "hmax", .2) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "threads", 2) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "threads", 1.5) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("option threads: expected a whole number from 0 to 4096, found 1.5");
  EXPECT(ductile_options_set(options, "nosurf", 2) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "hgard", 1) == DUCTILE_WRONG_INPUT);
  EXPECT(strncmp(ductile_last_error(), "option hgard: expected one of hmin, hmax,", 41) == 0);
  int steps = 0;
  ductile_mesh *mesh = make_square(), *adapted = NULL;
  EXPECT(ductile_options_set_progress(options, stop_at_third, &steps) == DUCTILE_OK);
  const double sizes[] = {.1, .1, .1, .1};
  EXPECT(ductile_adapt(mesh, 1, sizes, options, &adapted) == DUCTILE_FAILED);
  EXPECT_TEXT("cancelled, as asked for");
  EXPECT(steps == 3 && adapted == NULL);
  const char* const names[] = {"hgrad", "hgradreq", "hausd", "ar", "hmin"};
  const double wrong[] = {.5, .5, -1, 90, -1};
  const char* const texts[] = {"option hgrad: expected", "option hgradreq: expected",
                               "option hausd: expected", "option ar: expected",
                               "hmin and hmax: expected"};
  for (int i = 0; i < 5; ++i) {
    ductile_options* one = NULL;
    EXPECT(ductile_options_create(&one) == DUCTILE_OK);
    EXPECT(ductile_options_set(one, names[i], wrong[i]) == DUCTILE_OK);
    EXPECT(ductile_adapt(mesh, 1, sizes, one, &adapted) == DUCTILE_WRONG_INPUT);
    EXPECT(strncmp(ductile_last_error(), texts[i], strlen(texts[i])) == 0);
    ductile_options_destroy(one);
  }
  ductile_options_destroy(options);
  ductile_mesh_destroy(mesh);
}

static void test_adaptation(void) {
  ductile_mesh *mesh = make_square(), *adapted = NULL, *tensors = NULL;
  const int32_t required[] = {0};
  EXPECT(ductile_mesh_require(mesh, DUCTILE_FACETS, 1, required) == DUCTILE_OK);
  const double sizes[] = {.1, .1, .1, .1};
  double matrices[16];
  for (int v = 0; v < 4; ++v) {
    matrices[4 * v] = matrices[4 * v + 3] = 1 / (.1 * .1);
    matrices[4 * v + 1] = matrices[4 * v + 2] = 0;
  }
  EXPECT(ductile_adapt(mesh, 1, sizes, NULL, &adapted) == DUCTILE_OK);
  EXPECT(ductile_adapt(mesh, 4, matrices, NULL, &tensors) == DUCTILE_OK);
  const int64_t n = ductile_mesh_count(adapted, DUCTILE_VERTICES),
                elements = ductile_mesh_count(adapted, DUCTILE_ELEMENTS);
  EXPECT(elements > 100 && elements == ductile_mesh_count(tensors, DUCTILE_ELEMENTS));
  EXPECT(ductile_mesh_metric(adapted) != NULL);
  double held = 0, warnings = 1;
  EXPECT(ductile_mesh_report(adapted, "held_long_edges", &held) == DUCTILE_OK);
  EXPECT(held == 1);
  EXPECT(ductile_mesh_report(adapted, "warnings", &warnings) == DUCTILE_OK && warnings == 0);
  EXPECT(ductile_mesh_warning(adapted, 0) == NULL);
  EXPECT(ductile_mesh_report(adapted, "colour", &held) == DUCTILE_WRONG_INPUT);

  double* values = (double*)malloc((size_t)(2 * n) * sizeof *values);
  double* carried = (double*)malloc((size_t)elements * sizeof *carried);
  ductile_transfer* transfer = NULL;
  EXPECT(ductile_transfer_create(mesh, adapted, &transfer) == DUCTILE_OK);
  const int32_t *vertex = ductile_transfer_origins(transfer, DUCTILE_VERTICES),
                *host = ductile_transfer_hosts(transfer);
  EXPECT(ductile_transfer_origins(transfer, DUCTILE_RIDGES) == NULL);
  EXPECT(ductile_transfer_weights(transfer)[0] >= 0);
  int64_t kept = 0;
  for (int64_t v = 0; v < n; ++v) {
    kept += vertex[v] != -1;
    EXPECT(host[v] == 0 || host[v] == 1);
    if (vertex[v] >= 0) {
      EXPECT(memcmp(&ductile_mesh_coordinates(adapted)[2 * v], &square[2 * vertex[v]],
                    2 * sizeof *square) == 0);
    }
  }
  EXPECT(kept == 4);
  EXPECT(ductile_transfer_carry(transfer, DUCTILE_VERTICES, 2, square, values) == DUCTILE_OK);
  for (int64_t i = 0; i < 2 * n; ++i) /* the coordinates are linear, so they arrive */
    EXPECT(fabs(values[i] - ductile_mesh_coordinates(adapted)[i]) < 1e-12);
  const double density[] = {1, 3};
  EXPECT(ductile_transfer_carry(transfer, DUCTILE_ELEMENTS + DUCTILE_CONSERVATIVE, 1, density,
                                carried) == DUCTILE_OK);
  for (int64_t e = 0; e < elements; ++e) EXPECT(carried[e] >= 1 && carried[e] <= 3);
  EXPECT(ductile_transfer_carry(transfer, 9, 1, density, carried) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_mesh_write(adapted, "c_test.mesh") == DUCTILE_OK);
  ductile_mesh* read = NULL;
  EXPECT(ductile_mesh_read("c_test.mesh", &read) == DUCTILE_OK);
  EXPECT(ductile_mesh_count(read, DUCTILE_ELEMENTS) == elements);
  remove("c_test.mesh");
  EXPECT(ductile_mesh_write(adapted, "c_test.tif") == DUCTILE_WRONG_INPUT);
  free(values), free(carried);
  ductile_transfer_destroy(transfer);
  ductile_mesh_destroy(read);
  ductile_mesh_destroy(tensors);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(mesh);
}

static void test_solution_metric(void) {
  ductile_mesh *mesh = make_square(), *fine = NULL, *adapted = NULL;
  ductile_options* options = NULL;
  const double sizes[] = {.05, .05, .05, .05};
  EXPECT(ductile_adapt(mesh, 1, sizes, NULL, &fine) == DUCTILE_OK);
  const int64_t n = ductile_mesh_count(fine, DUCTILE_VERTICES);
  double* values = (double*)malloc((size_t)n * sizeof *values);
  double* metric = (double*)malloc((size_t)(3 * n) * sizeof *metric);
  for (int64_t v = 0; v < n; ++v)
    values[v] = tanh(20 * (ductile_mesh_coordinates(fine)[2 * v] - .5));
  EXPECT(ductile_options_create(&options) == DUCTILE_OK);
  EXPECT(ductile_solution_metric(fine, 1, values, options, metric) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "elements", 500) == DUCTILE_OK);
  EXPECT(ductile_solution_metric(fine, 0, values, options, metric) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_solution_metric(fine, 1, values, options, metric) == DUCTILE_OK);
  EXPECT(ductile_adapt(fine, 3, metric, options, &adapted) == DUCTILE_OK);
  const int64_t elements = ductile_mesh_count(adapted, DUCTILE_ELEMENTS);
  EXPECT(elements > 350 && elements < 700);
  double* projected = (double*)malloc((size_t)(3 * n) * sizeof *projected);
  EXPECT(ductile_options_set(options, "projection", 2) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "projection", 1) == DUCTILE_OK);
  EXPECT(ductile_solution_metric(fine, 1, values, options, projected) == DUCTILE_OK);
  EXPECT(memcmp(projected, metric, (size_t)(3 * n) * sizeof *metric) != 0);
  free(projected);
  free(values), free(metric);
  ductile_options_destroy(options);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(fine);
  ductile_mesh_destroy(mesh);
}

/** Two squares side by side, whose common side is there twice, `gap` apart. */
static ductile_mesh* make_two_squares(double gap) {
  const double x[] = {0, 0, 1, 0, 1, 1, 0, 1, 1 + gap, 0, 2, 0, 2, 1, 1 + gap, 1};
  const int32_t corners[] = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7},
                references[] = {1, 2, 3, 4, 5, 6, 7, 8};
  ductile_mesh* mesh = NULL;
  EXPECT(ductile_mesh_create(2, &mesh) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_vertices(mesh, 8, x, references) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_elements(mesh, 4, corners, NULL) == DUCTILE_OK);
  return mesh;
}

static void test_joining(void) {
  for (int i = 0; i < 4; ++i) {
    const double gap = i == 0 ? 0 : pow(10, -3 * i);
    ductile_mesh* mesh = make_two_squares(gap);
    const int64_t facets = ductile_mesh_count(mesh, DUCTILE_FACETS);
    int32_t kept[8];
    EXPECT(ductile_mesh_join_vertices(mesh, -1, kept) == DUCTILE_WRONG_INPUT);
    EXPECT(ductile_mesh_join_vertices(mesh, NAN, NULL) == DUCTILE_WRONG_INPUT);
    EXPECT(ductile_mesh_join_vertices(mesh, 1.5, NULL) == DUCTILE_WRONG_INPUT);
    EXPECT(strstr(ductile_last_error(), "no farther apart than the tolerance") != NULL);
    EXPECT(ductile_mesh_join_vertices(NULL, 0, NULL) == DUCTILE_WRONG_INPUT);
    EXPECT(ductile_mesh_join_vertices(mesh, gap / 2, NULL) == DUCTILE_OK);
    EXPECT(ductile_mesh_count(mesh, DUCTILE_VERTICES) == (i == 0 ? 6 : 8));
    if (i == 0) ductile_mesh_destroy(mesh), mesh = make_two_squares(gap);
    EXPECT(ductile_mesh_join_vertices(mesh, 1.5 * gap, kept) == DUCTILE_OK);
    EXPECT(ductile_mesh_count(mesh, DUCTILE_VERTICES) == 6);
    EXPECT(ductile_mesh_count(mesh, DUCTILE_ELEMENTS) == 4);
    EXPECT(ductile_mesh_count(mesh, DUCTILE_FACETS) == facets - 1);
    const int32_t expected[] = {0, 1, 2, 3, 5, 6};
    EXPECT(memcmp(kept, expected, sizeof expected) == 0);
    for (int v = 0; v < 6; ++v)
      EXPECT(ductile_mesh_references(mesh, DUCTILE_VERTICES)[v] == expected[v] + 1);
    ductile_mesh* adapted = NULL;
    EXPECT(ductile_adapt(mesh, 1, NULL, NULL, &adapted) == DUCTILE_OK);
    ductile_mesh_destroy(adapted);
    ductile_mesh_destroy(mesh);
  }
}

static void test_names(void) {
  ductile_mesh *mesh = make_square(), *adapted = NULL, *read = NULL;
  int kind = 0;
  int32_t reference = 0;
  EXPECT(ductile_mesh_name_at(mesh, 0, &kind, &reference) == NULL);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_FACETS, 7, "inlet") == DUCTILE_OK);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_ELEMENTS, 5, "steel") == DUCTILE_OK);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_VERTICES, 1, "gone") == DUCTILE_OK);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_FACETS, 7, "inflow") == DUCTILE_OK);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_VERTICES, 1, "") == DUCTILE_OK);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_VERTICES, 2, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_name(mesh, DUCTILE_RIDGES, 1, "edge") == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("kind: expected DUCTILE_VERTICES, DUCTILE_FACETS or DUCTILE_ELEMENTS, found 1");
  const int32_t steel[] = {5, 5}, inflow[] = {3, 0}, seven[] = {7}; /* names stay */
  EXPECT(ductile_mesh_set_elements(mesh, 2, halves, steel) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_facets(mesh, 1, inflow, seven) == DUCTILE_OK);
  EXPECT(ductile_adapt(mesh, 1, NULL, NULL, &adapted) == DUCTILE_OK);
  EXPECT(ductile_mesh_write(adapted, "c_test.msh") == DUCTILE_OK);
  EXPECT(ductile_mesh_read("c_test.msh", &read) == DUCTILE_OK);
  remove("c_test.msh");
  ductile_mesh* const all[] = {mesh, adapted, read};
  for (int i = 0; i < 3; ++i) {
    int facets = 0, elements = 0;
    for (int n = 0; n < 2; ++n) {
      const char* name = ductile_mesh_name_at(all[i], n, &kind, &reference);
      EXPECT(name != NULL);
      if (name == NULL) continue;
      facets += kind == DUCTILE_FACETS && reference == 7 && strcmp(name, "inflow") == 0;
      elements += kind == DUCTILE_ELEMENTS && reference == 5 && strcmp(name, "steel") == 0;
    }
    EXPECT(facets == 1 && elements == 1);
    EXPECT(ductile_mesh_name_at(all[i], 2, NULL, NULL) == NULL);
    EXPECT(strcmp(ductile_mesh_name(all[i], DUCTILE_FACETS, 7), "inflow") == 0);
    EXPECT(ductile_mesh_name(all[i], DUCTILE_VERTICES, 7) == NULL);
    ductile_mesh_destroy(all[i]);
  }
}

/* The size at the point (x, 0) where 0.01 grows from `place` on, at most 0.5. */
static double grown(double x, double place, double slope) {
  const double size = .01 + slope * (x > place ? x - place : 0);
  return size < .5 ? size : .5;
}

static void test_sizes(void) {
  ductile_mesh *mesh = make_square(), *adapted = NULL, *line = NULL;
  ductile_sizes* sizes = NULL;
  double values[4];
  EXPECT(ductile_sizes_create(4, &sizes) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_sizes_create(2, &sizes) == DUCTILE_OK);
  EXPECT(ductile_sizes_at(sizes, mesh, values) == DUCTILE_OK);
  EXPECT(fabs(values[0] - sqrt(2)) < 1e-12); /* the extent */
  EXPECT(ductile_sizes_set(sizes, "hmxa", 1) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("sizes hmxa: expected one of default, hmin, hmax, grow, largest, distance");
  EXPECT(ductile_sizes_set(sizes, "default", -1) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_sizes_set(sizes, "default", .5) == DUCTILE_OK);
  /* Places at the left, each of them with the same size, which grows as was set before. */
  const double corner[] = {0, 0, 0, 1}, low[] = {-1, 2}, high[] = {0, -1};
  const double wedge[] = {0, -1, 0, 3, -2, 0};
  for (int kind = 0; kind < 6; ++kind) {
    ductile_sizes* one = NULL;
    EXPECT(ductile_sizes_create(2, &one) == DUCTILE_OK);
    EXPECT(ductile_sizes_set(one, "default", .5) == DUCTILE_OK);
    EXPECT(ductile_sizes_set(one, "grow", kind % 2 == 0 ? 1.3 : 1.1) == DUCTILE_OK);
    const double slope = log(kind % 2 == 0 ? 1.3 : 1.1);
    if (kind == 0) EXPECT(ductile_sizes_near_ball(one, corner, .25, .01) == DUCTILE_OK);
    if (kind == 1) EXPECT(ductile_sizes_near_box(one, low, high, .01) == DUCTILE_OK);
    if (kind == 2) EXPECT(ductile_sizes_near_curve(one, 2, corner, .01) == DUCTILE_OK);
    if (kind == 3) EXPECT(ductile_sizes_near_surface(one, 1, wedge, .01) == DUCTILE_OK);
    if (kind == 4) EXPECT(ductile_sizes_on(one, DUCTILE_FACETS, 7, .01) == DUCTILE_OK);
    if (kind == 5) {
      EXPECT(ductile_mesh_set_name(mesh, DUCTILE_FACETS, 7, "inflow") == DUCTILE_OK);
      EXPECT(ductile_sizes_on_name(one, "inflow", .01) == DUCTILE_OK);
    }
    EXPECT(ductile_sizes_at(one, mesh, values) == DUCTILE_OK);
    for (int v = 0; v < 2; ++v)
      EXPECT(fabs(values[v] - grown(square[2 * v], kind == 0 ? .25 : 0, slope)) < 1e-9);
    ductile_sizes_destroy(one);
  }
  /* Far from a mesh of two triangles, seen only by what they become. */
  const double point[] = {.3, .6};
  EXPECT(ductile_sizes_set(sizes, "grow", 0) == DUCTILE_OK);
  EXPECT(ductile_sizes_set(sizes, "largest", .4) == DUCTILE_OK);
  EXPECT(ductile_sizes_set(sizes, "distance", .5) == DUCTILE_OK);
  EXPECT(ductile_sizes_near_ball(sizes, point, 0, .01) == DUCTILE_OK);
  EXPECT(ductile_adapt_to_sizes(mesh, sizes, NULL, &adapted) == DUCTILE_OK);
  const double* x = ductile_mesh_coordinates(adapted);
  int64_t near = 0;
  for (int64_t v = 0; v < ductile_mesh_count(adapted, DUCTILE_VERTICES); ++v)
    near += hypot(x[2 * v] - point[0], x[2 * v + 1] - point[1]) < .05;
  EXPECT(near > 5 && near < 40);
  /* What makes no sense is told of by place. */
  EXPECT(ductile_sizes_near_ball(sizes, point, 0, -1) == DUCTILE_OK);
  EXPECT(ductile_sizes_at(sizes, mesh, values) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("places[1]: expected a size from 1e-75 to 1e75, found -1");
  EXPECT(ductile_sizes_near_box(sizes, low, NULL, 1) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_sizes_near_curve(sizes, -1, low, 1) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_sizes_on_name(sizes, NULL, 1) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_sizes_on(sizes, DUCTILE_CONSERVATIVE, 1, 1) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_mesh_create(3, &line) == DUCTILE_OK);
  EXPECT(ductile_sizes_at(sizes, line, values) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("sizes: expected those for meshes of dimension 3, found dimension 2");
  ductile_sizes_destroy(sizes);
  ductile_sizes_destroy(NULL);
  ductile_mesh_destroy(line);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(mesh);
}

/* Fails if the context says 0. */
static int on_circle(const double* point, double* closest, void* context) {
  const double length = hypot(point[0], point[1]);
  closest[0] = point[0] / length;
  closest[1] = point[1] / length;
  closest[2] = point[2];
  return *(const int*)context;
}

enum { RIM = 24 };

/* A polygon in the unit circle, as a fan. */
static ductile_mesh* make_disk(void) {
  ductile_mesh* mesh = NULL;
  double points[2 * RIM + 2] = {0};
  int32_t fan[3 * RIM], rim[2 * RIM], references[RIM];
  const double turn = 6.283185307179586, sides = RIM;
  for (int i = 0; i < RIM; ++i) {
    points[2 * i + 2] = cos(i * turn / sides);
    points[2 * i + 3] = sin(i * turn / sides);
    fan[3 * i] = 0;
    fan[3 * i + 1] = rim[2 * i] = i + 1;
    fan[3 * i + 2] = rim[2 * i + 1] = (i + 1) % RIM + 1;
    references[i] = 4;
  }
  EXPECT(ductile_mesh_create(2, &mesh) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_vertices(mesh, RIM + 1, points, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_elements(mesh, RIM, fan, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_facets(mesh, RIM, rim, references) == DUCTILE_OK);
  return mesh;
}

static double off_circle(const ductile_mesh* mesh) {
  const double* x = ductile_mesh_coordinates(mesh);
  const int32_t* corners = ductile_mesh_corners(mesh, DUCTILE_FACETS);
  double most = 0;
  for (int64_t i = 0; i < 2 * ductile_mesh_count(mesh, DUCTILE_FACETS); ++i)
    most = fmax(most, fabs(hypot(x[2 * corners[i]], x[2 * corners[i] + 1]) - 1));
  return most;
}

static void test_geometry(void) {
  ductile_mesh *mesh = make_disk(), *adapted = NULL, *again = NULL;
  ductile_options* options = NULL;
  ductile_geometry* geometry = NULL;
  int works = 1, fails = 0;
  double sizes[1000];
  for (int i = 0; i < 1000; ++i) sizes[i] = .1;
  EXPECT(ductile_options_create(&options) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "threads", 2) == DUCTILE_OK);
  EXPECT(ductile_geometry_create(mesh, options, &geometry) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "hausd", .01) == DUCTILE_OK);
  EXPECT(ductile_options_set_surface(options, 9, on_circle, &works) == DUCTILE_OK);
  EXPECT(ductile_geometry_create(mesh, options, &geometry) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("functions: no facet has the reference 9");
  EXPECT(ductile_options_set_surface(options, 9, NULL, NULL) == DUCTILE_OK);
  EXPECT(ductile_options_set_surface(options, 4, on_circle, &fails) == DUCTILE_OK);
  EXPECT(ductile_geometry_create(mesh, options, &geometry) == DUCTILE_FAILED);
  EXPECT_TEXT("the function of the surface with the reference 4 has failed");
  EXPECT(ductile_options_set_surface(options, 4, on_circle, &works) == DUCTILE_OK);
  EXPECT(ductile_adapt(mesh, 1, sizes, options, &adapted) == DUCTILE_OK);
  EXPECT(off_circle(adapted) < 1e-12);
  EXPECT(ductile_geometry_create(mesh, options, &geometry) == DUCTILE_OK);
  EXPECT(ductile_options_set_geometry(options, geometry) == DUCTILE_OK);
  const double points[] = {1.1, 0, 0, 7};
  double closest[4], normals[4];
  int32_t references[2];
  EXPECT(ductile_geometry_closest(geometry, 2, points, .2, closest, normals, references) ==
         DUCTILE_OK);
  EXPECT(fabs(closest[0] - 1) < 1e-15 && fabs(normals[0] - 1) < 1e-3 && references[0] == 4);
  EXPECT(closest[2] != closest[2] && normals[3] != normals[3] && references[1] == 0);
  EXPECT(ductile_geometry_closest(geometry, 1, points, 0, closest, NULL, NULL) ==
         DUCTILE_WRONG_INPUT);
  ductile_geometry_destroy(geometry);
  ductile_geometry_destroy(NULL);
  EXPECT(ductile_mesh_count(adapted, DUCTILE_VERTICES) < 1000);
  EXPECT(ductile_adapt(adapted, 1, sizes, options, &again) == DUCTILE_OK);
  EXPECT(off_circle(again) < 1e-12);
  ductile_options_destroy(options);
  ductile_mesh_destroy(again);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(mesh);
}

static void test_moving(void) {
  ductile_mesh *mesh = make_disk(), *moved = NULL, *again = NULL;
  double displacement[2000];
  int32_t origins[1000];
  const int32_t unknown = 77;
  const int64_t count = ductile_mesh_count(mesh, DUCTILE_VERTICES);
  for (int64_t i = 0; i < count; ++i) {
    displacement[2 * i] = 3;
    displacement[2 * i + 1] = .5;
  }
  EXPECT(ductile_move(mesh, NULL, 0, NULL, NULL, &moved) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_move(mesh, displacement, 1, &unknown, NULL, &moved) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("bodies: expected references of elements, found 77, which none has");
  EXPECT(ductile_move(mesh, displacement, 0, NULL, NULL, &moved) == DUCTILE_OK);
  EXPECT(ductile_mesh_count(moved, DUCTILE_VERTICES) == count);
  for (int64_t i = 0; i < 2 * count; ++i)
    EXPECT(ductile_mesh_coordinates(moved)[i] ==
           ductile_mesh_coordinates(mesh)[i] + displacement[i]);
  EXPECT(ductile_mesh_metric(moved) != NULL);
  EXPECT(ductile_move_origins(moved, origins, NULL, NULL) == DUCTILE_OK);
  for (int64_t i = 0; i < count; ++i) EXPECT(origins[i] == i);
  EXPECT(ductile_move_origins(mesh, origins, NULL, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_move(moved, displacement, 0, NULL, NULL, &again) == DUCTILE_OK);
  ductile_mesh_destroy(again);
  ductile_mesh_destroy(moved);
  ductile_mesh_destroy(mesh);
}

/* The area of the triangles with a reference. */
static double area_of(const ductile_mesh* mesh, int32_t reference) {
  const double* x = ductile_mesh_coordinates(mesh);
  double area = 0;
  for (int64_t f = 0; f < ductile_mesh_count(mesh, DUCTILE_FACETS); ++f) {
    if (ductile_mesh_references(mesh, DUCTILE_FACETS)[f] != reference) continue;
    const int32_t* c = ductile_mesh_corners(mesh, DUCTILE_FACETS) + 3 * f;
    const double *p = x + 3 * c[0], *q = x + 3 * c[1], *r = x + 3 * c[2];
    double squares = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double normal = (q[j] - p[j]) * (r[k] - p[k]) - (q[k] - p[k]) * (r[j] - p[j]);
      squares += normal * normal;
    }
    area += .5 * sqrt(squares);
  }
  return area;
}

/* Facets without elements are a surface: the faces of a cube, but for its top. */
static void test_surface(void) {
  double corners[24];
  for (int v = 0; v < 8; ++v)
    for (int i = 0; i < 3; ++i) corners[3 * v + i] = v >> i & 1;
  const int32_t faces[] = {0, 2, 1, 1, 2, 3, 0, 1, 4, 1, 5, 4, 2, 6, 3,
                           3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  const int32_t references[] = {1, 1, 2, 2, 2, 2, 2, 2, 2, 2};
  const double sizes[] = {.25, .25, .25, .25, .25, .25, .25, .25};
  ductile_mesh *box = NULL, *adapted = NULL;
  EXPECT(ductile_mesh_create(3, &box) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_vertices(box, 8, corners, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_facets(box, 10, faces, references) == DUCTILE_OK);
  EXPECT(ductile_mesh_count(box, DUCTILE_FACETS) == 10);
  EXPECT(ductile_adapt(box, 1, sizes, NULL, &adapted) == DUCTILE_OK);
  EXPECT(ductile_mesh_dimension(adapted) == 3 &&
         ductile_mesh_count(adapted, DUCTILE_ELEMENTS) == 0);
  const int64_t count = ductile_mesh_count(adapted, DUCTILE_FACETS);
  EXPECT(count > 120 && count < 320);
  EXPECT(fabs(area_of(adapted, 1) - 1) < 1e-12 && fabs(area_of(adapted, 2) - 4) < 1e-12);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(box);
}

/* The piece of C in docs/c-and-fortran.md. */
static void test_guide(void) {
  const double *points = square, sizes[] = {0.1, 0.1, 0.1, 0.1};
  const int32_t* triangles = halves;
  const int vertices = 4, elements = 2;
#include "guide.inc"
  EXPECT(x != NULL && ductile_mesh_count(adapted, DUCTILE_VERTICES) > 50);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(mesh);
}

/** A disk of radius 1/2 in one of radius 1. */
static void test_signed_distance(void) {
  double x[2 * 97] = {0}, distances[97];
  int32_t triangles[3 * 160], references[160];
  int64_t n = 0;
  for (int i = 0; i < 96; ++i) {
    const double angle = i % 32 * acos(-1) / 16, radius = (i / 32 + 1) / 4. + (i >= 64 ? .25 : 0);
    x[2 * i + 2] = radius * cos(angle);
    x[2 * i + 3] = radius * sin(angle);
  }
  for (int i = 0; i < 32; ++i) {
    const int a = i + 1, b = (i + 1) % 32 + 1;
    const int32_t corners[] = {0, a,      b,      a,      a + 32, b + 32, a,     b + 32,
                               b, a + 32, a + 64, b + 64, a + 32, b + 64, b + 32};
    for (int k = 0; k < 5; ++k, ++n) {
      memcpy(triangles + 3 * n, corners + 3 * k, 3 * sizeof *corners);
      references[n] = k < 3 ? 3 : 2;
    }
  }
  ductile_mesh* mesh = NULL;
  EXPECT(ductile_mesh_create(2, &mesh) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_vertices(mesh, 97, x, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_elements(mesh, n, triangles, references) == DUCTILE_OK);
  const int32_t inside = 3, missing = 7;
  EXPECT(ductile_signed_distance(mesh, NULL, 1, &inside, 97, NULL, distances) == DUCTILE_OK);
  EXPECT(fabs(distances[0] + .5) < 1e-3 && distances[33] == 0 && fabs(distances[96] - .5) < 1e-3);
  const double points[] = {.51, 0, 0, -.3, .4975, .0488};
  EXPECT(ductile_signed_distance(mesh, NULL, 1, &inside, 3, points, distances) == DUCTILE_OK);
  EXPECT(fabs(distances[0] - .01) < 1e-5 && fabs(distances[1] + .2) < 1e-4);
  EXPECT(fabs(distances[2] - (hypot(.4975, .0488) - .5)) < 1e-5);
  EXPECT(ductile_signed_distance(mesh, NULL, 1, &inside, 3, NULL, distances) ==
         DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("count: expected the number of vertices, 97, because there are no points; found 3");
  EXPECT(ductile_signed_distance(mesh, NULL, 1, &missing, 97, NULL, distances) ==
         DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("mesh: no element has the reference 7, which is to be inside");
  ductile_mesh_destroy(mesh);
}

/* A disc of radius .3 in a square of n x n cells. */
static ductile_mesh* make_cells(int n, double* phi) {
  ductile_mesh* mesh = NULL;
  double points[2 * 21 * 21];
  int32_t corners[6 * 20 * 20];
  EXPECT(n <= 20);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const int v = i * (n + 1) + j;
      points[2 * v] = (double)i / n;
      points[2 * v + 1] = (double)j / n;
      phi[v] = hypot(points[2 * v] - .5, points[2 * v + 1] - .5) - .3;
      if (i == n || j == n) continue;
      const int32_t cell[] = {v, v + n + 1, v + n + 2, v, v + n + 2, v + 1};
      memcpy(corners + 6 * (i * n + j), cell, sizeof cell);
    }
  EXPECT(ductile_mesh_create(2, &mesh) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_vertices(mesh, (n + 1) * (n + 1), points, NULL) == DUCTILE_OK);
  EXPECT(ductile_mesh_set_elements(mesh, 2 * n * n, corners, NULL) == DUCTILE_OK);
  return mesh;
}

/* The largest distance of the interface's vertices from the circle; -1 without an interface. */
static double off_disc(const ductile_mesh* mesh, int32_t reference) {
  const double* x = ductile_mesh_coordinates(mesh);
  const int32_t* corners = ductile_mesh_corners(mesh, DUCTILE_FACETS);
  const int32_t* references = ductile_mesh_references(mesh, DUCTILE_FACETS);
  double most = -1;
  for (int64_t i = 0; i < 2 * ductile_mesh_count(mesh, DUCTILE_FACETS); ++i)
    if (references[i / 2] == reference)
      most = fmax(most, fabs(hypot(x[2 * corners[i]] - .5, x[2 * corners[i] + 1] - .5) - .3));
  return most;
}

static int64_t elements_with(const ductile_mesh* mesh, int32_t reference) {
  const int32_t* references = ductile_mesh_references(mesh, DUCTILE_ELEMENTS);
  int64_t count = 0;
  for (int64_t i = 0; i < ductile_mesh_count(mesh, DUCTILE_ELEMENTS); ++i)
    count += references[i] == reference;
  return count;
}

static void test_level_sets(void) {
  double phi[21 * 21], value = 0, weights[2000];
  int32_t ends[4000], elements[4000];
  ductile_mesh *mesh = make_cells(20, phi), *cut = NULL, *adapted = NULL;
  ductile_options* options = NULL;
  EXPECT(ductile_options_create(&options) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "threads", 2) == DUCTILE_OK);
  EXPECT(ductile_cut(NULL, phi, options, &cut) == DUCTILE_WRONG_INPUT && cut == NULL);
  EXPECT(ductile_cut(mesh, NULL, NULL, &cut) == DUCTILE_WRONG_INPUT && cut == NULL);
  EXPECT(ductile_cut(mesh, phi, NULL, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_cut_origins(mesh, ends, NULL, NULL) == DUCTILE_WRONG_INPUT);
  EXPECT_TEXT("cut: expected a mesh from ductile_cut(), found another");
  EXPECT(ductile_options_set(options, "rmc", 2) == DUCTILE_OK);
  EXPECT(ductile_cut(mesh, phi, options, &cut) == DUCTILE_WRONG_INPUT && cut == NULL);
  EXPECT_TEXT("option rmc: expected a fraction of the volume, from 0 to below 1, found 2");
  EXPECT(ductile_options_set(options, "rmc", 1e-5) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "isoref", 1.5) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "isoref", 7) == DUCTILE_OK);
  EXPECT(ductile_options_set_material(options, 0, 2, 1, 2) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set_material(options, 0, 0, 1, 2) == DUCTILE_OK);
  EXPECT(ductile_options_set_material(options, 0, 1, 11, 12) == DUCTILE_OK);
  EXPECT(ductile_cut(mesh, phi, options, &cut) == DUCTILE_OK);
  EXPECT(elements_with(cut, 11) > 0 && elements_with(cut, 12) > 0 && elements_with(cut, 0) == 0);
  EXPECT(off_disc(cut, 7) > 0 && off_disc(cut, 7) < 1e-3);
  EXPECT(ductile_cut_origins(cut, ends, weights, elements) == DUCTILE_OK);
  EXPECT(ductile_cut_origins(cut, NULL, NULL, NULL) == DUCTILE_OK);
  const double *now = ductile_mesh_coordinates(cut), *then = ductile_mesh_coordinates(mesh);
  for (int64_t i = 0; i < 2 * ductile_mesh_count(cut, DUCTILE_VERTICES); ++i) {
    const double t = weights[i / 2];
    const int32_t* end = ends + i / 2 * 2;
    EXPECT(fabs(now[i] - (1 - t) * then[2 * end[0] + i % 2] - t * then[2 * end[1] + i % 2]) <
           1e-14);
  }
  for (int64_t i = 0; i < ductile_mesh_count(cut, DUCTILE_ELEMENTS); ++i)
    EXPECT(elements[i] >= 0 && elements[i] < ductile_mesh_count(mesh, DUCTILE_ELEMENTS));
  EXPECT(ductile_mesh_report(cut, "volume_below", &value) == DUCTILE_OK);
  EXPECT(fabs(value / (3.14159265 * .09) - 1) < .01);
  EXPECT(ductile_mesh_report(cut, "iterations", &value) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "hausd", .002) == DUCTILE_OK);
  EXPECT(ductile_adapt(cut, 0, NULL, options, &adapted) == DUCTILE_OK);
  EXPECT(off_disc(adapted, 7) >= 0 && off_disc(adapted, 7) < 1e-3);
  EXPECT(ductile_mesh_count(adapted, DUCTILE_ELEMENTS) < 1200);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(cut);
  EXPECT(ductile_options_set(options, "keep_volume", .2) == DUCTILE_OK);
  EXPECT(ductile_cut(mesh, phi, options, &cut) == DUCTILE_OK);
  EXPECT(ductile_mesh_report(cut, "volume_below", &value) == DUCTILE_OK);
  EXPECT(fabs(value - .2) < 1e-5);
  ductile_mesh_destroy(cut);
  EXPECT(ductile_options_set(options, "keep_volume", 0) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "lssurf", 2) == DUCTILE_WRONG_INPUT);
  EXPECT(ductile_options_set(options, "lssurf", 1) == DUCTILE_OK);
  EXPECT(ductile_cut(mesh, phi, options, &cut) == DUCTILE_WRONG_INPUT);
  EXPECT(strstr(ductile_last_error(), "expected tetrahedra and triangles") != NULL);
  EXPECT(ductile_options_set(options, "lssurf", 0) == DUCTILE_OK);
  EXPECT(ductile_options_set(options, "ls", 9) == DUCTILE_OK);
  EXPECT(ductile_cut(mesh, phi, options, &cut) == DUCTILE_OK);
  EXPECT(ductile_mesh_warning(cut, 0) != NULL);
  EXPECT(ductile_adapt(cut, 0, NULL, options, &adapted) == DUCTILE_OK);
  EXPECT(off_disc(adapted, 7) == -1);
  ductile_options_destroy(options);
  ductile_mesh_destroy(adapted);
  ductile_mesh_destroy(cut);
  ductile_mesh_destroy(mesh);
}

int main(void) {
  EXPECT(strcmp(ductile_last_error(), "") == 0 && strlen(ductile_version()) >= 5);
  test_meshes();
  test_no_handles();
  test_errors();
  test_options();
  test_adaptation();
  test_solution_metric();
  test_joining();
  test_names();
  test_sizes();
  test_geometry();
  test_moving();
  test_surface();
  test_guide();
  test_level_sets();
  test_signed_distance();
  printf("%d failures\n", failures);
  return failures != 0;
}
