#include "mesh/prism.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/meshes.hpp"

namespace ductile::meshadapt::prism_test {
namespace {

/// Corners of the parts of a wavy surface over the unit square, or of a curve over an interval,
/// with n parts along an axis.
template <int Dim, std::size_t Corners>
using Parts = std::vector<std::array<Vector<Dim>, Corners>>;

double height(double x, double y) { return 0.1 * std::sin(9 * x) * std::cos(7 * y); }

Parts<2, 2> wavy_line(int n) {
  Parts<2, 2> parts;
  const auto at = [&](int i) { return Vector<2>{{i / double(n), height(i / double(n), 0)}}; };
  for (int i = 0; i < n; ++i) parts.push_back({at(i), at(i + 1)});
  return parts;
}
Parts<3, 2> wavy_thread(int n) {
  Parts<3, 2> parts;
  const auto at = [&](int i) {
    const double x = i / double(n);
    return Vector<3>{{x, height(x, 0), height(x, 1)}};
  };
  for (int i = 0; i < n; ++i) parts.push_back({at(i), at(i + 1)});
  return parts;
}
Parts<3, 3> wavy_sheet(int n) {
  Parts<3, 3> parts;
  const auto at = [&](int i, int j) {
    const double x = i / double(n), y = j / double(n);
    return Vector<3>{{x, y, height(x, y)}};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      parts.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      parts.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return parts;
}

/// A random simplex of height 0 whose first coordinates (all but the last; one for a segment in 3D)
/// are in this range.
template <int Dim, std::size_t Corners>
std::array<Vector<Dim>, Corners> flat_simplex(test::Random& random, double low, double high) {
  std::array<Vector<Dim>, Corners> simplex{};
  for (Vector<Dim>& corner : simplex)
    for (std::size_t i = 0; i + 1 < Corners; ++i)
      corner[static_cast<int>(i)] = test::uniform(random, low, high);
  return simplex;
}

template <int Dim, std::size_t Corners>
void covers_what_is_below(const Parts<Dim, Corners>& parts) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const auto simplex = flat_simplex<Dim, Corners>(random, 0.1, 0.9);
    const Prism<Dim, Corners> prism(simplex);
    typename Prism<Dim, Corners>::Clipping clipping;
    double share = 0;
    for (const auto& part : parts) {
      const auto inside = prism.inside(part, clipping);
      share += prism.share(inside);
      for (const auto& place : inside) {
        const Vector<Dim> below = prism.below(place);
        for (int axis = static_cast<int>(Corners) - 1; axis < Dim; ++axis)
          EXPECT_NEAR(below[axis], 0, 1e-9);
        EXPECT_LE(place.aside(), 0.1 * std::sqrt(Dim - static_cast<double>(Corners) + 1));
        double sum = 0;
        for (const double w : place.weight) {
          EXPECT_GE(w, -1e-9);
          sum += w;
        }
        EXPECT_LE(sum, 1 + 1e-9);
      }
    }
    EXPECT_NEAR(share, 1, 1e-9);
  }
}

TEST(Prism, FindsEachPartOnce) {
  covers_what_is_below(wavy_line(17));
  covers_what_is_below(wavy_thread(17));
  covers_what_is_below(wavy_sheet(9));
}

TEST(Prism, FindsHolesAndWhatIsBeside) {
  auto parts = wavy_sheet(4);
  const std::array<Vector<3>, 3> simplex{{{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}};
  const Prism<3, 3> prism(simplex);
  Prism<3, 3>::Clipping clipping;
  double share = 0;
  for (const auto& part : parts) share += prism.share(prism.inside(part, clipping));
  EXPECT_NEAR(share, 1, 1e-12);
  EXPECT_NEAR(prism.share(prism.inside(parts.front(), clipping)), 1.0 / 16, 1e-12);
  const std::array<Vector<3>, 3> outside{{{{0, 0.1, 0}}, {{0, 1, 2}}, {{0.8, 1, 0}}}};
  EXPECT_TRUE(prism.inside(outside, clipping).empty());
  const std::array<Vector<3>, 3> larger{{{{-9, -3, 1}}, {{9, -3, 1}}, {{1, 20, 1}}}};
  EXPECT_NEAR(prism.share(prism.inside(larger, clipping)), 1, 1e-12);
}

TEST(Prism, HasNothingOverWhatIsFlat) {
  Prism<3, 3>::Clipping clipping;
  const Prism<3, 3> prism({{{{0, 0, 0}}, {{1, 1, 1}}, {{2, 2, 2}}}});
  for (const auto& part : wavy_sheet(2)) EXPECT_TRUE(prism.inside(part, clipping).empty());
}

}  // namespace
}  // namespace ductile::meshadapt::prism_test
