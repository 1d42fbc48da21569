#include "metric/interpolation.hpp"

#include <limits>
#include <span>

#include "core/determinant.hpp"

namespace ductile::meshadapt {
namespace {

// The mean of the n-th derivative of f over a simplex of dimension n, of an argument that is linear
// in it, is n! times the divided difference of f at the arguments of the corners (Hermite and
// Genocchi). All of these take arguments that rise.

double factorial(std::size_t n) { return n < 2 ? 1 : static_cast<double>(n) * factorial(n - 1); }

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double divided_difference_of_exp(std::span<const double> values) {
  const std::size_t order = values.size() - 1;
  const double spread = values.back() - values.front();
  constexpr double close = 0.25;  // where the first terms of the series are right to 0.1 %
  if (spread >= close)
    return (divided_difference_of_exp(values.subspan(1)) -
            divided_difference_of_exp(values.first(order))) /
           spread;
  double squares = 0;
  const double mean = mean_of(values);
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto terms = static_cast<double>(2 * (order + 1) * (order + 2));
  return std::exp(mean) * (1 + squares / terms) / factorial(order);
}

/// The function whose n-th derivative is 1/x.
double antiderivative_of_inverse(std::size_t n, double x) {
  const double log = std::log(x);
  return n == 0 ? 1 / x : n == 1 ? log : n == 2 ? x * (log - 1) : x * x * (log / 2 - 0.75);
}

double divided_difference_of_antiderivative(std::size_t n, std::span<const double> values) {
  const std::size_t order = values.size() - 1;
  const double spread = values.back() - values.front();
  constexpr double close = 0.01;  // relatively: the next term of the series is 4e-6
  if (spread >= close * values.back())
    return (divided_difference_of_antiderivative(n, values.subspan(1)) -
            divided_difference_of_antiderivative(n, values.first(order))) /
           spread;
  return antiderivative_of_inverse(n - order, mean_of(values)) / factorial(order);
}

template <int Dim>
double volume_of(const std::array<Vector<Dim>, Dim + 1>& corner) {
  return certain_determinant<Dim>(corner) / factorial(Dim);
}
double volume_of(const std::array<Vector<3>, 3>& corner) {
  return certain_area(corner[0], corner[1], corner[2]) / 2;
}

/// If sizes grow exponentially.
template <int Dim>
double complexity_of_exponential(LogDensities<Dim> log_densities, double volume) {
  std::sort(log_densities.begin(), log_densities.end());
  return volume * factorial(Dim) * divided_difference_of_exp(log_densities);
}

/// If sizes grow linearly, their product is taken to do so, too. That is right for a layer; where
/// more than one size grows, it is more than that.
template <int Dim>
double complexity_of_linear(LogDensities<Dim> log_densities, double volume) {
  std::sort(log_densities.begin(), log_densities.end());
  // The largest product is the unit, and what is no number beside it the least there is.
  std::array<double, Dim + 1> products;
  for (std::size_t i = 0; i <= Dim; ++i)
    products[Dim - i] = std::max(std::exp(log_densities.front() - log_densities[i]),
                                 std::numeric_limits<double>::min());
  return volume * factorial(Dim) * std::exp(log_densities.front()) *
         divided_difference_of_antiderivative(Dim, products);
}

}  // namespace

template <int Dim, int Space>
bool is_steep(const LogDensities<Dim>& log_densities,
              const std::array<Vector<Space>, Dim + 1>& corner) {
  constexpr double many = 30;  // about 70 triangles, 330 tetrahedra
  return differ_much(log_densities) &&
         complexity_of_exponential<Dim>(log_densities, volume_of(corner)) > many;
}

template <int Dim, int Space>
double complexity_of_element(const LogDensities<Dim>& log_densities,
                             const std::array<Vector<Space>, Dim + 1>& corner) {
  const double volume = volume_of(corner);
  return is_steep<Dim>(log_densities, corner)
             ? complexity_of_linear<Dim>(log_densities, volume)
             : complexity_of_exponential<Dim>(log_densities, volume);
}

template bool is_steep<2>(const LogDensities<2>&, const CornerPlaces<2>&);
template bool is_steep<2>(const LogDensities<2>&, const CornerPlaces<2, 3>&);
template bool is_steep<3>(const LogDensities<3>&, const CornerPlaces<3>&);
template double complexity_of_element<2>(const LogDensities<2>&, const CornerPlaces<2>&);
template double complexity_of_element<2>(const LogDensities<2>&, const CornerPlaces<2, 3>&);
template double complexity_of_element<3>(const LogDensities<3>&, const CornerPlaces<3>&);

}  // namespace ductile::meshadapt
