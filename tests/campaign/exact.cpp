#include "exact.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

namespace ductile::campaign {
namespace {

using Rational = boost::multiprecision::cpp_rational;

template <class T>
T determinant(const std::array<std::array<T, 3>, 3>& m) {
  const T a = m[1][1] * m[2][2] - m[1][2] * m[2][1];
  const T b = m[1][0] * m[2][2] - m[1][2] * m[2][0];
  const T c = m[1][0] * m[2][1] - m[1][1] * m[2][0];
  return m[0][0] * a - m[0][1] * b + m[0][2] * c;
}

/// The determinant with all terms taken positive; rounding errors are proportional to it.
double permanent(const std::array<std::array<double, 3>, 3>& m) {
  const auto size = [&](int i, int j) {
    return std::abs(m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]);
  };
  return size(0, 0) * (size(1, 1) * size(2, 2) + size(1, 2) * size(2, 1)) +
         size(0, 1) * (size(1, 0) * size(2, 2) + size(1, 2) * size(2, 0)) +
         size(0, 2) * (size(1, 0) * size(2, 1) + size(1, 1) * size(2, 0));
}

/// Rows are b - a, c - a, d - a.
template <class T>
std::array<std::array<T, 3>, 3> rows(const std::array<const Point*, 4>& points) {
  std::array<std::array<T, 3>, 3> m;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = T((*points[i + 1])[j]) - T((*points[0])[j]);
  return m;
}

int sign(const std::array<const Point*, 4>& points) {
  const auto m = rows<double>(points);
  const double value = determinant(m);
  const double terms = permanent(m);
  // About 20 roundings of 1.1e-16 each, if no product leaves the range of normal numbers.
  if (std::isfinite(terms) && terms > 1e-280 && std::abs(value) > 1e-14 * terms)
    return value > 0 ? 1 : -1;
  return determinant(rows<Rational>(points)).sign();
}

}  // namespace

int orientation(const Point& a, const Point& b, const Point& c) {
  // A third direction out of the plane makes the area a volume. It is as long as the others, so
  // that doubles decide at every scale.
  const double up = std::max(
      {std::abs(b[0] - a[0]), std::abs(b[1] - a[1]), std::abs(c[0] - a[0]), std::abs(c[1] - a[1])});
  const Point flat_a = {a[0], a[1], 0}, flat_b = {b[0], b[1], 0}, flat_c = {c[0], c[1], 0};
  const Point above = {a[0], a[1], up > 0 ? up : 1};
  return sign({&flat_a, &flat_b, &flat_c, &above});
}

int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  return sign({&a, &b, &c, &d});
}

int orientation(const Mesh& mesh, const Cell& element) {
  const auto at = [&](std::size_t i) -> const Point& {
    return mesh.points[static_cast<std::size_t>(element[i])];
  };
  return mesh.dimension == 2 ? orientation(at(0), at(1), at(2))
                             : orientation(at(0), at(1), at(2), at(3));
}

bool is_positive_definite(const double* tensor, int dimension) {
  const Rational xx(tensor[0]), xy(tensor[1]), yy(tensor[2]);
  if (xx.sign() <= 0 || xx * yy <= xy * xy) return false;
  if (dimension == 2) return true;
  const Rational xz(tensor[3]), yz(tensor[4]), zz(tensor[5]);
  return determinant<Rational>({{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}}).sign() > 0;
}

}  // namespace ductile::campaign
