#include "ductile/meshadapt/simplex.hpp"

#include <gtest/gtest.h>

#include "core/determinant.hpp"
#include "core/orientation.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::simplex_test {
namespace {

using test::Random;
using test::uniform;

/// Points on a common line or plane, up to a few units in the last place.
template <int Dim>
std::array<Vector<Dim>, Dim + 1> almost_flat(Random& random, double scale, double offset) {
  std::array<Vector<Dim>, Dim + 1> p;
  for (std::size_t i = 0; i < Dim; ++i)
    for (double& x : p[i].x) x = offset + scale * uniform(random, -1, 1);
  double rest = 1;
  for (std::size_t i = 0; i < Dim; ++i) {
    const double weight = i + 1 < Dim ? uniform(random, -1, 1) : rest;
    rest -= weight;
    p[Dim] += weight * p[i];
  }
  for (double& x : p[Dim].x)
    for (std::size_t step = test::below(random, 4); step > 0; --step)
      x = std::nextafter(x, test::chance(random, 0.5) ? 1e300 : -1e300);
  return p;
}

template <int Dim>
void expect_no_lie() {
  Random random(Dim);
  int certain = 0, exact = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double scale = std::pow(10.0, uniform(random, -20, 20));
    const auto p = almost_flat<Dim>(random, scale, test::chance(random, 0.3) ? 100 * scale : 0);
    const double claimed = certain_determinant<Dim>(p);
    const int sign = orientation<Dim>(p);
    certain += claimed != 0;
    exact += sign != 0;
    ASSERT_TRUE(claimed == 0 || sign == (claimed > 0 ? 1 : -1)) << "trial " << trial;
    auto turned = p;
    std::swap(turned[0], turned[1]);
    ASSERT_EQ(orientation<Dim>(turned), -sign);
  }
  EXPECT_GT(exact, 10000);
  EXPECT_GT(certain, 10);
  EXPECT_LT(certain, exact);
}

TEST(CertainDeterminant, NeverLiesInThePlane) { expect_no_lie<2>(); }
TEST(CertainDeterminant, NeverLiesInSpace) { expect_no_lie<3>(); }

TEST(CertainDeterminant, IsTwiceTheAreaOrSixTimesTheVolume) {
  EXPECT_EQ(certain_determinant({{0, 0}}, {{2, 0}}, {{0, 3}}), 6);
  EXPECT_EQ(certain_determinant({{0, 0, 0}}, {{1, 0, 0}}, {{0, 2, 0}}, {{0, 0, 3}}), 6);
  EXPECT_EQ(certain_determinant({{0, 0}}, {{1, 1}}, {{2, 2}}), 0);
}

TEST(Orientation, ToldFromZeroEvenWhereProductsVanish) {
  const double tiny = 1e-170;  // its square is a denormal
  EXPECT_EQ((orientation<2>({{{{0, 0}}, {{tiny, 0}}, {{0, tiny}}}})), 1);
  EXPECT_EQ((orientation<2>({{{{0, 0}}, {{tiny, tiny}}, {{2 * tiny, 2 * tiny}}}})), 0);
  EXPECT_EQ((orientation<2>({{{{0, 0}}, {{1e300, 0}}, {{0, 1e300}}}})), 1);
  EXPECT_EQ((orientation<2>({{{{0, 0}}, {{1, 0}}, {{0, std::nan("")}}}})), 0);
}

template <int Dim>
void expect_facets_face_outwards() {
  std::array<Vector<Dim>, Dim + 1> p;
  for (int i = 0; i < Dim; ++i) p[static_cast<std::size_t>(i + 1)][i] = 1;
  Corners<Dim> corners;
  for (std::size_t i = 0; i <= Dim; ++i) corners[i] = static_cast<VertexId>(i);
  for (int i = 0; i <= Dim; ++i) {
    const Facet<Dim> facet = facet_of<Dim>(corners, i);
    EXPECT_FALSE(contains(facet, static_cast<VertexId>(i)));
    std::array<Vector<Dim>, Dim + 1> seen;  // the opposite corner, and the facet
    for (std::size_t k = 0; k < Dim; ++k) seen[k] = p[facet[k]];
    seen[Dim] = p[static_cast<std::size_t>(i)];
    // The element lies to the left of its edges, and below its outward faces.
    EXPECT_EQ(orientation<Dim>(seen), Dim == 2 ? 1 : -1);
  }
}

TEST(Simplex, FacetsAreOppositeTheirCornersAndFaceOutwards) {
  expect_facets_face_outwards<2>();
  expect_facets_face_outwards<3>();
}

template <int Dim>
void expect_opposite_facets() {
  Corners<Dim> corners;
  for (std::size_t i = 0; i <= Dim; ++i) corners[i] = static_cast<VertexId>(10 + 3 * i);
  for (std::size_t i = 0; i <= Dim; ++i)
    EXPECT_EQ(facet_opposite<Dim>(corners, corners[i]),
              facet_of<Dim>(corners, static_cast<int>(i)));
}

TEST(Simplex, FindsTheFacetOppositeACorner) {
  expect_opposite_facets<2>();
  expect_opposite_facets<3>();
}

}  // namespace
}  // namespace ductile::meshadapt::simplex_test
