#include "geometry/samples.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/meshadapt/metric.hpp"
#include "ductile/runtime/sort.hpp"
#include "geometry/sheets.hpp"

namespace ductile::meshadapt {

template <int Dim, std::size_t Corners>
void Samples<Dim, Corners>::connect() {
  first_of_.assign(all.size() + 1, 0);
  for (const Facet& facet : facets)
    for (const std::uint32_t s : facet)
      if (s != none) ++first_of_[s + 1];
  for (std::size_t s = 0; s < all.size(); ++s) first_of_[s + 1] += first_of_[s];
  facets_at_.resize(first_of_.back());
  std::vector<std::uint32_t> next(first_of_.begin(), first_of_.end() - 1);
  for (std::uint32_t f = 0; f < facets.size(); ++f)
    for (const std::uint32_t s : facets[f])
      if (s != none) facets_at_[next[s]++] = f;
}

template <int Dim, std::size_t Corners>
std::array<Vector<Dim>, Corners> Samples<Dim, Corners>::points(std::uint32_t facet) const {
  std::array<Vector<Dim>, Corners> p;
  for (std::size_t i = 0; i < Corners; ++i) p[i] = all[facets[facet][i]].position;
  return p;
}

template <int Dim, std::size_t Corners>
double Samples<Dim, Corners>::area(std::uint32_t facet) const {
  const auto p = points(facet);
  if constexpr (Corners == 3) return norm(facet_normal(p)) / 2;
  return norm(p[1] - p[0]);
}

/// Each part grows from its largest facet.
template <int Dim, std::size_t Corners>
std::vector<double> Samples<Dim, Corners>::widths(const runtime::Executor& executor,
                                                  double flat) const {
  using Seed = std::pair<double, std::uint32_t>;
  std::vector<Seed> order;
  for (std::uint32_t f = 0; f < facets.size(); ++f)
    if (facets[f][0] != none) order.emplace_back(-area(f), f);
  runtime::parallel_sort(executor, std::span(order));
  std::vector<double> width_at(all.size());
  std::vector<std::uint8_t> seen(facets.size());
  std::vector<std::uint32_t> part;
  for (const auto& [size, seed] : order) {
    if (seen[seed] != 0) continue;
    grow(seed, flat, seen, part);
    const double width = width_of(part);
    for (const std::uint32_t f : part)
      for (const std::uint32_t s : facets[f]) width_at[s] = std::max(width_at[s], width);
  }
  return width_at;
}

template <int Dim, std::size_t Corners>
void Samples<Dim, Corners>::grow(std::uint32_t seed, double flat, std::vector<std::uint8_t>& seen,
                                 std::vector<std::uint32_t>& part) const {
  const auto corner = points(seed);
  const Vector<Dim> direction = direction_of(corner);
  const auto is_flat = [&](std::uint32_t f) {
    const auto p = points(f);
    return std::all_of(p.begin(), p.end(), [&](const Vector<Dim>& at) {
      const Vector<Dim> d = at - corner[0];
      const double along = dot(d, direction);
      return (Corners == Dim ? std::abs(along) : norm(d - along * direction)) <= flat;
    });
  };
  part.assign(1, seed);
  seen[seed] = 1;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (const std::uint32_t s : facets[part[i]])
      for (const std::uint32_t f : facets_at(s))
        if (seen[f] == 0 && is_flat(f)) {
          seen[f] = 1;
          part.push_back(f);
        }
}

/// From the moments about the centre: across its narrow direction for triangles, that of a long
/// strip, and nearly the height of a triangle.
template <int Dim, std::size_t Corners>
double Samples<Dim, Corners>::width_of(std::span<const std::uint32_t> part) const {
  const Vector<Dim> origin = all[facets[part.front()][0]].position;
  Metric<Dim> moments;
  const auto add = [&](double weight, const Vector<Dim>& v) {
    std::size_t at = 0;
    for (int j = 0; j < Dim; ++j)
      for (int i = 0; i <= j; ++i) moments.m[at++] += weight * v[i] * v[j];
  };
  Vector<Dim> first;
  double sum = 0;
  for (const std::uint32_t f : part) {
    const double size = area(f), share = size / (Corners * (Corners + 1));
    Vector<Dim> centre;
    for (const Vector<Dim>& p : points(f)) {
      centre += p - origin;
      add(share, p - origin);
    }
    add(share, centre);
    first += (size / Corners) * centre;
    sum += size;
  }
  if (!(sum > 0)) return 0;
  add(-1 / sum, first);
  auto spread = principal_axes(moments).value;
  std::sort(spread.begin(), spread.end());
  const double narrow = spread[Dim - Corners + 1] / sum;
  return std::sqrt(std::max(0.0, narrow) * (Corners == 2 ? 12 : 18));
}

template struct Samples<2, 2>;
template struct Samples<3, 2>;
template struct Samples<3, 3>;

}  // namespace ductile::meshadapt
