/// @file
/// Adapts meshes with flat faces, straight lines and interfaces whose coordinates were written with
/// few digits. In each of several calls they stay as flat as with all digits, and curved parts stay
/// curved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "ductile/meshadapt/statistics.hpp"
#include "geometry/make_mesh.hpp"
#include "geometry/rounding.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::rounding_test {
namespace {

using runtime::Executor;
using test::Random;

const Executor executor({.threads = 2});

/// A number format of a program.
struct Format {
  enum class Kind { significant, decimals, single, single_printed } kind;
  int digits;
  std::string what() const {
    const char* names[] = {" significant digits", " decimals", " of single precision",
                           " printed of single precision"};
    return std::to_string(digits) + names[static_cast<int>(kind)];
  }
};

double printed(const char* format, int digits, double x) {
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), format, digits, x);
  return std::strtod(text.data(), nullptr);
}

double written(double x, const Format& format) {
  switch (format.kind) {
    case Format::Kind::significant:
      return printed("%.*g", format.digits, x);
    case Format::Kind::decimals:
      return printed("%.*f", format.digits, x);
    case Format::Kind::single:
      return static_cast<float>(x);
    case Format::Kind::single_printed:
      return printed("%.*g", 9, static_cast<float>(x));
  }
  return x;
}

AnyMesh written(AnyMesh mesh, const Format& format) {
  for (double& x : mesh.coordinates) x = written(x, format);
  return mesh;
}

TEST(Rounding, IsToldFromTheNumbers) {
  Random random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const double size = std::pow(10.0, test::uniform(random, -4, 7));
    const int digits = 3 + trial % 10;
    const Format::Kind kind =
        std::array{Format::Kind::significant, Format::Kind::decimals, Format::Kind::single,
                   Format::Kind::single_printed}[test::below(random, 4)];
    const int places = digits - static_cast<int>(std::ceil(std::log10(size)));
    const Format format{kind, kind == Format::Kind::decimals ? places : digits};
    if (format.digits < 0) continue;
    PrecisionFinder finder;
    std::vector<double> values;
    for (int i = 0; i < 200; ++i) {
      values.push_back(written(test::uniform(random, -size, size), format));
      finder.add(values.back());
    }
    const Precision found = finder.precision();
    double unit = std::pow(10.0, -places);
    if (kind == Format::Kind::significant) {
      double most = 0;
      for (const double x : values) most = std::max(most, std::abs(x));
      unit = std::pow(10.0, std::floor(std::log10(most)) - digits + 1);
    }
    const bool single = kind == Format::Kind::single || kind == Format::Kind::single_printed;
    if (single) unit = std::ldexp(1.0, std::ilogb(size) - 23);
    SCOPED_TRACE("trial " + std::to_string(trial) + ", up to " + std::to_string(size) + ", " +
                 format.what());
    EXPECT_NEAR(std::log2(found.unit / unit), 0, single ? 1.001 : 1e-6);
    for (const double x : values) EXPECT_EQ(found.rounded(x), x);
  }
}

TEST(Rounding, IsNoneWhereAllDigitsAreThere) {
  Random random(2);
  PrecisionFinder finder;
  bool goes_on = true;
  for (int i = 0; i < 4; ++i) goes_on = finder.add(test::uniform(random, 0, 1));
  EXPECT_FALSE(goes_on);
  EXPECT_EQ(finder.precision().unit, 0);
}

struct Case {
  AnyMesh exact;
  Format format;
  double size;
  std::string what;
};

/// A rotated box, possibly with holes, interfaces and ridges, somewhere in space.
Case random_case(std::uint64_t seed) {
  Random random(seed);
  const int dimension = 2 + static_cast<int>(seed % 2);
  const int n = 2 * (dimension == 2 ? 5 + static_cast<int>(test::below(random, 4))
                                    : 3 + static_cast<int>(test::below(random, 2)));
  test::Grid grid = test::unit_grid(dimension, n);
  switch (test::below(random, 3)) {
    case 0:
      grid.region = test::whole;
      break;
    case 1:
      grid.region = test::two_halves(n);
      break;
    default:
      grid.region = test::l_shape(n);
  }
  Case result{test::make_grid(grid), {}, 0, ""};
  test::jiggle(result.exact, random, 0.1);
  if (dimension == 3 && test::chance(random, 0.3)) test::list_ridges(result.exact);
  double scale = 1, offset = 0;
  switch (test::below(random, 4)) {
    case 0:
      result.format = {Format::Kind::single, 24};
      break;
    case 1:
      result.format = {Format::Kind::single_printed, 9};
      break;
    case 2:
      result.format = {Format::Kind::decimals, 3};
      scale = 1000;
      offset = 500000;
      break;
    default:
      result.format = {Format::Kind::significant, 3 + static_cast<int>(test::below(random, 15))};
      scale = std::pow(10.0, test::uniform(random, -2, 2));
  }
  test::place(result.exact, random, scale, offset);
  result.size = scale / n * test::uniform(random, 0.7, 2.5);
  result.what = std::to_string(dimension) + "D, n " + std::to_string(n) + ", scale " +
                std::to_string(scale) + ", size " + std::to_string(result.size * n / scale) +
                " cells, " + result.format.what();
  return result;
}

struct Share {
  double in_range;       ///< share of the edges
  std::size_t vertices;  ///< of the mesh
};

/// Share of edges in range after each call.
std::vector<Share> shares(AnyMesh mesh, double size, int calls) {
  std::vector<Share> result;
  for (int call = 0; call < calls; ++call) {
    const AnyField metric = constant_metric(mesh, size);
    AdaptedMesh adapted = adapt(executor, mesh, metric);
    EXPECT_EQ(test::joined(check_mesh(executor, adapted.mesh)), "");
    EXPECT_EQ(test::joined(check_domain(executor, mesh, adapted.mesh)), "") << "call " << call;
    result.push_back({measure(executor, adapted.mesh, &adapted.metric).share_in_range(),
                      adapted.mesh.vertex_count()});
    mesh = std::move(adapted.mesh);
    size *= call % 2 == 0 ? 1.3 : 0.6;  // so that each call has work
  }
  return result;
}

/// With a few hundred edges the share in range varies by chance. If the boundary cannot be
/// coarsened, a third or more are out of range. With fewer edges the share means nothing.
TEST(Rounding, LeavesFlatWhatIsFlat) {
  if (test::sanitized) GTEST_SKIP() << test::takes_long;
  int compared = 0, poorer = 0;
  double sum = 0;
  for (auto seed = test::first_trial(); seed < test::end_of_trials(200); ++seed) {
    const Case random = random_case(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + random.what);
    const AnyMesh rounded = written(random.exact, random.format);
    if (!check_mesh(executor, rounded).empty()) continue;  // too few digits for a valid mesh
    const auto exact = shares(random.exact, random.size, 3);
    const auto found = shares(rounded, random.size, 3);
    for (std::size_t call = 0; call < exact.size(); ++call) {
      if (exact[call].vertices < 80) continue;
      const double difference = found[call].in_range - exact[call].in_range;
      EXPECT_GT(difference, -0.1) << "call " << call;
      sum += difference;
      poorer += difference < -0.03;
      ++compared;
    }
  }
  if (compared < 300) return;  // too few cases for a mean
  EXPECT_GT(sum / compared, -0.005);
  EXPECT_LT(poorer, 0.04 * compared);
}

/// A grid that is sheared by one of a few slopes in each column. All coordinates are multiples of
/// 0.05 by choice, and straight lines are exactly straight.
AnyMesh round_numbers(Random& random) {
  constexpr double unit = 0.05;
  const int dimension = 2 + static_cast<int>(test::below(random, 2));
  const int n = 4 + 2 * static_cast<int>(test::below(random, 3));
  test::Grid grid = test::unit_grid(dimension, n);
  grid.region = test::random_regions(random(), 3, false);
  AnyMesh mesh = test::make_grid(grid);
  std::vector<int> height{0};  // of each line, in units
  int rise = 0;
  for (int column = 0; column < n; ++column) {
    if (column == 0 || test::chance(random, 0.4)) rise = static_cast<int>(test::below(random, 3));
    height.push_back(height.back() + rise);
  }
  const auto size = static_cast<std::size_t>(dimension);
  const auto in_units = [&](double x, int units) { return unit * std::round(units * n * x); };
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += size) {
    const auto column = static_cast<std::size_t>(std::lround(n * mesh.coordinates[at]));
    mesh.coordinates[at] = in_units(mesh.coordinates[at], 5);
    for (std::size_t axis = 1; axis < size; ++axis)
      mesh.coordinates[at + axis] = in_units(mesh.coordinates[at + axis], 2);
    mesh.coordinates[at + 1] += unit * height[column];
  }
  return written(mesh, {Format::Kind::decimals, 2});
}

TEST(Rounding, IsNoneOfRoundNumbersByChoice) {
  Random random(4);
  for (std::uint64_t trial = 0; trial < test::trials(60); ++trial) {
    SCOPED_TRACE(trial);
    const AnyMesh mesh = round_numbers(random);
    const AdaptedMesh adapted =
        adapt(executor, mesh, constant_metric(mesh, test::uniform(random, 0.08, 0.4)));
    EXPECT_EQ(test::joined(test::changes_of_what_is_kept(mesh, adapted.mesh)), "");
  }
}

template <int Dim>
std::size_t patch_count(const AnyMesh& any) {
  Neighbours<Dim> neighbours;
  std::vector<std::string> warnings;
  return make_mesh<Dim>(executor, any, {}, neighbours, warnings).patches.size();
}

/// Number of patches that are sides of a crack.
std::size_t crack_side_count(const AnyMesh& any) {
  Neighbours<3> neighbours;
  std::vector<std::string> warnings;
  const auto patches = make_mesh<3>(executor, any, {}, neighbours, warnings).patches;
  return static_cast<std::size_t>(std::count_if(
      patches.begin(), patches.end(), [](const auto& patch) { return patch.crack_side; }));
}

/// Rounding may bend a patch, but the patch encloses nothing then.
TEST(Rounding, MakesNoPatchFaceAnother) {
  for (auto seed = test::first_trial(); seed < test::end_of_trials(200); ++seed) {
    const Case random = random_case(2 * seed + 1);  // in 3D
    SCOPED_TRACE("seed " + std::to_string(2 * seed + 1) + ": " + random.what);
    const AnyMesh rounded = written(random.exact, random.format);
    if (!check_mesh(executor, rounded).empty()) continue;
    EXPECT_EQ(crack_side_count(rounded), crack_side_count(random.exact));
  }
}

/// A disk or cylinder of radius 1 with this number of facets around.
AnyMesh cylinder(int dimension, int facets) {
  test::Grid grid = test::unit_grid(dimension, facets / 4);
  if (dimension == 3) grid.lines[2] = {0, 0.5, 1};
  AnyMesh mesh = test::make_grid(grid);
  const auto size = static_cast<std::size_t>(dimension);
  for (std::size_t at = 0; at < mesh.coordinates.size(); at += size) {
    double &x = mesh.coordinates[at], &y = mesh.coordinates[at + 1];
    x = 2 * x - 1;
    y = 2 * y - 1;
    // Places vertices by angle, so that all facets are equal.
    const double square = std::max(std::abs(x), std::abs(y));
    if (!(square > 0)) continue;
    const double along = std::abs(x) == square ? y / x : x / y;
    const double angle = std::abs(x) == square ? std::atan(1) * along : std::atan(1) * (2 - along);
    const double sign = (std::abs(x) == square ? x : y) < 0 ? -1 : 1;
    x = sign * square * std::cos(angle);
    y = sign * square * std::sin(angle);
  }
  std::fill(mesh.edges.reference.begin(), mesh.edges.reference.end(), 1);
  for (std::int32_t& reference : mesh.triangles.reference) reference = std::max(reference, 4);
  return mesh;
}

TEST(Rounding, KeepsTheFacetsOfCylinders) {
  Random random(3);
  for (const int dimension : {2, 3})
    for (const int facets : {48, 120, 400}) {
      if (dimension == 3 && facets == 400) continue;  // the same as in 2D, but large
      const AnyMesh exact = cylinder(dimension, facets);
      const std::size_t flat = dimension == 3 ? 2 : 0;
      for (const double scale : {0.003, 1.0, 700.0})
        for (const int digits : {6, 7, 8, 10, 12, 17}) {
          SCOPED_TRACE(std::to_string(dimension) + "D, " + std::to_string(facets) + " facets, " +
                       std::to_string(scale) + ", " + std::to_string(digits));
          AnyMesh mesh = exact;
          test::place(mesh, random, scale, 0);
          mesh = written(mesh, {Format::Kind::significant, digits});
          const std::size_t count = dimension == 2 ? patch_count<2>(mesh) : patch_count<3>(mesh);
          EXPECT_EQ(count, 1 + flat + static_cast<std::size_t>(facets));
        }
    }
}

}  // namespace
}  // namespace ductile::meshadapt::rounding_test
