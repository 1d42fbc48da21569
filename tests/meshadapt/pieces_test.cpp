#include "operators/pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "core/determinant.hpp"
#include "support/metrics.hpp"

namespace ductile::meshadapt::pieces_test {
namespace {

template <class Dimension>
class PiecesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PiecesIn, Dimensions);

/// An element whose edges are cut at random places.
template <int Dim>
struct CutElement {
  std::array<Vector<Dim>, points_of_cut<Dim>> point{};

  explicit CutElement(test::Random& random) {
    for (std::size_t i = 0; i < Dim; ++i) point[i + 1][static_cast<int>(i)] = 1;
    for (std::size_t k = 0; k < Simplex<Dim>::edges; ++k) {
      const auto [a, b] = Simplex<Dim>::edge[k];
      const double t = test::uniform(random, 0.2, 0.8);
      point[middle_of<Dim>(k)] =
          (1 - t) * point[static_cast<std::size_t>(a)] + t * point[static_cast<std::size_t>(b)];
    }
  }

  double volume(const Piece<Dim>& piece) const {
    std::array<Vector<Dim>, Dim + 1> corner;
    for (std::size_t i = 0; i <= Dim; ++i) corner[i] = point[piece.corners[i]];
    return plain_determinant(corner);
  }

  /// Does this facet of the piece lie on that facet of the element?
  bool lies_on(const Piece<Dim>& piece, std::size_t facet, std::size_t of_element) const {
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (i == facet) continue;
      const Vector<Dim>& p = point[piece.corners[i]];
      double first = 1;  // barycentric coordinate of corner 0; those of the others are Cartesian
      for (int d = 0; d < Dim; ++d) first -= p[d];
      const double weight = of_element == 0 ? first : p[static_cast<int>(of_element) - 1];
      if (std::abs(weight) > 1e-12) return false;
    }
    return true;
  }
};

/// For edges cut in any order, the pieces fill the element, have its orientation, and know on which
/// of its facets theirs lie.
TYPED_TEST(PiecesIn, FillTheElement) {
  constexpr int Dim = TypeParam::value;
  test::Random random(1);
  const CutElement<Dim> element(random);
  std::vector<std::size_t> order(Simplex<Dim>::edges);
  std::iota(order.begin(), order.end(), 0U);
  std::size_t most = 0;
  do {
    Pieces<Dim> pieces;
    for (const std::size_t edge : order) {
      pieces.cut(edge);
      double sum = 0;
      for (std::size_t p = 0; p < pieces.size(); ++p) {
        const double volume = element.volume(pieces[p]);
        EXPECT_GT(volume, 0);
        sum += volume;
        for (std::size_t i = 0; i <= Dim; ++i)
          for (std::uint8_t f = 0; f <= Dim; ++f)
            EXPECT_EQ(pieces[p].facet_of[i] == f, element.lies_on(pieces[p], i, f));
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      for (std::size_t p = 0; p < pieces.size(); ++p) EXPECT_FALSE(pieces.has_edge(p, edge));
    }
    most = std::max(most, pieces.size());
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(most, Pieces<Dim>::most);
}

}  // namespace
}  // namespace ductile::meshadapt::pieces_test
