#include "operators/ring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace ductile::meshadapt::ring_test {
namespace {

constexpr VertexId a = 100, b = 101;

/// The elements around edge a-b, one for each pair of consecutive vertices of n, shuffled, each
/// with its corners in a random even permutation.
std::vector<Corners<3>> fan(std::uint32_t n, bool closed, std::mt19937& random) {
  std::vector<Corners<3>> elements;
  for (std::uint32_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
    Corners<3> corners{a, b, i, (i + 1) % n};
    if (random() % 2) corners = {corners[1], corners[2], corners[0], corners[3]};
    if (random() % 2) corners = {corners[0], corners[2], corners[3], corners[1]};
    elements.push_back(corners);
  }
  std::shuffle(elements.begin(), elements.end(), random);
  return elements;
}

void expect_in_turn(const std::vector<Corners<3>>& elements, bool closed) {
  Ring ring;
  ASSERT_TRUE(ring.close(elements.size(), a, b, [&](std::size_t i) { return elements[i]; }));
  EXPECT_EQ(ring.open, !closed);
  ASSERT_EQ(ring.order.size(), elements.size());
  ASSERT_EQ(ring.vertices.size(), elements.size() + (closed ? 0 : 1));
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const VertexId from = ring.vertices[i], to = ring.vertices[(i + 1) % ring.vertices.size()];
    EXPECT_EQ(others(elements[ring.order[i]], a, b), (std::array{from, to}));
  }
}

TEST(Ring, PutsElementsAroundAnEdgeInTurn) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial)
    for (const std::uint32_t n : {3U, 4U, 7U, 16U}) {
      expect_in_turn(fan(n, true, random), true);
      expect_in_turn(fan(n, false, random), false);
    }
}

TEST(Ring, RefusesWhatIsNotOneRing) {
  std::mt19937 random(4);
  const auto closes = [](const std::vector<Corners<3>>& elements) {
    Ring ring;
    return ring.close(elements.size(), a, b, [&](std::size_t i) { return elements[i]; });
  };
  EXPECT_FALSE(closes({}));
  EXPECT_FALSE(closes(fan(17, true, random)));
  auto two = fan(5, false, random);  // two fans that touch in the edge only
  for (Corners<3> corners : fan(4, false, random)) {
    for (VertexId& v : corners)
      if (v < a) v += 50;
    two.push_back(corners);
  }
  EXPECT_FALSE(closes(two));
}

}  // namespace
}  // namespace ductile::meshadapt::ring_test
