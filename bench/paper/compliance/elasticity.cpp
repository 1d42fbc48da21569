#include "elasticity.hpp"

#include <cmath>

#include "cantilever.hpp"
#include "ductile/runtime/parallel_for.hpp"

namespace ductile::paper {

using meshadapt::AnyMesh;
using meshadapt::ElementId;
using meshadapt::Facet;
using meshadapt::FixedMesh;
using meshadapt::Vector;
using meshadapt::VertexId;

template <int Dim>
Elasticity<Dim>::Elasticity(const runtime::Executor& executor, const AnyMesh& any,
                            const FixedMesh<Dim>& mesh, double poisson)
    : executor_(executor),
      mesh_(mesh),
      lambda_(Dim == 2 ? poisson / (1 - poisson * poisson)
                       : poisson / ((1 + poisson) * (1 - 2 * poisson))),
      mu_(0.5 / (1 + poisson)) {
  number_unknowns(any);
  load(any);
  find_pattern();
}

template <int Dim>
void Elasticity<Dim>::number_unknowns(const AnyMesh& any) {
  first_unknown_of_.assign(mesh_.vertex_count(), 0);
  for (const Facet<Dim>& facet : facets_with<Dim>(any, held_reference))
    for (const VertexId v : facet) first_unknown_of_[v] = -1;
  for (int& first : first_unknown_of_)
    if (first == 0) {
      first = unknown_count_;
      unknown_count_ += Dim;
    }
}

/// The traction is constant over the pulled facets and has a total of 1.
template <int Dim>
void Elasticity<Dim>::load(const AnyMesh& any) {
  force_ = Values::Zero(unknown_count_);
  const std::vector<Facet<Dim>> facets = facets_with<Dim>(any, pulled_reference);
  double total = 0;
  for (const Facet<Dim>& facet : facets) {
    std::array<Vector<Dim>, Dim> points;
    for (std::size_t k = 0; k < Dim; ++k) points[k] = mesh_.position_of[facet[k]];
    const double share = norm(meshadapt::facet_normal(points)) / Dim;
    for (const VertexId v : facet) force_[unknown(v, 1)] -= share;
    total += share * Dim;
  }
  force_ /= total;
}

template <int Dim>
void Elasticity<Dim>::find_pattern() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(mesh_.element_count() * unknowns * (unknowns + 1) / 2);
  for (const auto& corners : mesh_.corners_of)
    for (int a = 0; a < unknowns; ++a)
      for (int b = 0; b < unknowns; ++b) {
        const int row = unknown(corners[static_cast<std::size_t>(a / Dim)], a % Dim);
        const int column = unknown(corners[static_cast<std::size_t>(b / Dim)], b % Dim);
        if (column >= 0 && row >= column) entries.emplace_back(row, column, 0.0);
      }
  matrix_.resize(unknown_count_, unknown_count_);
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

template <int Dim>
void Elasticity<Dim>::assemble(const std::vector<double>& stiffness_of) {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  for (ElementId e = 0; e < mesh_.element_count(); ++e) {
    const auto gradient = meshadapt::hat_gradients<Dim>(mesh_.points(e));
    const double scale = mesh_.volume_of[e] * stiffness_of[e];
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t b = 0; b < nodes; ++b) {
        const double both = mu_ * dot(gradient[a], gradient[b]);
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) {
            const int row = unknown(mesh_.corners_of[e][a], i);
            const int column = unknown(mesh_.corners_of[e][b], j);
            if (column < 0 || row < column) continue;
            matrix_.coeffRef(row, column) +=
                scale * (lambda_ * gradient[a][i] * gradient[b][j] +
                         mu_ * gradient[a][j] * gradient[b][i] + (i == j ? both : 0));
          }
      }
  }
}

template <int Dim>
typename Elasticity<Dim>::Solution Elasticity<Dim>::solve(const std::vector<double>& stiffness_of,
                                                          const std::vector<Vector<Dim>>& guess) {
  assemble(stiffness_of);
  solver_.factorise(matrix_);
  Values start = Values::Zero(unknown_count_);
  for (VertexId v = 0; v < guess.size(); ++v)
    for (int i = 0; i < Dim && unknown(v, i) >= 0; ++i) start[unknown(v, i)] = guess[v][i];
  const Values values = solver_.solve(force_, start);
  Solution solution{force_.dot(values), std::vector<Vector<Dim>>(mesh_.vertex_count())};
  for (VertexId v = 0; v < mesh_.vertex_count(); ++v)
    for (int i = 0; i < Dim && unknown(v, i) >= 0; ++i)
      solution.displacement_of[v][i] = values[unknown(v, i)];
  return solution;
}

template <int Dim>
std::vector<double> Elasticity<Dim>::unit_energy(
    const std::vector<Vector<Dim>>& displacement_of) const {
  std::vector<double> energy_of(mesh_.element_count());
  runtime::parallel_for(executor_, mesh_.element_count(), [&](std::size_t e) {
    const auto gradient = meshadapt::hat_gradients<Dim>(mesh_.points(static_cast<ElementId>(e)));
    double trace = 0, squares = 0;
    std::array<Vector<Dim>, Dim> slope{};  // [component][axis]
    for (std::size_t a = 0; a < nodes; ++a)
      for (int i = 0; i < Dim; ++i)
        slope[static_cast<std::size_t>(i)] +=
            displacement_of[mesh_.corners_of[e][a]][i] * gradient[a];
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) {
        const double strain =
            0.5 * (slope[static_cast<std::size_t>(i)][j] + slope[static_cast<std::size_t>(j)][i]);
        squares += strain * strain;
        if (i == j) trace += strain;
      }
    energy_of[e] = lambda_ * trace * trace + 2 * mu_ * squares;
  });
  return energy_of;
}

template class Elasticity<2>;
template class Elasticity<3>;

}  // namespace ductile::paper
