#include "geometry/check_input.hpp"

#include <algorithm>
#include <cmath>

#include "core/first_bad.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/geometry.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "geometry/projection.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/flatten.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

template <int Dim, int Space>
class InputChecker {
 public:
  InputChecker(const Executor& executor, const AnyMesh& any, const MakeMeshOptions& options)
      : executor_(executor), any_(any), options_(options) {}

  void run() const {
    check_options();
    check_indices();
  }

 private:
  [[noreturn]] void fail(const Wording& what) const { refuse_mesh(any_, what); }

  static Wording place_word(std::size_t coordinate) {
    return {"coordinates[" + std::to_string(coordinate) + "] is",
            entity("vertex", coordinate / Space) + " has a coordinate"};
  }

  void check_options() const {
    const double tolerance = options_.hausdorff_tolerance, angle = options_.ridge_angle;
    if (!(tolerance == 0 || (tolerance >= smallest_size && tolerance <= largest_size)))
      throw InputError("hausdorff_tolerance: expected 0, or a length from 1e-75 to 1e75, found " +
                       number(tolerance));
    if (!(angle > 0 && angle < 90))
      throw InputError("ridge_angle: expected an angle between 0 and 90 degrees, found " +
                       number(angle));
    check_functions();
    check_geometry();
    const auto& kept = options_.keep_facets_at;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] >= any_.vertex_count())
        throw InputError("keep_facets_at[" + std::to_string(i) + "]: expected a vertex below " +
                         std::to_string(any_.vertex_count()) + ", found " +
                         std::to_string(kept[i]));
  }

  void check_functions() const {
    const auto& functions = options_.functions;
    expect_functions(functions);
    if (functions.empty()) return;
    if (options_.geometry)
      throw InputError("functions: expected none beside a geometry, which has its own");
    if (!(options_.hausdorff_tolerance > 0))
      throw InputError("functions: expected a hausdorff_tolerance with them, found none");
    const auto& found = Space == 2 ? any_.edges.reference : any_.triangles.reference;
    for (const SurfaceFunction& function : functions)
      if (!(options_.complete_boundary && function.reference == 0) &&
          std::find(found.begin(), found.end(), function.reference) == found.end())
        throw InputError("functions: no facet has the reference " +
                         std::to_string(function.reference));
  }

  void check_geometry() const {
    if (!options_.geometry) return;
    const double tolerance = options_.hausdorff_tolerance;
    if (options_.geometry->dimension() != Space)
      throw InputError("geometry: expected one of dimension " + std::to_string(Space) +
                       ", as the mesh is, found dimension " +
                       std::to_string(options_.geometry->dimension()));
    if (tolerance != 0 && tolerance != options_.geometry->tolerance())
      throw InputError("hausdorff_tolerance: expected that of the geometry, " +
                       number(options_.geometry->tolerance()) + ", found " + number(tolerance));
  }

  /// The squares of volumes must be numbers, too.
  void check_scale() const {
    constexpr double largest = 1e50, smallest = 1e-50;
    const auto& x = any_.coordinates;
    const std::size_t far =
        first_bad(executor_, x.size(), [&](std::size_t i) { return std::abs(x[i]) > largest; });
    if (far != no_index) fail(place_word(far) + " beyond 1e50; scale the mesh");
    const double extent = runtime::parallel_reduce(
        executor_, x.size(), 0.0, [&](std::size_t i) { return std::abs(x[i] - x[i % Space]); },
        [](double a, double b) { return std::max(a, b); });
    if (extent < smallest) fail("the mesh is smaller than 1e-50; scale it");
  }

  void check_indices() const {
    expect_coordinates(any_);
    expect_references(any_);
    const auto& cells = elements_in<Dim>(any_);
    if (any_.dimension != Space) fail("the mesh has the wrong dimension");
    if (cells.size() == 0) {
      const std::string instead = Dim == 3 ? instead_of_tetrahedra(any_) : "";
      fail(std::string("no ") + element_name<Dim>() + " in the mesh" +
           (instead.empty() ? "; there is nothing to adapt" : ", " + instead));
    }
    if (Space == 2 && any_.tetrahedra.size() != 0) fail("tetrahedra in a mesh of dimension 2");
    if (any_.vertex_count() >= none || cells.size() >= none / 4)
      fail("too many entities for 32-bit numbers");
    const std::size_t bad_vertex =
        first_bad(executor_, any_.coordinates.size(),
                  [&](std::size_t i) { return !std::isfinite(any_.coordinates[i]); });
    if (bad_vertex != no_index)
      fail(place_word(bad_vertex) + Wording(" not", " that is not") + " a finite number");
    check_scale();
    check_cells(cells, element_name<Dim>());
    check_cells(facets_in<Dim>(any_), facet_name<Dim>());
    if constexpr (Dim == 3) check_cells(any_.edges, "edge");
    check_vertices(any_.corners, "corner");
    check_vertices(any_.required_vertices, "required vertex");
  }

  void check_vertices(const std::vector<std::uint32_t>& listed, const char* what) const {
    for (const std::uint32_t v : listed)
      if (v >= any_.vertex_count())
        fail(std::string("a ") + what + " names vertex " + index_word(v) + ", but there are only " +
             std::to_string(any_.vertex_count()));
  }

  /// Triangles of a surface that name a vertex twice have no area, and are left out.
  template <int N>
  static constexpr bool may_repeat = Dim < Space&& N == 3;

  template <int N>
  void check_cells(const Cells<N>& cells, const char* kind) const {
    const std::size_t bad = first_bad(executor_, cells.size(), [&](std::size_t i) {
      const auto& corners = cells.vertices[i];
      for (std::size_t a = 0; a < corners.size(); ++a) {
        if (corners[a] >= any_.vertex_count()) return true;
        for (std::size_t b = 0; b < a; ++b)
          if (corners[a] == corners[b] && !may_repeat<N>) return true;
      }
      return false;
    });
    if (bad == no_index) return;
    for (const std::uint32_t v : cells.vertices[bad])
      if (v >= any_.vertex_count())
        fail(cell_word(kind, bad) + " names vertex " + index_word(v) + ", but there are only " +
             std::to_string(any_.vertex_count()));
    fail(cell_word(kind, bad) + " names the same vertex twice; remove it");
  }

  const Executor& executor_;
  const AnyMesh& any_;
  const MakeMeshOptions& options_;
};

}  // namespace

template <int Dim, int Space>
void check_input(const Executor& executor, const AnyMesh& mesh, const MakeMeshOptions& options) {
  InputChecker<Dim, Space>(executor, mesh, options).run();
}

std::vector<bool> marked(const AnyMesh& mesh, std::size_t count,
                         const std::vector<std::uint32_t>& list, const char* kind) {
  std::vector<bool> flags(count, false);
  for (const std::uint32_t i : list) {
    if (i >= count)
      refuse_mesh(mesh, std::string("a required or ridge ") + kind + " has number " +
                            index_word(i) + ", but there are only " + std::to_string(count));
    flags[i] = true;
  }
  return flags;
}

Wording cell_word(const std::string& kind, std::size_t index) {
  const std::string array = kind == "tetrahedron" ? "tetrahedra" : kind + "s";
  return entry(array + ".vertices", kind, index);
}

void refuse_mesh(const AnyMesh& mesh, const Wording& what) { refuse(name_of(mesh) + ": " + what); }

template void check_input<2>(const Executor&, const AnyMesh&, const MakeMeshOptions&);
template void check_input<2, 3>(const Executor&, const AnyMesh&, const MakeMeshOptions&);
template void check_input<3>(const Executor&, const AnyMesh&, const MakeMeshOptions&);

}  // namespace ductile::meshadapt
