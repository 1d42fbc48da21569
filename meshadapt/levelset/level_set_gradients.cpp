#include "levelset/level_set_gradients.hpp"

#include <array>
#include <optional>

#include "core/small_system.hpp"
#include "ductile/meshadapt/hessian_metric.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "metric/surroundings.hpp"

namespace ductile::meshadapt {

namespace {

/// Monomials of degree 1 to 3.
template <int Dim>
constexpr std::size_t cubic_terms = Dim == 2 ? 9 : 19;

/// The linear ones first.
template <int Dim>
std::array<double, cubic_terms<Dim>> monomials(const Vector<Dim>& d, double weight) {
  std::array<double, cubic_terms<Dim>> result;
  std::size_t at = 0;
  for (int i = 0; i < Dim; ++i) result[at++] = weight * d[i];
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j <= i; ++j) {
      result[at++] = weight * d[i] * d[j];
      for (int k = 0; k <= j; ++k) result[at++] = weight * d[i] * d[j] * d[k];
    }
  return result;
}

/// The gradient of a cubic through the vertex, with weights of inverse squared distance; nothing if
/// the vertices around do not determine one.
template <int Dim>
std::optional<Vector<Dim>> cubic_gradient(const FixedMesh<Dim>& mesh,
                                          std::span<const double> value_of,
                                          const Surroundings<Dim>& around) {
  constexpr double least_pivot = 1e-3;
  if (around.vertices().size() < cubic_terms<Dim> + Dim) return {};
  const Vector<Dim> centre = mesh.position_of[around.centre()];
  Shape<Dim> shape;
  for (const VertexId v : around.vertices()) shape.add(mesh.position_of[v] - centre);
  shape.factorise();
  SmallSystem<cubic_terms<Dim>> system;
  for (const VertexId v : around.vertices()) {
    const Vector<Dim> d = shape.seen(mesh.position_of[v] - centre);
    const double weight = 1 / dot(d, d);
    system.add(monomials<Dim>(d, weight), {weight * (value_of[v] - value_of[around.centre()])});
  }
  if (!system.solve(least_pivot)) return {};
  Vector<Dim> gradient;
  for (int i = 0; i < Dim; ++i) gradient[i] = system.solution(static_cast<std::size_t>(i));
  return shape.unseen(gradient);
}

}  // namespace

template <int Dim>
std::vector<Vector<Dim>> level_set_gradients(const runtime::Executor& executor,
                                             const FixedMesh<Dim>& mesh,
                                             std::span<const double> value_of,
                                             std::span<const VertexId> at) {
  auto gradients = recover_gradient_at<Dim>(executor, mesh, value_of, at);
  runtime::PerThread<Surroundings<Dim>> buffer(executor);
  runtime::parallel_for(executor, at.size(), [&](std::size_t i) {
    if (mesh.elements_of(at[i]).empty()) return;
    Surroundings<Dim>& around = buffer.mine();
    around.start(mesh, at[i]);
    around.grow(mesh);
    if (const auto better = cubic_gradient<Dim>(mesh, value_of, around)) gradients[i] = *better;
  });
  return gradients;
}

template std::vector<Vector<2>> level_set_gradients(const runtime::Executor&, const FixedMesh<2>&,
                                                    std::span<const double>,
                                                    std::span<const VertexId>);
template std::vector<Vector<3>> level_set_gradients(const runtime::Executor&, const FixedMesh<3>&,
                                                    std::span<const double>,
                                                    std::span<const VertexId>);

}  // namespace ductile::meshadapt
