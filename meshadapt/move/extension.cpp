#include "move/extension.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <span>

#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/worklist.hpp"

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

template <int Dim>
Extension<Dim>::Extension(const Executor& executor, const FixedMesh<Dim>& mesh,
                          const Field& position_of, const std::vector<std::uint8_t>& is_free,
                          const Walls<Dim>& walls)
    : executor_(executor), walls_(walls) {
  for (std::size_t v = 0; v < is_free.size(); ++v)
    if (is_free[v]) free_.push_back(static_cast<VertexId>(v));
  first_.resize(free_.size() + 1);
  diagonal_.resize(free_.size());
  runtime::PerThread<std::vector<Entry>> rows(executor);
  entry_ =
      runtime::parallel_collect<Entry>(executor, free_.size(), [&](std::size_t i, auto&& append) {
        std::vector<Entry>& row = rows.mine();
        add_row(mesh, position_of, free_[i], row);
        first_[i] = row.size();
        for (const Entry& entry : row) {
          append(entry);
          diagonal_[i] -= entry.weight;
        }
      });
  runtime::exclusive_scan(executor, std::span(first_));
}

/// Sums over the elements around a vertex of gradient times gradient: the weights of linear
/// elements, each divided by its volume. Sorted by neighbour.
template <int Dim>
void Extension<Dim>::add_row(const FixedMesh<Dim>& mesh, const Field& position_of, VertexId v,
                             std::vector<Entry>& row) const {
  row.clear();
  for (const ElementId e : mesh.elements_of(v)) {
    std::array<Vector<Dim>, Dim + 1> points;
    for (std::size_t i = 0; i <= Dim; ++i) points[i] = position_of[mesh.corners_of[e][i]];
    const auto gradient = hat_gradients<Dim>(points);
    const auto own = static_cast<std::size_t>(corner_of(mesh.corners_of[e], v));
    for (std::size_t i = 0; i <= Dim; ++i)
      if (i != own) row.push_back({mesh.corners_of[e][i], dot(gradient[own], gradient[i])});
  }
  std::ranges::stable_sort(row, {}, &Entry::vertex);
  std::size_t count = 0;
  for (const Entry& entry : row)
    if (count > 0 && row[count - 1].vertex == entry.vertex)
      row[count - 1].weight += entry.weight;
    else
      row[count++] = entry;
  row.resize(count);
}

template <int Dim>
Vector<Dim> Extension<Dim>::product(std::size_t i, const Field& x) const {
  Vector<Dim> result = diagonal_[i] * x[free_[i]];
  for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
    result += entry_[k].weight * x[entry_[k].vertex];
  return walls_.allowed(free_[i], result);
}

template <int Dim>
double Extension<Dim>::sum(auto&& term) const {
  return runtime::parallel_reduce(executor_, free_.size(), 0.0, term, std::plus<>());
}

template <int Dim>
void Extension<Dim>::solve(Field& x) const {
  constexpr double tolerance = 1e-3;  // any displacements will do that keep elements good
  constexpr int most_iterations = 1000;
  if (free_.empty()) return;
  Field rest(free_.size()), step(free_.size()), direction(x.size());
  parallel_for(executor_, free_.size(),
               [&](std::size_t i) { x[free_[i]] = walls_.allowed(free_[i], x[free_[i]]); });
  // What is given at the others decides how small is small.
  const double given = sum([&](std::size_t i) {
    const Vector<Dim> all = product(i, x),
                      own = walls_.allowed(free_[i], diagonal_[i] * x[free_[i]]);
    return std::max(dot(all, all), dot(own, own)) / diagonal_[i];
  });
  parallel_for(executor_, free_.size(), [&](std::size_t i) {
    rest[i] = -1 * product(i, x);
    direction[free_[i]] = 1 / diagonal_[i] * rest[i];
  });
  double size = sum([&](std::size_t i) { return dot(rest[i], rest[i]) / diagonal_[i]; });
  for (int k = 0; k < most_iterations && size > tolerance * tolerance * given; ++k) {
    parallel_for(executor_, free_.size(), [&](std::size_t i) { step[i] = product(i, direction); });
    const double energy = sum([&](std::size_t i) { return dot(step[i], direction[free_[i]]); });
    if (!(energy > 0)) break;
    const double length = size / energy;
    parallel_for(executor_, free_.size(), [&](std::size_t i) {
      x[free_[i]] += length * direction[free_[i]];
      rest[i] -= length * step[i];
    });
    const double next = sum([&](std::size_t i) { return dot(rest[i], rest[i]) / diagonal_[i]; });
    parallel_for(executor_, free_.size(), [&](std::size_t i) {
      direction[free_[i]] = 1 / diagonal_[i] * rest[i] + next / size * direction[free_[i]];
    });
    size = next;
  }
}

template class Extension<2>;
template class Extension<3>;

}  // namespace ductile::meshadapt
