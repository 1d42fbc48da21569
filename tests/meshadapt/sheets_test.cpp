#include "geometry/sheets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "mesh/distance.hpp"
#include "support/meshes.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::sheets_test {
namespace {

using test::uniform;
using Triangle = std::array<Vector<3>, 3>;
using Segment = std::array<Vector<2>, 2>;

/// Sample points of a triangle, including its corners and sides.
std::vector<Vector<3>> samples(const Triangle& t, int n) {
  std::vector<Vector<3>> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      points.push_back((1.0 / n) * (i * t[0] + j * t[1] + (n - i - j) * t[2]));
  return points;
}
std::vector<Vector<2>> samples(const Segment& s, int n) {
  std::vector<Vector<2>> points;
  for (int i = 0; i <= n; ++i) points.push_back((1.0 / n) * (i * s[0] + (n - i) * s[1]));
  return points;
}

template <class Parts, int Dim>
double distance(const Parts& parts, const Vector<Dim>& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& part : parts)
    least = std::min(least, norm(closest_point(part.corner, point) - point));
  return least;
}

TEST(Distance, IsToTheClosestOfManyPointsOfATriangle) {
  test::Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    Triangle t;
    for (Vector<3>& corner : t)
      for (double& x : corner.x) x = uniform(random, -1, 1);
    Vector<3> p;
    for (double& x : p.x) x = uniform(random, -2, 2);
    double least = 9;
    for (const Vector<3>& at : samples(t, 60)) least = std::min(least, norm(at - p));
    const double found = norm(closest_point(t, p) - p);
    EXPECT_LE(found, least * (1 + 1e-12));
    EXPECT_GT(found, least - 0.06);
  }
}

TEST(Distance, IsToAPointOrALineWhereThatIsAllThereIs) {
  const Vector<3> a{{1, 2, 3}}, b{{3, 2, 3}}, p{{2, 5, 3}};
  EXPECT_EQ(norm(closest_point(Triangle{a, b, b}, p) - p), 3);
  EXPECT_EQ(closest_point(Triangle{a, a, a}, p), a);
  EXPECT_EQ(closest_point(std::array{a, a}, p), a);
}

/// A wave over the unit square, or a part of a wavy line, as sheet 7.
double height(double x, double y) { return 0.1 * std::sin(4 * x + 1) * std::cos(3 * y); }
std::vector<Sheets<3, 3>::Part> wave(std::uint32_t sheet, double lift = 0, bool two_sided = false) {
  constexpr int n = 20;
  const auto at = [&](int i, int j) {
    const double x = double(i) / n, y = double(j) / n;
    return Vector<3>{{x, y, height(x, y) + lift}};
  };
  std::vector<Sheets<3, 3>::Part> parts;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      parts.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, sheet, two_sided});
      parts.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, sheet, two_sided});
    }
  return parts;
}
std::vector<Sheets<2, 2>::Part> wavy_line(std::uint32_t sheet) {
  constexpr int n = 40;
  const auto at = [&](int i) {
    const double x = 1 - double(i) / n;  // so that its normal points upwards
    return Vector<2>{{x, height(x, 0)}};
  };
  std::vector<Sheets<2, 2>::Part> parts;
  parts.reserve(n);
  for (int i = 0; i < n; ++i) parts.push_back({{at(i), at(i + 1)}, sheet, false});
  return parts;
}

/// Compares the answer of the sheets for a facet with the distances of its samples.
template <class Sheets, class Parts, class Facet>
void compare(const Sheets& sheets, const Parts& parts, const Facet& facet, double tolerance,
             std::array<int, 2>& count) {
  double most = 0;
  for (const auto& p : samples(facet, 12)) most = std::max(most, distance(parts, p));
  const bool covered = sheets.cover(facet, 7);
  if (covered) {
    EXPECT_LE(most, tolerance);
  }
  if (most < 0.5 * tolerance) {
    EXPECT_TRUE(covered) << most / tolerance;
  }
  ++count[covered ? 1 : 0];
}

TEST(Sheets, CoverATriangleOnlyIfAllOfItIsClose) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  test::Random random(2);
  const auto parts = wave(7);
  std::array<int, 2> count{};
  for (const double tolerance : {0.003, 0.01, 0.03}) {
    const Sheets<3, 3> sheets(parts, tolerance);
    for (int trial = 0; trial < 80; ++trial) {
      const double size = uniform(random, 0.02, 0.5), x = uniform(random, 0, 1 - size),
                   y = uniform(random, 0, 1 - size);
      Triangle t{{{{x, y, 0}}, {{x + size, y, 0}}, {{x + size / 2, y + size, 0}}}};
      for (Vector<3>& p : t) p[2] = height(p[0], p[1]) + uniform(random, -1, 1) * tolerance;
      compare(sheets, parts, t, tolerance, count);
    }
  }
  EXPECT_GT(count[0], 40);
  EXPECT_GT(count[1], 40);
}

TEST(Sheets, CoverASegmentOnlyIfAllOfItIsClose) {
  test::Random random(3);
  const auto parts = wavy_line(7);
  std::array<int, 2> count{};
  for (const double tolerance : {0.003, 0.01, 0.03}) {
    const Sheets<2, 2> sheets(parts, tolerance);
    for (int trial = 0; trial < 80; ++trial) {
      const double size = uniform(random, 0.02, 0.5), x = uniform(random, 0, 1 - size);
      Segment s{{{{x + size, 0}}, {{x, 0}}}};
      for (Vector<2>& p : s) p[1] = height(p[0], 0) + uniform(random, -1, 1) * tolerance;
      compare(sheets, parts, s, tolerance, count);
    }
  }
  EXPECT_GT(count[0], 40);
  EXPECT_GT(count[1], 40);
}

Triangle upwards(double z) {
  return {{{{0.2, 0.2, height(0.2, 0.2) + z}},
           {{0.25, 0.2, height(0.25, 0.2) + z}},
           {{0.2, 0.25, height(0.2, 0.25) + z}}}};
}

TEST(Sheets, CoverNoFacetOfAnotherSheet) {
  const Sheets<3, 3> sheets(wave(7), 0.01);
  EXPECT_TRUE(sheets.cover(upwards(0), 7));
  EXPECT_FALSE(sheets.cover(upwards(0), 6));
  EXPECT_FALSE(sheets.cover({}, 7)) << "of no size";
}

TEST(Sheets, CoverAFacetThatIsTurnedOnlyIfThatMeansNothing) {
  const auto [a, b, c] = upwards(0);
  EXPECT_FALSE((Sheets<3, 3>(wave(7), 0.01).cover({a, c, b}, 7)));
  EXPECT_TRUE((Sheets<3, 3>(wave(7, 0, true), 0.01).cover({a, c, b}, 7)));
}

/// Two walls of a gap; the upper one faces down.
TEST(Sheets, CoverNoFacetThatMightMeetWhatFacesIt) {
  for (const bool two_sided : {false, true}) {
    auto parts = wave(7);
    for (auto part : wave(8, 0.02, two_sided)) {
      std::swap(part.corner[1], part.corner[2]);
      parts.push_back(part);
    }
    const auto covered = [&](double tolerance, double z) {
      return Sheets<3, 3>(parts, tolerance).cover(upwards(z), 7);
    };
    EXPECT_TRUE(covered(0.012, 0));
    EXPECT_EQ(covered(0.012, 0.0095), two_sided);
    EXPECT_TRUE(covered(0.05, 0)) << "the other wall is no closer than before";
    EXPECT_TRUE(covered(0.05, 0.005)) << "at most half the remaining distance";
    EXPECT_EQ(covered(0.05, 0.008), two_sided);
  }
}

/// A wall and a thin part with an angle of 4 degrees: a needle that points at the wall, or, with
/// the domain in between, the other side of a plate.
TEST(Sheets, CoverNoFacetThatMightMeetATip) {
  const Vector<2> left{{0, 0}}, right{{1, 0}};
  const Segment wall{right, left};  // faces upwards
  const auto covered = [&](const std::vector<Segment>& others, double tolerance, double height) {
    std::vector<Sheets<2, 2>::Part> parts{{wall, 7, false}};
    for (const Segment& other : others) parts.push_back({other, 8, false});
    const Vector<2> up{{0, height}};
    return Sheets<2, 2>(parts, tolerance).cover({right + up, left + up}, 7);
  };
  const Vector<2> tip{{0.9, 0.02}}, a{{0.88, 0.6}}, b{{0.92, 0.6}};
  EXPECT_TRUE(covered({{a, tip}, {tip, b}}, 0.01, 0.008))
      << "the tip is farther than the tolerance";
  EXPECT_FALSE(covered({{a, tip}, {tip, b}}, 0.03, 0.008));
  EXPECT_TRUE(covered({{a, tip}, {tip, b}}, 0.03, 0.006));
  EXPECT_TRUE(covered({{a, tip}, {tip, b}}, 0.03, 0));
  const Vector<2> under_left{{0, -0.02}};
  EXPECT_TRUE(covered({{under_left, right}}, 0.1, 0))
      << "the walls of a wedge are joined at its tip";
}

/// The other side of a ridge is no gap, however many facets it is divided into; the other side of a
/// thin wedge is one.
TEST(Sheets, CoverFacetsBesideARidge) {
  const Vector<2> left{{0, 0}}, ridge{{1, 0}}, down{{0, -0.03}};
  const auto covered = [&](double degrees, const std::vector<double>& ends) {
    const double angle = degrees * std::numbers::pi / 180;
    std::vector<Sheets<2, 2>::Part> parts{{Segment{ridge, left}, 7, false}};  // faces upwards
    Vector<2> from = ridge;
    for (const double end : ends) {
      const Vector<2> to = ridge - end * Vector<2>{{std::cos(angle), std::sin(angle)}};
      parts.push_back({Segment{to, from}, 8, false});
      from = to;
    }
    return Sheets<2, 2>(parts, 0.1).cover({ridge + down, left + down}, 7);
  };
  for (const double degrees : {75.0, 85.0, 95.0, 105.0}) {
    EXPECT_TRUE(covered(degrees, {0.5})) << degrees;
    EXPECT_TRUE(covered(degrees, {0.02, 0.5})) << degrees;
    EXPECT_TRUE(covered(degrees, {0.01, 0.02, 0.04, 0.5})) << degrees;
  }
  EXPECT_FALSE(covered(20, {0.02, 0.5}));
}

/// The two sides of a pipe of radius 1, as sheets 7, inside, and 8, in facets that are 0.02 long.
std::vector<Sheets<3, 3>::Part> pipe(double thickness) {
  constexpr int around = 300, along = 15;
  std::vector<Sheets<3, 3>::Part> parts;
  for (const std::uint32_t sheet : {7U, 8U}) {
    const double radius = sheet == 7 ? 1 - thickness : 1;
    const auto at = [&](int i, int j) {
      const double angle = 2 * std::numbers::pi * i / around;
      return Vector<3>{{radius * std::cos(angle), radius * std::sin(angle), 0.02 * j}};
    };
    for (int i = 0; i < around; ++i)
      for (int j = 0; j < along; ++j)
        for (Triangle t : {Triangle{at(i, j), at(i + 1, j), at(i + 1, j + 1)},
                           Triangle{at(i, j), at(i + 1, j + 1), at(i, j + 1)}}) {
          if (sheet == 7) std::swap(t[1], t[2]);
          parts.push_back({t, sheet, false});
        }
  }
  return parts;
}
/// A facet of large chords on one of its sides.
Triangle chords(test::Random& random, const std::vector<Sheets<3, 3>::Part>& parts,
                std::uint32_t sheet) {
  Triangle t;
  const double angle = uniform(random, 0, 6), width = uniform(random, 0.05, 0.25);
  const double low = uniform(random, 0, 0.1), high = uniform(random, 0.2, 0.3);
  const std::array places{std::pair(angle, low), std::pair(angle + width, low),
                          std::pair(angle + uniform(random, 0, width), high)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector<3> on_circle{
        {std::cos(places[i].first), std::sin(places[i].first), places[i].second}};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& part : parts) {
      if (part.sheet != sheet) continue;
      const Vector<3> there = closest_point(part.corner, on_circle);
      if (norm(there - on_circle) < least) t[i] = there;
      least = std::min(least, norm(there - on_circle));
    }
  }
  if (sheet == 7) std::swap(t[1], t[2]);
  return t;
}

/// Chords of the inner side lead away from the outer one, which curves down beside them.
TEST(Sheets, CoverFacetsOfThinWallsWhereverTheyStayApart) {
  test::Random random(5);
  std::array<int, 2> count{};
  for (const double thickness : {0.002, 0.003, 0.006}) {
    const auto parts = pipe(thickness);
    const auto side_near = [&](std::uint32_t sheet, const Triangle& facet) {
      auto near = parts;
      std::erase_if(near, [&](const auto& part) {
        return part.sheet != sheet ||
               norm(part.corner[0] - closest_point(facet, part.corner[0])) > 0.04;
      });
      return near;
    };
    const Sheets<3, 3> sheets(parts, 0.004);
    for (int trial = 0; trial < 30; ++trial) {
      const std::uint32_t sheet = 7 + static_cast<std::uint32_t>(trial % 2);
      const Triangle facet = chords(random, parts, sheet);
      const auto own = side_near(sheet, facet), other = side_near(15 - sheet, facet);
      double most = 0, least_gap = 1, worst = 0;
      for (const Vector<3>& p : samples(facet, 12)) {
        const double here = distance(own, p), gap = distance(other, p);
        most = std::max(most, here);
        least_gap = std::min(least_gap, gap);
        worst = std::max(worst, gap < 0.004 ? here / gap : 0);
      }
      const bool covered = sheets.cover(facet, sheet);
      if (most > 0.004 || worst > 0.5) {
        EXPECT_FALSE(covered) << most << ' ' << worst;
      }
      if (most < 0.0035 && 2.2 * most < least_gap) {
        EXPECT_TRUE(covered) << most << ' ' << least_gap;
      }
      ++count[covered ? 1 : 0];
    }
  }
  EXPECT_GT(count[0], 20);
  EXPECT_GT(count[1], 20);
}

TEST(Sheets, FindTheClosestPointWithinReach) {
  test::Random random(4);
  const auto parts = wave(7);
  const Sheets<3, 3> sheets(parts, 0.001);
  for (int trial = 0; trial < 100; ++trial) {
    const Vector<3> p{{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, -0.2, 0.2)}};
    const double true_distance = distance(parts, p);
    const auto found = sheets.closest(p, 7, 0.1);
    ASSERT_EQ(found.has_value(), true_distance <= 0.101);
    if (found) {
      EXPECT_NEAR(norm(*found - p), true_distance, 1e-15);
    }
    EXPECT_FALSE(sheets.closest(p, 6, 0.1));
  }
}

TEST(Sheets, OfNothingCoverNothing) {
  const Sheets<3, 2> sheets({}, 1);
  EXPECT_FALSE(sheets.cover({Vector<3>{{0, 0, 0}}, Vector<3>{{1, 0, 0}}}, 1));
  EXPECT_FALSE(sheets.closest({}, 1, 10));
}

}  // namespace
}  // namespace ductile::meshadapt::sheets_test
