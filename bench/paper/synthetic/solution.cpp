#include "solution.hpp"

#include <array>
#include <cmath>

#include "cases/psi.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::paper {

using meshadapt::AnyField;
using meshadapt::AnyMesh;
using meshadapt::ElementId;
using meshadapt::Vector;

namespace {

template <int Dim>
using Weights = std::array<double, Dim + 1>;

/// Barycentric coordinates of points spread evenly over an element: a lattice of `order` steps,
/// moved inside.
template <int Dim>
std::vector<Weights<Dim>> points_inside(int order) {
  std::vector<Weights<Dim>> points;
  std::array<int, Dim + 1> step{};
  const auto fill = [&](auto& again, std::size_t corner, int left) -> void {
    if (corner == Dim) {
      step[corner] = left;
      Weights<Dim>& point = points.emplace_back();
      for (std::size_t i = 0; i <= Dim; ++i) point[i] = (step[i] + 1.0 / (Dim + 1)) / (order + 1);
      return;
    }
    for (step[corner] = 0; step[corner] <= left; ++step[corner])
      again(again, corner + 1, left - step[corner]);
  };
  fill(fill, 0, order);
  return points;
}

InterpolationError sum(InterpolationError a, const InterpolationError& b) {
  a.everywhere += b.everywhere;
  a.beside_jump += b.beside_jump;
  return a;
}

}  // namespace

AnyField sampled_solution(const runtime::Executor& executor, const AnyMesh& mesh, double phase) {
  std::vector<double> value_of(mesh.vertex_count());
  const auto stride = static_cast<std::size_t>(mesh.dimension);
  runtime::parallel_for(executor, value_of.size(), [&](std::size_t v) {
    const double* const place = &mesh.coordinates[stride * v];
    value_of[v] = bench::psi(place[0], place[1], phase);
  });
  return meshadapt::scalar_field(mesh.dimension, std::move(value_of), "solution");
}

template <int Dim>
InterpolationError interpolation_error(const runtime::Executor& executor, const AnyMesh& any,
                                       double phase) {
  const auto mesh = meshadapt::make_fixed_mesh<Dim>(executor, any);
  const AnyField at_vertices = sampled_solution(executor, any, phase);
  const std::vector<Weights<Dim>> points = points_inside<Dim>(Dim == 2 ? 9 : 5);
  const auto error_in = [&](std::size_t element) {
    const auto corner = mesh.points(static_cast<ElementId>(element));
    double mean = 0, mean_square = 0;
    std::size_t behind = 0;
    for (const Weights<Dim>& weight : points) {
      Vector<Dim> place;
      double interpolated = 0;
      for (std::size_t i = 0; i <= Dim; ++i) {
        place += weight[i] * corner[i];
        interpolated += weight[i] * at_vertices.values[mesh.corners_of[element][i]];
      }
      const double difference = interpolated - bench::psi(place[0], place[1], phase);
      mean += std::abs(difference);
      mean_square += difference * difference;
      behind += bench::psi_jump_level(place[0], place[1], phase) < 0 ? 1 : 0;
    }
    for (const Vector<Dim>& place : corner)
      behind += bench::psi_jump_level(place[0], place[1], phase) < 0 ? 1 : 0;
    const bool cut = behind > 0 && behind < points.size() + corner.size();
    const double share = mesh.volume_of[element] / static_cast<double>(points.size());
    return InterpolationError{share * mean, cut ? 0 : share * mean_square};
  };
  InterpolationError error =
      runtime::parallel_reduce(executor, mesh.element_count(), InterpolationError{}, error_in, sum);
  error.beside_jump = std::sqrt(error.beside_jump);
  return error;
}

template InterpolationError interpolation_error<2>(const runtime::Executor&, const AnyMesh&,
                                                   double);
template InterpolationError interpolation_error<3>(const runtime::Executor&, const AnyMesh&,
                                                   double);

}  // namespace ductile::paper
