#include "core/orientation.hpp"
#include "core/determinant.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

namespace ductile::meshadapt {

namespace {

template <int Dim>
int rational_orientation(const std::array<Vector<Dim>, Dim + 1>& p) {
  using Exact = boost::multiprecision::cpp_rational;
  Exact d[Dim][Dim];
  for (int i = 0; i < Dim; ++i)
    for (int k = 0; k < Dim; ++k)
      d[i][k] = Exact(p[static_cast<std::size_t>(i + 1)][k]) - Exact(p[0][k]);
  const auto minor = [&](int r, int s, int a, int b) -> Exact {
    return d[r][a] * d[s][b] - d[r][b] * d[s][a];
  };
  Exact determinant;
  if constexpr (Dim == 2)
    determinant = minor(0, 1, 0, 1);
  else
    determinant =
        d[0][0] * minor(1, 2, 1, 2) - d[0][1] * minor(1, 2, 0, 2) + d[0][2] * minor(1, 2, 0, 1);
  return determinant.sign();
}

}  // namespace

template <int Dim>
int orientation(const std::array<Vector<Dim>, Dim + 1>& corners) {
  // Below this, products may be denormal, and the error bound of the fast method does not hold.
  constexpr double smallest_trusted = 1e-270;
  const double fast = certain_determinant<Dim>(corners);
  if (std::abs(fast) > smallest_trusted && std::isfinite(fast)) return fast > 0 ? 1 : -1;
  for (const Vector<Dim>& corner : corners)
    for (const double x : corner.x)
      if (!std::isfinite(x)) return 0;
  return rational_orientation<Dim>(corners);
}

template int orientation<2>(const std::array<Vector<2>, 3>&);
template int orientation<3>(const std::array<Vector<3>, 4>&);

}  // namespace ductile::meshadapt
