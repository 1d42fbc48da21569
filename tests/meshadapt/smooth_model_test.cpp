#include "geometry/smooth_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "ductile/meshadapt/simplex.hpp"
#include "geometry/divided.hpp"
#include "geometry/sheets.hpp"
#include "mesh/distance.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::smooth_model_test {
namespace {

using runtime::Executor;
using test::uniform;
using Triangle = CurvedSimplex<3, 3>;

const double ridge = std::cos(0.25 * 3.14159265358979323846);

/// The surface of a cube with n x n squares on each side, mapped by `place`, by default to the
/// sphere of radius 1. All of it is one smooth patch.
using Place = std::function<Vector<3>(const Vector<3>&)>;
ModelInput<3> blown_up_cube(int n, const Place& place) {
  ModelInput<3> input{{}, {}, {}, {}, 1, 1e-10, ridge};
  std::map<std::array<int, 3>, std::uint32_t> number_of;
  const auto number = [&](std::array<int, 3> at) {
    const auto [found, is_new] =
        number_of.try_emplace(at, static_cast<std::uint32_t>(input.points.size()));
    if (is_new) {
      Vector<3> p;
      for (std::size_t i = 0; i < 3; ++i) p.x[i] = std::tan(0.785398 * (2.0 * at[i] / n - 1));
      input.points.push_back(place((1 / norm(p)) * p));
      input.ends.push_back(0);
    }
    return found->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int end : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> corner{};
            corner[axis] = end;
            corner[(axis + 1) % 3] = end == 0 ? j + v : i + u;
            corner[(axis + 2) % 3] = end == 0 ? i + u : j + v;
            return number(corner);
          };
          const std::uint32_t a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          for (const auto& corner : {std::array{a, b, c}, std::array{a, c, d}})
            input.facets.push_back(
                {corner, 1, static_cast<std::uint32_t>(input.facets.size()), true});
        }
  return input;
}

/// Largest value of distance(p) over sample points of all curved facets.
template <class Distance>
double farthest(const SmoothModel<3>& model, Distance distance) {
  constexpr int n = 6;
  double most = 0;
  for (const auto& piece : model.facets)
    for (int i = 0; i <= n && piece; ++i)
      for (int j = 0; i + j <= n; ++j)
        most = std::max(
            most,
            std::abs(distance(piece->at({i / double(n), j / double(n), (n - i - j) / double(n)}))));
  return most;
}

Place ellipsoid(const Vector<3>& axes) {
  return [axes](const Vector<3>& p) {
    return Vector<3>{{axes[0] * p[0], axes[1] * p[1], axes[2] * p[2]}};
  };
}
/// Distance from an ellipsoid, to first order.
double distance_from(const Vector<3>& axes, const Vector<3>& p) {
  double value = -1, square = 0;
  for (int i = 0; i < 3; ++i) {
    value += p[i] * p[i] / (axes[i] * axes[i]);
    square += std::pow(2 * p[i] / (axes[i] * axes[i]), 2);
  }
  return value / std::sqrt(square);
}

TEST(SmoothModel, ComesCloseToEllipsoids) {
  const Executor executor({.threads = 2});
  test::Random random(1);
  for (int trial = 0; trial < 6; ++trial) {
    Vector<3> axes;
    for (double& axis : axes.x) axis = uniform(random, 0.5, 1.5);
    const auto error = [&](int n) {
      return farthest(SmoothModel<3>(executor, blown_up_cube(n, ellipsoid(axes))),
                      [&](const Vector<3>& p) { return distance_from(axes, p); });
    };
    const double coarse = error(6), fine = error(12);
    EXPECT_LT(coarse, 0.02);
    EXPECT_LT(fine, coarse / 5) << "the error of chords would fall to a quarter";
  }
}

TEST(SmoothModel, ComesCloserToASphereThanChords) {
  const Executor executor({.threads = 1});
  const ModelInput<3> input = blown_up_cube(8, ellipsoid({{1, 1, 1}}));
  const auto off = [](const Vector<3>& p) { return norm(p) - 1; };
  EXPECT_LT(farthest(SmoothModel<3>(executor, input), off), 4e-4) << "of chords: 0.017";
}

/// Adds two crossing rings of edges, like the seams of a closed surface; no patch ends there.
ModelInput<3> with_seams(ModelInput<3> input, bool are_ridges) {
  for (const auto& facet : input.facets)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = facet.corner[i], b = facet.corner[(i + 1) % 3];
      const auto is_on = [&](int axis) {
        return std::abs(input.points[a][axis]) < 1e-9 && std::abs(input.points[b][axis]) < 1e-9;
      };
      if (a < b && (is_on(0) || is_on(1))) input.edges.push_back({{a, b}, true, are_ridges});
    }
  return input;
}

TEST(SmoothModel, SeamsInsideLeaveItSmooth) {
  const Executor executor({.threads = 2});
  test::Random random(2);
  for (int trial = 0; trial < 6; ++trial) {
    Vector<3> axes;
    for (double& axis : axes.x) axis = uniform(random, 0.7, 1.3);
    const ModelInput<3> input = blown_up_cube(8, ellipsoid(axes));
    const auto error = [&](const ModelInput<3>& of) {
      return farthest(SmoothModel<3>(executor, of),
                      [&](const Vector<3>& p) { return distance_from(axes, p); });
    };
    const double plain = error(input);
    EXPECT_LT(error(with_seams(input, false)), 1.5 * plain);
    EXPECT_GT(error(with_seams(input, true)), 3 * plain) << "ridges must not be smoothed";
  }
}

TEST(SmoothModel, DoesNotDependOnThreads) {
  const ModelInput<3> input = blown_up_cube(5, ellipsoid({{1, 0.8, 0.6}}));
  const SmoothModel<3> first(Executor({.threads = 1}), input);
  for (const int threads : {2, 3, 8}) {
    const SmoothModel<3> other(Executor({.threads = threads}), input);
    for (std::size_t f = 0; f < input.facets.size(); ++f)
      EXPECT_EQ(first.facets[f]->control, other.facets[f]->control);
  }
}

TEST(SmoothModel, IsNeverFartherThanTheTolerance) {
  const Executor executor({.threads = 2});
  ModelInput<3> input = blown_up_cube(4, ellipsoid({{1, 1, 1}}));
  for (const double tolerance : {0.02, 0.005, 0.0005}) {
    input.tolerance = tolerance;
    const SmoothModel<3> model(executor, input);
    double most = 0;
    for (const auto& piece : model.facets)
      for (int i = 0; i <= 8; ++i)
        for (int j = 0; i + j <= 8; ++j) {
          const Triangle::Weights w{i / 8.0, j / 8.0, (8 - i - j) / 8.0};
          const std::array corners{piece->corner(0), piece->corner(1), piece->corner(2)};
          const Vector<3> point = piece->at(w);
          most = std::max(most, norm(point - closest_point(corners, point)));
        }
    EXPECT_LE(most, 1.05 * tolerance);
    EXPECT_GE(most, 0.5 * tolerance);
  }
}

/// Facets that share a side have the same curve there, from either side.
TEST(SmoothModel, HasNoGaps) {
  const Executor executor({.threads = 2});
  const ModelInput<3> input = blown_up_cube(4, ellipsoid({{1, 0.7, 0.9}}));
  const SmoothModel<3> model(executor, input);
  std::map<std::array<std::uint32_t, 2>, Vector<3>> control_of;
  std::size_t shared = 0;
  for (std::size_t f = 0; f < input.facets.size(); ++f)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const auto& corner = input.facets[f].corner;
        const auto [found, is_new] =
            control_of.try_emplace({corner[i], corner[j]}, model.facets[f]->control[i][j]);
        EXPECT_EQ(found->second, model.facets[f]->control[i][j]);
        shared += is_new ? 0 : 1;
      }
  EXPECT_GT(shared, input.facets.size());
}

/// A strip, flat for x < 0 with a row of interior vertices, and rolled around a cylinder of radius
/// 1 for x > 0; both rims are curves.
ModelInput<3> rolled_strip(int n) {
  ModelInput<3> input{{}, {}, {}, {}, 0.05, 1e-10, ridge};
  for (int i = -n; i <= n; ++i)
    for (int j = 0; j <= 2; ++j) {
      const double s = i * 1.2 / n, y = j * 0.5;
      input.points.push_back(s < 0 ? Vector<3>{{s, y, 0}}
                                   : Vector<3>{{std::sin(s), y, std::cos(s) - 1}});
      input.ends.push_back(0);
    }
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(3 * (i + n) + j); };
  for (int i = -n; i < n; ++i) {
    const auto plane = static_cast<std::uint32_t>(i < 0 ? 0 : i + 1);
    for (int j = 0; j < 2; ++j) {
      input.facets.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, 1, plane, true});
      input.facets.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, 1, plane, true});
    }
    for (const int j : {0, 2}) input.edges.push_back({{at(i, j), at(i + 1, j)}, true});
  }
  for (const int i : {-n, n})
    for (int j = 0; j < 2; ++j) input.edges.push_back({{at(i, j), at(i, j + 1)}, false});
  return input;
}

TEST(SmoothModel, LeavesFlatWhatIsFlat) {
  const Executor executor({.threads = 2});
  const ModelInput<3> input = rolled_strip(6);
  const SmoothModel<3> model(executor, input);
  for (std::size_t f = 0; f < input.facets.size(); ++f)
    EXPECT_EQ(model.facets[f].has_value(), input.facets[f].plane != 0);
  const auto off = [](const Vector<3>& p) { return std::hypot(p[0], p[2] + 1) - 1; };
  EXPECT_LT(farthest(model, off), 2e-4) << "of chords: 0.005";
}

TEST(SmoothModel, EndsAtTheModelOfItsRims) {
  const Executor executor({.threads = 2});
  const ModelInput<3> input = rolled_strip(6);
  const SmoothModel<3> model(executor, input);
  std::size_t bent = 0;
  for (std::size_t e = 0; e < input.edges.size(); ++e) {
    const auto [a, b] = input.edges[e].corner;
    if (!model.edges[e]) continue;
    ++bent;
    for (std::size_t f = 0; f < input.facets.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (input.facets[f].corner[i] == a && input.facets[f].corner[j] == b) {
          EXPECT_EQ(model.facets[f]->control[i][j], model.edges[e]->control[0][1]);
          EXPECT_EQ(model.facets[f]->control[j][i], model.edges[e]->control[1][0]);
        }
      }
  }
  EXPECT_EQ(bent, 12);
}

TEST(SmoothModel, StaysWhereAFacetIsHeld) {
  const Executor executor({.threads = 1});
  ModelInput<3> input = blown_up_cube(4, ellipsoid({{1, 1, 1}}));
  input.facets[7].held = true;
  EXPECT_FALSE(SmoothModel<3>(executor, input).facets[7]);
}

/// A regular polygon with one vertex that is a corner.
ModelInput<2> polygon(int n) {
  ModelInput<2> input{{}, {}, {}, {}, 1, 1e-10, ridge};
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
    const double angle = 6.283185307179586 * i / n;
    input.points.push_back({{std::cos(angle), std::sin(angle)}});
    input.ends.push_back(i == 0 ? 1 : 0);
    input.facets.push_back({{i, (i + 1) % static_cast<std::uint32_t>(n)}, 1, i, true});
  }
  return input;
}

TEST(SmoothModel, OfAPolygonIsACircle) {
  const Executor executor({.threads = 2});
  for (const int n : {12, 24}) {
    const SmoothModel<2> model(executor, polygon(n));
    double most = 0;
    for (const auto& piece : model.facets)
      for (int i = 0; i <= 10; ++i)
        most = std::max(most, std::abs(norm(piece->at({i / 10.0, 1 - i / 10.0})) - 1));
    EXPECT_LT(most, n == 12 ? 4e-6 : 1e-7);
  }
}

TEST(Sheets, PutPointsOnWhatIsCurved) {
  const Executor executor({.threads = 2});
  const ModelInput<3> input = blown_up_cube(6, ellipsoid({{1, 1, 1}}));
  const SmoothModel<3> model(executor, input);
  std::vector<Sheets<3, 3>::Part> parts;
  for (const auto& facet : input.facets) {
    const auto [a, b, c] = facet.corner;
    parts.push_back({{input.points[a], input.points[b], input.points[c]}, 1, false});
  }
  const Sheets<3, 3> sheets(parts, 0.05, model.facets);
  test::Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    Vector<3> p;
    for (double& x : p.x) x = uniform(random, -1, 1);
    p *= uniform(random, 0.97, 1.03) / norm(p);
    const auto found = sheets.closest(p, 1, 0.05);
    ASSERT_TRUE(found);
    EXPECT_NEAR(norm(*found), 1, 2e-3);
    EXPECT_NEAR(norm(*found - p), std::abs(norm(p) - 1), 2e-3);
    const auto again = sheets.closest(*found, 1, 0.05);
    ASSERT_TRUE(again);
    EXPECT_NEAR(norm(*again - *found), 0, 1e-9);
  }
}

TEST(Divider, LeavesNoGapsBesideWhatIsDividedLess) {
  const Vector<3> a{{0, 0, 0}}, b{{1, 0, 0}}, c{{0, 1, 0}}, up{{0, 0, 0.1}};
  Triangle piece{};
  const std::array corner{a, b, c};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const bool bent = i + j == 1;  // the first side
      piece.control[i][j] = i == j ? corner[i] : Triangle::even(corner[i], corner[j]);
      if (bent) piece.control[i][j] += up;
    }
  piece.middle = (1.0 / 3) * (a + b + c);
  double area = 0;
  std::size_t count = 0;
  Divider<3, 3>(piece, 0.01).each([&](const auto& part) {
    area += 0.5 * facet_normal(part.corner)[2];
    ++count;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& weight = part.weight[i];
      if (weight[1] == 0 || weight[0] == 0) {
        EXPECT_EQ(part.corner[i][2], 0) << "the point leaves a straight side";
      }
    }
  });
  EXPECT_EQ(count, 16);
  EXPECT_NEAR(area, 0.5, 1e-12);
}

}  // namespace
}  // namespace ductile::meshadapt::smooth_model_test
