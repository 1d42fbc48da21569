/** @file
 * Mesh adaptation for C, Fortran and all languages that can call C: gives the edges of a mesh the
 * lengths that a metric asks for. Takes and returns plain arrays; vertices are numbered from 0.
 *
 * Functions that can fail return a code: DUCTILE_OK; DUCTILE_FAILED, for example if memory runs out
 * or the caller has cancelled; DUCTILE_WRONG_INPUT, for invalid arrays, names or files.
 * ductile_last_error() describes the failure. Results are written only on success. Nothing is
 * printed. The caller owns handles and destroys them. A NULL handle is wrong input for functions
 * that return a code; for others it is empty: arrays and texts are NULL, counts -1, the dimension
 * 0. Thread safety: any thread; one handle may be read by several threads, and changed by one while
 * no other uses it.
 */
#ifndef DUCTILE_H
#define DUCTILE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { DUCTILE_OK = 0, DUCTILE_FAILED = 1, DUCTILE_WRONG_INPUT = 2 };

/** Kinds of entities. Elements are triangles in 2D and tetrahedra in 3D; facets, of the boundary
 * and of interfaces, are edges in 2D and triangles in 3D; ridges are edges in 3D, along curves.
 * Modifiers of kinds: see ductile_transfer_carry(). */
enum {
  DUCTILE_VERTICES = 0,
  DUCTILE_RIDGES = 1,
  DUCTILE_FACETS = 2,
  DUCTILE_ELEMENTS = 3,
  DUCTILE_CONSERVATIVE = 16
};

typedef struct ductile_mesh ductile_mesh;
typedef struct ductile_options ductile_options;
typedef struct ductile_geometry ductile_geometry;
typedef struct ductile_sizes ductile_sizes;
typedef struct ductile_transfer ductile_transfer;

/** The version of the library, such as "0.2.0". */
const char* ductile_version(void);

/** The error of the last call on this thread that failed, one line; never NULL. Entries of arrays
 * are counted from 0. Valid until the next call on this thread fails. */
const char* ductile_last_error(void);

/* ---- Meshes ---- */

/** An empty mesh of dimension 2 or 3. One of dimension 3 with facets and no elements is a surface,
 * whose facets are adapted; ridges are its listed edges. */
int ductile_mesh_create(int dimension, ductile_mesh** mesh);

/** Sets `count` vertices, replacing all contents except names: coordinates[vertex *
 * dimension + axis]; reference[vertex], or NULL for 0. Arrays are copied, here and below. */
int ductile_mesh_set_vertices(ductile_mesh* mesh, int64_t count, const double* coordinates,
                              const int32_t* reference);

/** Sets elements, triangles in 2D and tetrahedra in 3D, replacing all cells:
 * corners[element * (dimension + 1) + corner]; reference[element], or NULL for 0. The boundary, and
 * interfaces between elements of different references, become facets of reference 0. */
int ductile_mesh_set_elements(ductile_mesh* mesh, int64_t count, const int32_t* corners,
                              const int32_t* reference);
/** The same for corners of 64 bits. */
int ductile_mesh_set_elements_64(ductile_mesh* mesh, int64_t count, const int64_t* corners,
                                 const int32_t* reference);

/** Puts these facets first, corners[facet * dimension + corner]; facets found before and not among
 * them follow. Forgets which facets are required. reference[facet], or NULL for 0. */
int ductile_mesh_set_facets(ductile_mesh* mesh, int64_t count, const int32_t* corners,
                            const int32_t* reference);
/** The same for corners of 64 bits. */
int ductile_mesh_set_facets_64(ductile_mesh* mesh, int64_t count, const int64_t* corners,
                               const int32_t* reference);

/** Sets the required entities, by their indices, replacing those required before. `kind`
 * is DUCTILE_VERTICES, DUCTILE_FACETS or DUCTILE_ELEMENTS. */
int ductile_mesh_require(ductile_mesh* mesh, int kind, int64_t count, const int32_t* indices);

/** Names the entities with a reference, such as "wall"; "" or NULL removes the name. Names stay
 * when arrays are replaced, in adapted meshes, and in files whose format holds names. There are no
 * ridges in 2D. */
int ductile_mesh_set_name(ductile_mesh* mesh, int kind, int32_t reference, const char* name);
/** The name of a reference, valid until the mesh is changed or destroyed; NULL if it has none. */
const char* ductile_mesh_name(const ductile_mesh* mesh, int kind, int32_t reference);
/** Name i, and its kind and reference unless these are NULL; NULL beyond the last. Files may name
 * entities that the mesh cannot have, such as volumes in 2D; their kind is -1. */
const char* ductile_mesh_name_at(const ductile_mesh* mesh, int64_t i, int* kind,
                                 int32_t* reference);

/** Joins vertices at most `distance` apart, and facets that become the same; the first of each
 * stays, with its reference. `kept` gets the indices before of the vertices that stay, and has room
 * for all vertices; NULL if not wanted. A mesh from an adaptation loses its metric and report. */
int ductile_mesh_join_vertices(ductile_mesh* mesh, double distance, int32_t* kept);

/** Reads a file of any format that `ductile help` lists, detected by content. */
int ductile_mesh_read(const char* path, ductile_mesh** mesh);
/** Writes a mesh in the format of the ending of `path`. The metric of an adapted mesh goes into
 * formats that hold fields: .vtu, .vtk and .msh. */
int ductile_mesh_write(const ductile_mesh* mesh, const char* path);

/** Destroys a mesh; NULL is allowed. */
void ductile_mesh_destroy(ductile_mesh* mesh);

/** 2 or 3; 0 for NULL. */
int ductile_mesh_dimension(const ductile_mesh* mesh);

/** Number of entities; -1 for an unknown kind. */
int64_t ductile_mesh_count(const ductile_mesh* mesh, int kind);

/** Arrays of the mesh, valid until it is changed or destroyed; NULL where there are none.
 * [vertex * dimension + axis] */
const double* ductile_mesh_coordinates(const ductile_mesh* mesh);
/** [entity * corners of one + corner], of ridges, facets or elements. */
const int32_t* ductile_mesh_corners(const ductile_mesh* mesh, int kind);
/** [entity] */
const int32_t* ductile_mesh_references(const ductile_mesh* mesh, int kind);
/** The metric at the vertices of an adapted mesh, [vertex * components + component]: in 2D
 * m11 m12 m22, in 3D m11 m12 m22 m13 m23 m33. NULL for other meshes. */
const double* ductile_mesh_metric(const ductile_mesh* mesh);

/* ---- Options ---- */

/** Makes options with default values. */
int ductile_options_create(ductile_options** options);
/** Destroys options; NULL is allowed. */
void ductile_options_destroy(ductile_options* options);

/** Sets an option by its name. Names are those of the program: "hmin", "hmax", "hgrad", "hgradreq",
 * "hausd", "ar", "iterations", "threads", "memory" in megabytes, "elements", "norm", those of
 * ductile_cut(); "projection",
 * "nomove", "noswap", "noinsert", "nosurf", "A", "thorough" and "racing", which are 0 or 1. */
int ductile_options_set(ductile_options* options, const char* name, double value);

/** Called after each step of the adaptation, on the thread that called ductile_adapt(): the step's
 * name, the iteration and the number of changes. Returns 0 to cancel, anything else to go on. */
typedef int (*ductile_progress)(const char* step, int iteration, int64_t changes, void* context);
/** Sets the function that is called after each step; NULL is none. */
int ductile_options_set_progress(ductile_options* options, ductile_progress progress,
                                 void* context);

/* ---- Curved boundaries, with the option "hausd" ---- */

/** Computes the closest point of a surface, in 2D a curve, to a nearby point; both have three
 * coordinates, the third 0 in 2D. Surfaces may extend beyond their ridges: a cylinder need not end.
 * Must be deterministic. Called by several threads at a time, including ones that the caller has
 * not made; must not throw or jump. Returns 0 on failure, which ends the call that needed it with
 * DUCTILE_FAILED. */
typedef int (*ductile_surface)(const double* point, double* closest, void* context);
/** Sets the surface of the facets with a reference: new and moved vertices are put on it. Ridges
 * are those of the mesh; where two such surfaces meet, or one and a flat side, points lie on both.
 * Replaces the previous surface of the reference; NULL removes it. */
int ductile_options_set_surface(ductile_options* options, int32_t reference,
                                ductile_surface surface, void* context);

/** Makes a model of the curved boundaries of a mesh, for many meshes of the domain. Uses the
 * options "hausd", which must be above 0, "ar", "threads" and surfaces, whose contexts must outlive
 * the geometry. */
int ductile_geometry_create(const ductile_mesh* mesh, const ductile_options* options,
                            ductile_geometry** geometry);
/** Destroys a geometry; NULL is allowed. Options that use it keep what they need. */
void ductile_geometry_destroy(ductile_geometry* geometry);
/** Measures curved boundaries from a geometry instead of the adapted mesh, with the "hausd" and the
 * surfaces of the geometry, which replace those set before; NULL removes it. */
int ductile_options_set_geometry(ductile_options* options, const ductile_geometry* geometry);
/** Approximate closest points of a geometry within `reach` of `count` points, and the
 * unit normals and references there, unless these are NULL: points[point * dimension + axis], the
 * same of closest and normals. NaN and 0 where there is none. */
int ductile_geometry_closest(const ductile_geometry* geometry, int64_t count, const double* points,
                             double reach, double* closest, double* normals, int32_t* references);

/** The signed distance to the interface between the elements with one of `references`, where it is
 * negative, and others, curved through its vertices: at `count` points[point * dimension + axis],
 * or at the vertices of the mesh if `points` is NULL and `count` their number. Uses the options
 * "hausd", which may be 0, "ar" and "threads"; `options` may be NULL. */
int ductile_signed_distance(const ductile_mesh* mesh, const ductile_options* options,
                            int64_t reference_count, const int32_t* references, int64_t count,
                            const double* points, double* distances);

/* ---- Level sets: a mesh is cut where a function is the value of the option "ls" ---- */

/** Cuts a mesh: the level set becomes facets. values[vertex]. The options are "ls", 0; "minus", 3,
 * and "plus", 2, the references of elements with lower and higher values; "isoref", 10, that of the
 * facets between them; "rmc", 0: parts of either side with less than this fraction of the volume
 * become part of the other; "keep_volume", 0: not 0, changes "ls" so that the elements of lower
 * values have this volume; "lssurf", 0: 1 cuts only the triangles of the boundary of tetrahedra,
 * which get references by side; "threads". `options` may be NULL. A surface alone is cut along
 * edges. The vertices of the mesh before come first. Adapted with "hausd" and without a geometry, the interface gets onto the curved surface of
 * the function; without a metric, the sizes are those of the mesh before. ductile_mesh_report()
 * knows "level", "volume_below", "cut_elements", "moved_vertices" and "removed_components". */
int ductile_cut(const ductile_mesh* mesh, const double* values, const ductile_options* options,
                ductile_mesh** cut);

/** What becomes of the elements with a reference in ductile_cut(): with `split` 1 they get the
 * references `minus` and `plus`, with 0 they keep theirs. Then all references need an entry. */
int ductile_options_set_material(ductile_options* options, int32_t reference, int split,
                                 int32_t minus, int32_t plus);

/** Where a cut mesh comes from: each vertex lies at (1 - weight) a + weight b, with vertices[vertex
 * * 2] = a and the next b of the mesh before, and weights[vertex]; elements[element] is the one
 * that it is a part of. NULL for arrays that are not wanted. */
int ductile_cut_origins(const ductile_mesh* cut, int32_t* vertices, double* weights,
                        int32_t* elements);

/* ---- Sizes by places, without tensors. The finest of several wins ---- */

/** Makes empty sizes, for meshes of dimension 2 or 3. */
int ductile_sizes_create(int dimension, ductile_sizes** sizes);
/** Destroys sizes; NULL is allowed. */
void ductile_sizes_destroy(ductile_sizes* sizes);

/** Sets a number by its name. "default" is the size where nothing finer applies, by default the
 * extent of the mesh; "hmin" and "hmax" are bounds, applied last. The others apply to places added
 * afterwards, whose size grows by the factor "grow" per unit of metric length (default 1.3, 0: not
 * at all), up to "largest" (0: without end), or linearly to that over "distance" if it is above
 * 0. */
int ductile_sizes_set(ductile_sizes* sizes, const char* name, double value);

/** Sets a size in a ball; radius 0 is a point. Places are counted from 0 in errors. */
int ductile_sizes_near_ball(ductile_sizes* sizes, const double* centre, double radius, double size);
/** The same in a box between two opposite corners. */
int ductile_sizes_near_box(ductile_sizes* sizes, const double* low, const double* high,
                           double size);
/** The same along segments from each of `count` points to the next,
 * points[point * dimension + axis]. */
int ductile_sizes_near_curve(ductile_sizes* sizes, int64_t count, const double* points,
                             double size);
/** The same on `count` triangles, corners[(triangle * 3 + corner) * dimension + axis]. */
int ductile_sizes_near_surface(ductile_sizes* sizes, int64_t count, const double* corners,
                               double size);
/** The same where entities of a kind carry a reference. In elements the size takes the place of the
 * default, finer or coarser. */
int ductile_sizes_on(ductile_sizes* sizes, int kind, int32_t reference, double size);
/** The same where entities of any kind carry a reference of this name. */
int ductile_sizes_on_name(ductile_sizes* sizes, const char* name, double size);

/** The size at each vertex of a mesh, for which `values` has room. */
int ductile_sizes_at(const ductile_sizes* sizes, const ductile_mesh* mesh, double* values);

/* ---- Adaptation ---- */

/** Computes the metric, in the order of ductile_mesh_metric(), in which linear interpolation of a
 * solution has the smallest error for about "elements" elements, an option that must be set, in the
 * norm L^"norm" (2 by default); within "hmin", "hmax" and "hgrad". Second derivatives
 * are those of fitted quadratics, or with "projection" of double projection. values[vertex *
 * components + component]: the metric suits all components. */
int ductile_solution_metric(const ductile_mesh* mesh, int components, const double* values,
                            const ductile_options* options, double* metric);

/** Adapts a mesh. `components` is the size of the metric at each vertex: 1, a size; 3 in 2D, 6 in
 * 3D, a symmetric tensor in the order above; 4 in 2D, 9 in 3D, a full matrix. NULL for `metric`:
 * the sizes of the mesh. NULL for `options`: the defaults. */
int ductile_adapt(const ductile_mesh* mesh, int components, const double* metric,
                  const ductile_options* options, ductile_mesh** adapted);

/** Adapts a mesh to sizes, and the result again while sizes evaluated on it are finer than before,
 * at most five times in all; once with "hausd". */
int ductile_adapt_to_sizes(const ductile_mesh* mesh, const ductile_sizes* sizes,
                           const ductile_options* options, ductile_mesh** adapted);

/** Moves a mesh by displacement[vertex * dimension + axis], and adapts it where elements get bad:
 * bodies are the elements with these references, `count` of them; with 0, displacements decide (see
 * docs/moving.md). Sizes are those of the metric that an adapted or moved mesh has, otherwise the
 * mesh's own; the moved mesh has them, too. Of the options, "hmin", "hmax", "hgrad" and "threads"
 * matter. NULL for `options`: the defaults. If the way is blocked, DUCTILE_FAILED. */
int ductile_move(const ductile_mesh* mesh, const double* displacement, int64_t count,
                 const int32_t* bodies, const ductile_options* options, ductile_mesh** moved);

/** For each vertex, facet and element of a moved mesh the index before of the one that it is, at
 * another place; -1 if it is new. NULL for arrays that are not wanted. */
int ductile_move_origins(const ductile_mesh* moved, int32_t* vertices, int32_t* facets,
                         int32_t* elements);

/** A figure of the adaptation that a mesh came from: "iterations", "converged", "seconds",
 * "fixed_vertices", "held_long_edges", "held_short_edges", "warnings". */
int ductile_mesh_report(const ductile_mesh* adapted, const char* name, double* value);
/** The text of warning i; NULL beyond the last. */
const char* ductile_mesh_warning(const ductile_mesh* adapted, int64_t i);

/* ---- From one mesh to another ---- */

/** Locates the mesh `after` in `before`, from which it was made. Refers to both: they must not be
 * changed or destroyed before it is. */
int ductile_transfer_create(const ductile_mesh* before, const ductile_mesh* after,
                            ductile_transfer** transfer);
/** Destroys a transfer; NULL is allowed. */
void ductile_transfer_destroy(ductile_transfer* transfer);

/** For each vertex, facet or element of `after` the index in `before` of the vertex at the same
 * position or of the entity with the same vertices; -1 if none. NULL for other kinds. The triangles
 * of a surface are facets and elements here. */
const int32_t* ductile_transfer_origins(const ductile_transfer* transfer, int kind);
/** For each vertex of `after` the element of `before` that contains it, or the closest. */
const int32_t* ductile_transfer_hosts(const ductile_transfer* transfer);
/** Its barycentric weights there, [vertex * corners of an element + corner]. */
const double* ductile_transfer_weights(const ductile_transfer* transfer);

/** Transfers values, [entity * components + component], to `result`, which has room for those of
 * `after`. `how` is DUCTILE_VERTICES, values at vertices, linear in each element, or
 * DUCTILE_ELEMENTS, values on elements; plus DUCTILE_CONSERVATIVE to keep integrals if both
 * meshes cover the same domain. */
int ductile_transfer_carry(const ductile_transfer* transfer, int how, int components,
                           const double* values, double* result);

#ifdef __cplusplus
}
#endif

#endif
