#include "ductile/meshadapt/fixed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "core/determinant.hpp"
#include "core/first_bad.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/finite_values.hpp"
#include "mesh/flatten.hpp"
#include "mesh/indices.hpp"
#include "mesh/wording.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

template <int Dim, int Space>
class FixedMeshMaker {
 public:
  FixedMeshMaker(const Executor& executor, const AnyMesh& any) : executor_(executor), any_(any) {}

  FixedMesh<Dim, Space> make() {
    check();
    place_vertices();
    measure_elements();
    connect();
    describe_vertices();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const Wording& what) const { refuse(name_of(any_) + ": " + what); }

  void check() const {
    const auto& elements = elements_in<Dim>(any_).vertices;
    if (any_.dimension != Space)
      fail("expected dimension " + std::to_string(Space) + ", found " +
           std::to_string(any_.dimension));
    expect_coordinates(any_);
    if (elements.empty()) {
      const std::string instead = Dim == 3 ? instead_of_tetrahedra(any_) : "";
      fail(std::string("expected ") + (Dim == 2 ? "triangles" : "tetrahedra") + ", found none" +
           (instead.empty() ? "" : ", " + instead));
    }
    if (any_.vertex_count() >= none || elements.size() >= none / 4)
      fail("too many entities for 32-bit numbers");
    expect_corners<Dim>(executor_, any_);
    expect_finite_coordinates(executor_, any_);
  }

  void place_vertices() {
    mesh_.position_of.resize(any_.vertex_count());
    parallel_for(executor_, mesh_.vertex_count(),
                 [&](std::size_t v) { mesh_.position_of[v] = position_in<Space>(any_, v); });
  }

  void measure_elements() {
    mesh_.corners_of = elements_in<Dim>(any_).vertices;
    mesh_.volume_of.resize(mesh_.element_count());
    parallel_for(executor_, mesh_.element_count(), [&](std::size_t e) {
      const auto points = mesh_.points(static_cast<ElementId>(e));
      if constexpr (Dim < Space) {
        mesh_.volume_of[e] = norm(facet_normal(points)) / 2;
      } else {
        const double determinant = plain_determinant(points);
        if (determinant < 0) std::swap(mesh_.corners_of[e][0], mesh_.corners_of[e][1]);
        mesh_.volume_of[e] = std::abs(determinant) / (Dim == 2 ? 2 : 6);
      }
    });
    const std::size_t bad = first_bad(executor_, elements_in<Dim>(any_).size(), [&](std::size_t e) {
      const double volume = mesh_.volume_of[e];
      const bool has_volume = Dim < Space ? are_distinct(mesh_.corners_of[e]) : volume > 0;
      return !(has_volume && std::isfinite(volume));
    });
    if (bad != no_index)
      fail(entry(elements_array<Dim>(), element_name<Dim>(), bad) +
           " has no volume; remove or repair it");
  }

  static bool are_distinct(Corners<Dim> corners) {
    std::sort(corners.begin(), corners.end());
    return std::adjacent_find(corners.begin(), corners.end()) == corners.end();
  }

  /// The neighbour across a crowded facet is ambiguous, so the facet counts as a boundary.
  void connect() {
    const std::span<const Corners<Dim>> corners_of = mesh_.corners_of;
    Adjacency<Dim> adjacency = make_adjacency<Dim>(
        executor_, corners_of, list_elements<Dim>(executor_, corners_of, mesh_.vertex_count()));
    mesh_.first_around = std::move(adjacency.first_around);
    mesh_.around = std::move(adjacency.around);
    mesh_.neighbour_of = std::move(adjacency.neighbour_of);
    parallel_for(executor_, mesh_.element_count(), [&](std::size_t e) {
      std::ranges::replace(mesh_.neighbour_of[e], crowded, none);
    });
  }

  void describe_vertices() {
    mesh_.share_of.resize(mesh_.vertex_count());
    mesh_.on_boundary.resize(mesh_.vertex_count());
    parallel_for(executor_, mesh_.vertex_count(), [&](std::size_t v) {
      const auto vertex = static_cast<VertexId>(v);
      double volume = 0;
      for (const ElementId element : mesh_.elements_of(vertex)) {
        volume += mesh_.volume_of[element];
        for (std::size_t i = 0; i <= Dim; ++i)
          if (mesh_.corners_of[element][i] != vertex && mesh_.neighbour_of[element][i] == none)
            mesh_.on_boundary[v] = 1;
      }
      mesh_.share_of[v] = volume / (Dim + 1);
    });
  }

  const Executor& executor_;
  const AnyMesh& any_;
  FixedMesh<Dim, Space> mesh_;
};

}  // namespace

template <int Dim, int Space>
FixedMesh<Dim, Space> make_fixed_mesh(const Executor& executor, const AnyMesh& mesh) {
  return FixedMeshMaker<Dim, Space>(executor, mesh).make();
}

template <int Dim>
std::array<Vector<Dim>, Dim + 1> hat_gradients(const std::array<Vector<Dim>, Dim + 1>& points) {
  std::array<Vector<Dim>, Dim + 1> gradient;
  const double scale = -1 / plain_determinant(points);
  for (std::size_t i = 0; i <= Dim; ++i) {
    std::array<Vector<Dim>, Dim> facet;
    for (std::size_t k = 0; k < Dim; ++k)
      facet[k] = points[static_cast<std::size_t>(Simplex<Dim>::facet[i][k])];
    gradient[i] = scale * facet_normal(facet);
  }
  return gradient;
}

template <int Dim>
double integral(const Executor& executor, const FixedMesh<Dim>& mesh,
                std::span<const double> value_of) {
  expect_at_each_vertex("value_of: expected a value", mesh.vertex_count(), value_of.size());
  return runtime::parallel_reduce(
      executor, mesh.vertex_count(), 0.0,
      [&](std::size_t v) { return mesh.share_of[v] * value_of[v]; }, std::plus<>());
}

template FixedMesh<2> make_fixed_mesh(const Executor&, const AnyMesh&);
template FixedMesh<2, 3> make_fixed_mesh(const Executor&, const AnyMesh&);
template FixedMesh<3> make_fixed_mesh(const Executor&, const AnyMesh&);
template std::array<Vector<2>, 3> hat_gradients<2>(const std::array<Vector<2>, 3>&);
template std::array<Vector<3>, 4> hat_gradients<3>(const std::array<Vector<3>, 4>&);
template double integral(const Executor&, const FixedMesh<2>&, std::span<const double>);
template double integral(const Executor&, const FixedMesh<3>&, std::span<const double>);

}  // namespace ductile::meshadapt
