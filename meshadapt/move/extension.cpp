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

namespace {

/// The preconditioner ignores entries between blocks of so many rows, which threads share.
constexpr std::size_t block_size = 4096;

}  // namespace

template <int Dim>
Extension<Dim>::Extension(const Executor& executor, const FixedMesh<Dim>& mesh,
                          const Field& position_of, const std::vector<std::uint8_t>& is_free,
                          const Walls<Dim>& walls)
    : executor_(executor), walls_(walls), pivot_of_(is_free.size(), 0) {
  for (std::size_t v = 0; v < is_free.size(); ++v)
    if (is_free[v]) free_.push_back(static_cast<VertexId>(v));
  first_.resize(free_.size() + 1);
  diagonal_.resize(free_.size());
  runtime::PerThread<std::vector<Entry>> rows(executor);
  entry_ =
      runtime::parallel_collect<Entry>(executor, free_.size(), [&](std::size_t i, auto&& append) {
        std::vector<Entry>& row = rows.mine();
        add_row(mesh, position_of, free_[i], row);
        for (const Entry& entry : row) {
          diagonal_[i] -= entry.weight;
          append(entry);
        }
        first_[i] = row.size();
      });
  runtime::exclusive_scan(executor, std::span(first_));
  factorise();
}

/// Sums over the elements around a vertex of gradient times gradient: the weights of linear
/// elements, each divided by its volume.
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

/// The pivots of an incomplete Cholesky factorisation that keeps the matrix off the diagonal.
template <int Dim>
void Extension<Dim>::factorise() {
  constexpr double least = 0.05;  // times the diagonal, because obtuse angles lessen pivots
  runtime::parallel_for_blocks(
      executor_, free_.size(), block_size, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          double pivot = diagonal_[i];
          for (std::size_t k = first_[i]; k < first_[i + 1] && entry_[k].vertex < free_[i]; ++k)
            if (entry_[k].vertex >= free_[begin])
              pivot -= entry_[k].weight * entry_[k].weight * pivot_of_[entry_[k].vertex];
          pivot_of_[free_[i]] = 1 / std::max(pivot, least * diagonal_[i]);
        }
      });
}

template <int Dim>
void Extension<Dim>::precondition(const Field& rest, Field& result) const {
  runtime::parallel_for_blocks(
      executor_, free_.size(), block_size, [&](std::size_t, std::size_t begin, std::size_t end) {
        const VertexId low = free_[begin], high = free_[end - 1];
        for (std::size_t i = begin; i < end; ++i) {
          Vector<Dim> sum = rest[free_[i]];
          for (std::size_t k = first_[i]; k < first_[i + 1] && entry_[k].vertex < free_[i]; ++k)
            if (entry_[k].vertex >= low) sum -= entry_[k].weight * result[entry_[k].vertex];
          result[free_[i]] = pivot_of_[free_[i]] * sum;
        }
        for (std::size_t i = end; i-- > begin;) {
          Vector<Dim> sum;
          for (std::size_t k = first_[i + 1]; k-- > first_[i] && entry_[k].vertex > free_[i];)
            if (entry_[k].vertex <= high) sum += entry_[k].weight * result[entry_[k].vertex];
          result[free_[i]] -= pivot_of_[free_[i]] * sum;
        }
        for (std::size_t i = begin; i < end; ++i)
          result[free_[i]] = walls_.allowed(free_[i], result[free_[i]]);
      });
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
  return runtime::parallel_reduce(
      executor_, free_.size(), 0.0, [&](std::size_t i) { return term(i, free_[i]); },
      std::plus<>());
}

/// `result` and `direction` stay 0 at vertices that are not free.
template <int Dim>
void Extension<Dim>::solve(Field& displacement_of) const {
  constexpr double tolerance = 2e-2;  // any displacements will do that keep elements good
  constexpr int most_iterations = 1000;
  const std::size_t count = displacement_of.size();
  Field rest(count), result(count), direction(count), image(count);
  parallel_for(executor_, free_.size(), [&](std::size_t i) {
    displacement_of[free_[i]] = walls_.allowed(free_[i], displacement_of[free_[i]]);
  });
  const double given = sum([&](std::size_t i, VertexId v) {
    Vector<Dim> demand;
    for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
      if (pivot_of_[entry_[k].vertex] == 0)
        demand -= entry_[k].weight * displacement_of[entry_[k].vertex];
    demand = walls_.allowed(v, demand);
    return dot(demand, demand) / diagonal_[i];
  });
  const double least = tolerance * tolerance * given;
  double size = sum([&](std::size_t i, VertexId v) {
    rest[v] = -1 * product(i, displacement_of);
    return dot(rest[v], rest[v]) / diagonal_[i];
  });
  double before = 0;
  for (int iteration = 0; iteration < most_iterations && size > least; ++iteration) {
    precondition(rest, result);
    const double now = sum([&](std::size_t, VertexId v) { return dot(rest[v], result[v]); });
    const double energy_before = std::exchange(before, now);
    parallel_for(executor_, free_.size(), [&](std::size_t i) {
      const VertexId v = free_[i];
      direction[v] = result[v] + (iteration == 0 ? 0 : now / energy_before) * direction[v];
    });
    const double energy = sum([&](std::size_t i, VertexId v) {
      image[v] = product(i, direction);
      return dot(image[v], direction[v]);
    });
    if (!(energy > 0)) break;
    size = sum([&](std::size_t i, VertexId v) {
      displacement_of[v] += now / energy * direction[v];
      rest[v] -= now / energy * image[v];
      return dot(rest[v], rest[v]) / diagonal_[i];
    });
  }
}

template class Extension<2>;
template class Extension<3>;

}  // namespace ductile::meshadapt
