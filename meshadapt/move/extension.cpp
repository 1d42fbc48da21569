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
  std::vector<std::uint32_t> place_of(is_free.size(), none);
  for (std::size_t v = 0; v < is_free.size(); ++v) {
    if (!is_free[v]) continue;
    place_of[v] = static_cast<std::uint32_t>(free_.size());
    free_.push_back(static_cast<VertexId>(v));
  }
  first_.resize(free_.size() + 1);
  first_given_.resize(free_.size() + 1);
  diagonal_.resize(free_.size());
  runtime::PerThread<std::vector<Entry>> rows(executor);
  const auto collect = [&](bool free, std::vector<std::size_t>& first) {
    auto entries =
        runtime::parallel_collect<Entry>(executor, free_.size(), [&](std::size_t i, auto&& append) {
          std::vector<Entry>& row = rows.mine();
          add_row(mesh, position_of, free_[i], row);
          for (const auto& [vertex, weight] : row) {
            if (free) diagonal_[i] -= weight;
            if ((place_of[vertex] != none) != free) continue;
            append(Entry{free ? place_of[vertex] : vertex, weight});
            ++first[i];
          }
        });
    runtime::exclusive_scan(executor, std::span(first));
    return entries;
  };
  free_entry_ = collect(true, first_);
  given_entry_ = collect(false, first_given_);
  for (const double diagonal : diagonal_) inverse_.push_back(1 / diagonal);
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
  std::ranges::stable_sort(row, {}, &Entry::place);
  std::size_t count = 0;
  for (const Entry& entry : row)
    if (count > 0 && row[count - 1].place == entry.place)
      row[count - 1].weight += entry.weight;
    else
      row[count++] = entry;
  row.resize(count);
}

template <int Dim>
auto Extension<Dim>::demands(const Field& displacement_of) const -> Field {
  Field demand(free_.size());
  parallel_for(executor_, free_.size(), [&](std::size_t i) {
    Vector<Dim> sum;
    for (std::size_t k = first_given_[i]; k < first_given_[i + 1]; ++k)
      sum -= given_entry_[k].weight * displacement_of[given_entry_[k].place];
    demand[i] = walls_.allowed(free_[i], sum);
  });
  return demand;
}

template <int Dim>
Vector<Dim> Extension<Dim>::product(std::size_t i, const Field& x) const {
  Vector<Dim> result = diagonal_[i] * x[i];
  for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
    result += free_entry_[k].weight * x[free_entry_[k].place];
  return walls_.allowed(free_[i], result);
}

template <int Dim>
double Extension<Dim>::weighted(const Field& a, const Field& b) const {
  return runtime::parallel_reduce(
      executor_, a.size(), 0.0, [&](std::size_t i) { return dot(a[i], b[i]) * inverse_[i]; },
      std::plus<>());
}

template <int Dim>
double Extension<Dim>::iterate(Iterate& now, double size) const {
  const double energy = runtime::parallel_reduce(
      executor_, free_.size(), 0.0,
      [&](std::size_t i) {
        now.product[i] = product(i, now.direction);
        return dot(now.product[i], now.direction[i]);
      },
      std::plus<>());
  if (!(energy > 0)) return 0;
  const double length = size / energy;
  const double next = runtime::parallel_reduce(
      executor_, free_.size(), 0.0,
      [&](std::size_t i) {
        now.value[i] += length * now.direction[i];
        now.rest[i] -= length * now.product[i];
        return dot(now.rest[i], now.rest[i]) * inverse_[i];
      },
      std::plus<>());
  parallel_for(executor_, free_.size(), [&](std::size_t i) {
    now.direction[i] = inverse_[i] * now.rest[i] + next / size * now.direction[i];
  });
  return next;
}

template <int Dim>
void Extension<Dim>::solve(Field& displacement_of) const {
  constexpr double tolerance = 1e-3;  // any displacements will do that keep elements good
  constexpr int most_iterations = 1000;
  const std::size_t count = free_.size();
  const Field demand = demands(displacement_of);
  Iterate now{Field(count), Field(count), Field(count), Field(count)};
  parallel_for(executor_, count, [&](std::size_t i) {
    now.value[i] = walls_.allowed(free_[i], displacement_of[free_[i]]);
  });
  parallel_for(executor_, count, [&](std::size_t i) {
    now.rest[i] = demand[i] - product(i, now.value);
    now.direction[i] = inverse_[i] * now.rest[i];
  });
  const double least = tolerance * tolerance * weighted(demand, demand);
  double size = weighted(now.rest, now.rest);
  for (int k = 0; k < most_iterations && size > least; ++k) size = iterate(now, size);
  parallel_for(executor_, count, [&](std::size_t i) { displacement_of[free_[i]] = now.value[i]; });
}

template class Extension<2>;
template class Extension<3>;

}  // namespace ductile::meshadapt
