#include "transfer/conservative_transfer.hpp"

#include <algorithm>
#include <limits>

namespace ductile::meshadapt {

using runtime::Executor;
using runtime::parallel_for;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

template <int Dim>
ConservativeTransfer<Dim>::ConservativeTransfer(const Executor& executor, const Locator<Dim>& from,
                                                const Components& field, const FixedMesh<Dim>& to,
                                                const JoinParts& join)
    : executor_(executor),
      from_(from),
      field_(field),
      to_(to),
      join_(join),
      mass_(executor, to, field.stride, join),
      moments_(to.element_count() * (Dim + 1) * field.stride),
      seen_(to.element_count() * field.stride, {infinity, -infinity}),
      covered_(to.element_count()) {}

template <int Dim>
std::vector<double> ConservativeTransfer<Dim>::run(const ProjectionOptions& options) {
  integrate();
  coverage_ = meshadapt::coverage(executor_, from_.mesh(), to_, covered_);
  const std::vector<double> integrals = gather();
  std::vector<double> lumped(integrals.size());
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    for (std::size_t i = v * stride(); i < (v + 1) * stride(); ++i)
      lumped[i] = to_.share_of[v] > 0 ? integrals[i] / to_.share_of[v] : 0;
  });
  return blend(lumped, mass_.solve(integrals, lumped), options.keep_bounds);
}

// ---- Integrals over the supermesh ----

template <int Dim>
void ConservativeTransfer<Dim>::integrate() {
  runtime::PerThread<OverlapFinder<Dim>> finder(executor_);
  walk_in_blocks(executor_, to_.element_count(), [&](std::size_t e, ElementId near) {
    const Place<Dim> centre = from_.find(centroid_of(to_, static_cast<ElementId>(e)), near);
    integrate(e, centre, finder.mine());
    return centre.element;
  });
}

template <int Dim>
void ConservativeTransfer<Dim>::integrate(std::size_t element, const Place<Dim>& centre,
                                          OverlapFinder<Dim>& finder) {
  const auto& old = from_.mesh();
  const auto add = [&](ElementId other, const Overlap<Dim>& overlap) {
    for (std::size_t j = 0; j <= Dim; ++j) {
      const double* const value = &field_.values[old.corners_of[other][j] * stride()];
      widen(element, value);
      for (std::size_t i = 0; i <= Dim; ++i)
        for (std::size_t k = 0; k < stride(); ++k)
          moments_[(element * (Dim + 1) + i) * stride() + k] += overlap.product[i][j] * value[k];
    }
  };
  const Cell<Dim> cell{to_.points(static_cast<ElementId>(element)), to_.volume_of[element]};
  covered_[element] = finder.visit(from_, cell, centre, add);
  if (covered_[element] < 1 - least_share) fill(element, centre, finder);
}

/// Uses the interpolated field where no old element covers the new one.
template <int Dim>
void ConservativeTransfer<Dim>::fill(std::size_t element, const Place<Dim>& centre,
                                     OverlapFinder<Dim>& finder) {
  const auto mass = mass_outside(element, centre, finder);
  std::vector<double> value(stride());
  for (std::size_t j = 0; j <= Dim; ++j) {
    const Vector<Dim>& corner = to_.position_of[to_.corners_of[element][j]];
    evaluate(from_.mesh(), field_, from_.find(corner, none), value.data());
    widen(element, value.data());
    for (std::size_t i = 0; i <= Dim; ++i)
      for (std::size_t k = 0; k < stride(); ++k)
        moments_[(element * (Dim + 1) + i) * stride() + k] += mass[i][j] * value[k];
  }
}

/// The mass matrix of the uncovered part of a new element: the whole minus the covered part, where
/// the new hat functions are linear in each old element.
template <int Dim>
auto ConservativeTransfer<Dim>::mass_outside(std::size_t element, const Place<Dim>& centre,
                                             OverlapFinder<Dim>& finder) const -> Square {
  const auto corner = to_.points(static_cast<ElementId>(element));
  Square mass;
  for (std::size_t i = 0; i <= Dim; ++i)
    for (std::size_t j = 0; j <= Dim; ++j) mass[i][j] = mass_.between(element) * (i == j ? 2 : 1);
  const auto subtract = [&](ElementId other, const Overlap<Dim>& overlap) {
    const auto old_corner = from_.mesh().points(other);
    for (std::size_t l = 0; l <= Dim; ++l) {
      const Weights<Dim> hat = barycentric<Dim>(corner, old_corner[l]);
      for (std::size_t i = 0; i <= Dim; ++i)
        for (std::size_t j = 0; j <= Dim; ++j) mass[i][j] -= overlap.product[i][l] * hat[j];
    }
  };
  finder.visit(from_, {corner, to_.volume_of[element]}, centre, subtract);
  for (auto& row : mass)
    for (double& product : row) product = std::max(product, 0.0);  // removes rounding errors
  return mass;
}

template <int Dim>
void ConservativeTransfer<Dim>::widen(std::size_t element, const double* values) {
  for (std::size_t k = 0; k < stride(); ++k) {
    Range& range = seen_[element * stride() + k];
    range = {std::min(range.low, values[k]), std::max(range.high, values[k])};
  }
}

template <int Dim>
std::vector<double> ConservativeTransfer<Dim>::gather() const {
  std::vector<double> result(to_.vertex_count() * stride());
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    for (const ElementId e : to_.elements_of(static_cast<VertexId>(v))) {
      const auto i =
          static_cast<std::size_t>(corner_of(to_.corners_of[e], static_cast<VertexId>(v)));
      for (std::size_t k = 0; k < stride(); ++k)
        result[v * stride() + k] += moments_[(e * (Dim + 1) + i) * stride() + k];
    }
  });
  if (join_) join_(result, stride(), Joining::sum);
  return result;
}

// ---- From the lumped to the closest projection ----

/// The range of old values that each new vertex may take.
template <int Dim>
auto ConservativeTransfer<Dim>::ranges() const -> std::vector<Range> {
  std::vector<Range> range_of(to_.vertex_count() * stride(), {infinity, -infinity});
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    for (const ElementId e : to_.elements_of(static_cast<VertexId>(v)))
      for (std::size_t k = 0; k < stride(); ++k) {
        Range& range = range_of[v * stride() + k];
        const Range& seen = seen_[e * stride() + k];
        range = {std::min(range.low, seen.low), std::max(range.high, seen.high)};
      }
  });
  if (join_) join_ranges(range_of, Joining::least);
  return range_of;
}

/// Combines ranges over all parts: lowest and highest, or sums of both.
template <int Dim>
void ConservativeTransfer<Dim>::join_ranges(std::vector<Range>& range_of, Joining how) const {
  const double sign = how == Joining::least ? -1 : 1;
  std::vector<double> values(2 * range_of.size());
  parallel_for(executor_, range_of.size(), [&](std::size_t i) {
    values[2 * i] = range_of[i].low;
    values[2 * i + 1] = sign * range_of[i].high;
  });
  join_(values, 2 * stride(), how);
  parallel_for(executor_, range_of.size(), [&](std::size_t i) {
    range_of[i] = {values[2 * i], sign * values[2 * i + 1]};
  });
}

/// The shares of the flow out of and into a vertex that keep it in its range: Zalesak's ratios, as
/// {outflow, inflow}.
template <int Dim>
auto ConservativeTransfer<Dim>::permitted_shares(const std::vector<double>& lumped,
                                                 const std::vector<double>& closest,
                                                 const std::vector<Range>& range_of) const
    -> std::vector<Range> {
  std::vector<Range> flow_of(lumped.size());
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    for (const ElementId e : to_.elements_of(static_cast<VertexId>(v)))
      mass_.excess(e, closest, [&](std::size_t i, std::size_t k, double amount) {
        if (to_.corners_of[e][i] != v) return;
        Range& flow = flow_of[v * stride() + k];
        (amount < 0 ? flow.low : flow.high) += amount;
      });
  });
  if (join_) join_ranges(flow_of, Joining::sum);
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    for (std::size_t i = v * stride(); i < (v + 1) * stride(); ++i) {
      const double down = std::min(0.0, to_.share_of[v] * (range_of[i].low - lumped[i]));
      const double up = std::max(0.0, to_.share_of[v] * (range_of[i].high - lumped[i]));
      flow_of[i] = {flow_of[i].low < down ? down / flow_of[i].low : 1,
                    flow_of[i].high > up ? up / flow_of[i].high : 1};
    }
  });
  return flow_of;
}

template <int Dim>
std::vector<double> ConservativeTransfer<Dim>::blend(const std::vector<double>& lumped,
                                                     const std::vector<double>& closest,
                                                     bool keep_bounds) const {
  std::vector<Range> range_of, permitted_of;
  if (keep_bounds) {
    range_of = ranges();
    permitted_of = permitted_shares(lumped, closest, range_of);
  }
  std::vector<double> share_of(to_.element_count() * stride(), 1.0);
  if (keep_bounds)
    parallel_for(executor_, to_.element_count(), [&](std::size_t e) {
      mass_.excess(e, closest, [&](std::size_t i, std::size_t k, double amount) {
        const Range& permitted = permitted_of[to_.corners_of[e][i] * stride() + k];
        double& share = share_of[e * stride() + k];
        share = std::min(share, amount < 0 ? permitted.low : permitted.high);
      });
    });
  std::vector<double> result = join_ ? std::vector<double>(lumped.size()) : lumped;
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    for (const ElementId e : to_.elements_of(static_cast<VertexId>(v)))
      mass_.excess(e, closest, [&](std::size_t i, std::size_t k, double amount) {
        if (to_.corners_of[e][i] == v)
          result[v * stride() + k] += share_of[e * stride() + k] * amount / to_.share_of[v];
      });
  });
  if (join_) {
    join_(result, stride(), Joining::sum);
    parallel_for(executor_, result.size(), [&](std::size_t i) { result[i] += lumped[i]; });
  }
  parallel_for(executor_, to_.vertex_count(), [&](std::size_t v) {
    if (!keep_bounds || !(to_.share_of[v] > 0)) return;
    for (std::size_t i = v * stride(); i < (v + 1) * stride(); ++i)  // removes rounding errors
      result[i] = std::clamp(result[i], range_of[i].low, range_of[i].high);
  });
  return result;
}

template class ConservativeTransfer<2>;
template class ConservativeTransfer<3>;

}  // namespace ductile::meshadapt
