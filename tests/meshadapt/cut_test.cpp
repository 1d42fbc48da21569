/// @file
/// Tests of cut(): meshes of many kinds are cut along functions of many kinds, and the surface must
/// be a manifold with the topology of the zero of the linear interpolant, which is counted here
/// from signs alone.
#include "ductile/meshadapt/level_set.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "core/determinant.hpp"
#include "core/orientation.hpp"
#include "core/quality.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/mesh_arrays.hpp"
#include "ductile/meshadapt/metric_field.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"
#include "support/trials.hpp"

namespace ductile::meshadapt::cut_test {
namespace {

using runtime::Executor;
using test::Random;
using Key = std::vector<VertexId>;

template <class Dimension>
class Cut : public testing::Test {};
template <class Dimension>
class CutRandom : public testing::Test {};
template <int Dim>
using Dimension = std::integral_constant<int, Dim>;
using Dimensions = testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(Cut, Dimensions);
TYPED_TEST_SUITE(CutRandom, Dimensions);

// ---- Topology ----

struct Topology {
  std::int64_t euler = 0;
  std::size_t parts = 0;
  friend bool operator==(const Topology&, const Topology&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Topology& t) {
    return out << "Euler number " << t.euler << ", " << t.parts << " parts";
  }
};

class Sets {
 public:
  std::size_t of(const Key& key) {
    const auto [at, is_new] = number_.emplace(key, parent_.size());
    if (is_new) parent_.push_back(parent_.size());
    return at->second;
  }
  void unite(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }
  std::size_t root(std::size_t a) {
    while (parent_[a] != a) a = parent_[a];
    return a;
  }
  std::size_t count() {
    std::size_t n = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) n += parent_[i] == i;
    return n;
  }
  std::size_t size() const { return parent_.size(); }

 private:
  std::map<Key, std::size_t> number_;
  std::vector<std::size_t> parent_;
};

/// The zero of the linear interpolant in the elements with a reference (or all): a vertex on each
/// edge with both signs, an edge in each triangle, a facet in each tetrahedron.
template <int Dim>
Topology of_interpolant(const AnyMesh& mesh, const std::vector<double>& value_of,
                        std::optional<std::int32_t> reference) {
  Sets vertices;
  std::set<Key> segments;
  std::int64_t facets = 0;
  const auto& elements = elements_in<Dim>(mesh);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (reference && elements.reference[e] != *reference) continue;
    Corners<Dim> c = elements.vertices[e];
    std::sort(c.begin(), c.end());
    std::size_t first = none;
    for (std::size_t i = 0; i <= Dim; ++i)
      for (std::size_t j = i + 1; j <= Dim; ++j) {
        if ((value_of[c[i]] < 0) == (value_of[c[j]] < 0)) continue;
        const std::size_t v = vertices.of({c[i], c[j]});
        if (first == none) first = v;
        vertices.unite(first, v);
      }
    if (first == none) continue;
    ++facets;
    for (std::size_t out = 0; Dim == 3 && out <= Dim; ++out) {
      Key triangle;
      for (std::size_t i = 0; i <= Dim; ++i)
        if (i != out) triangle.push_back(c[i]);
      const auto below =
          std::ranges::count_if(triangle, [&](VertexId v) { return value_of[v] < 0; });
      if (below == 1 || below == 2) segments.insert(triangle);
    }
  }
  const auto n = static_cast<std::int64_t>(vertices.size());
  return {Dim == 2 ? n - facets : n - std::ssize(segments) + facets, vertices.count()};
}

/// Facets between elements of two references, with sorted corners.
template <int Dim>
std::vector<Key> facets_between(const AnyMesh& mesh, std::int32_t a, std::int32_t b) {
  std::map<Key, std::vector<std::int32_t>> sides;
  const auto& elements = elements_in<Dim>(mesh);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (int i = 0; i <= Dim; ++i) {
      const Facet<Dim> facet = facet_of<Dim>(elements.vertices[e], i);
      Key key(facet.begin(), facet.end());
      std::sort(key.begin(), key.end());
      sides[key].push_back(elements.reference[e]);
    }
  std::vector<Key> found;
  for (const auto& [key, of] : sides)
    if (of.size() == 2 && std::minmax(of[0], of[1]) == std::minmax(a, b)) found.push_back(key);
  return found;
}

/// Counts the topology of facets; complains where they are not a manifold.
template <int Dim>
Topology of_facets(const std::vector<Key>& facets) {
  Sets vertices;
  std::map<Key, int> ridges;  // 2D: the vertices themselves
  std::map<VertexId, std::vector<Key>> around;
  for (const Key& facet : facets)
    for (std::size_t i = 0; i < facet.size(); ++i) {
      vertices.unite(vertices.of({facet[0]}), vertices.of({facet[i]}));
      Key ridge = facet;
      ridge.erase(ridge.begin() + static_cast<std::ptrdiff_t>(i));
      ++ridges[ridge];
      Key others = facet;
      std::erase(others, facet[i]);
      around[facet[i]].push_back(others);
    }
  for (const auto& [ridge, count] : ridges) EXPECT_LE(count, 2) << "not a manifold";
  for (const auto& [vertex, links] : around) {
    Sets fan;
    for (const Key& link : links)
      for (const VertexId v : link) fan.unite(fan.of({link[0]}), fan.of({v}));
    if (Dim == 3) EXPECT_EQ(fan.count(), 1U) << "pinched at " << vertex;
  }
  const auto n = static_cast<std::int64_t>(vertices.size());
  const auto f = std::ssize(facets);
  return {Dim == 2 ? n - f : n - std::ssize(ridges) + f, vertices.count()};
}

// ---- Checks of a cut ----

template <int Dim>
std::array<Vector<Dim>, Dim + 1> points(const AnyMesh& mesh, std::size_t element) {
  std::array<Vector<Dim>, Dim + 1> p;
  for (std::size_t i = 0; i <= Dim; ++i)
    p[i] = position_in<Dim>(mesh, elements_in<Dim>(mesh).vertices[element][i]);
  return p;
}

template <int Dim>
bool is_valid(const AnyMesh& mesh) {
  for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e)
    if (orientation<Dim>(points<Dim>(mesh, e)) <= 0 ||
        !(plain_determinant(points<Dim>(mesh, e)) > 0))
      return false;
  return true;
}

template <int Dim>
double volume(const AnyMesh& mesh, std::size_t element) {
  const auto p = points<Dim>(mesh, element);
  EXPECT_EQ(orientation<Dim>(p), 1) << "element " << element;
  return plain_determinant(p);
}

template <int Dim>
double worst_quality(const AnyMesh& mesh) {
  double worst = 1;
  for (const auto& corners : elements_in<Dim>(mesh).vertices) {
    std::array<Site<Dim>, Dim + 1> sites;
    std::array<const Site<Dim>*, Dim + 1> pointers;
    for (std::size_t i = 0; i <= Dim; ++i) {
      sites[i] = make_site(position_in<Dim>(mesh, corners[i]), isotropic<Dim>(1));
      pointers[i] = &sites[i];
    }
    worst = std::min(worst, quality<Dim>(pointers));
  }
  return worst;
}

/// Sum of the sizes of listed facets by reference, without those on the surface.
template <int Dim>
std::map<std::int32_t, double> facet_sizes(const AnyMesh& mesh, std::int32_t except) {
  std::map<std::int32_t, double> sizes;
  const auto& facets = facets_in<Dim>(mesh);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    std::array<Vector<Dim>, Dim> p;
    for (std::size_t i = 0; i < Dim; ++i) p[i] = position_in<Dim>(mesh, facets.vertices[f][i]);
    if (facets.reference[f] != except) sizes[facets.reference[f]] += norm(facet_normal(p));
  }
  return sizes;
}

/// Sum of the lengths of listed edges by reference and by whether they are ridges.
std::map<std::pair<std::int32_t, bool>, double> edge_lengths(const AnyMesh& mesh) {
  std::map<std::pair<std::int32_t, bool>, double> lengths;
  const std::set<std::uint32_t> ridges(mesh.ridges.begin(), mesh.ridges.end());
  for (std::uint32_t i = 0; mesh.dimension == 3 && i < mesh.edges.size(); ++i)
    lengths[{mesh.edges.reference[i], ridges.contains(i)}] +=
        norm(position_in<3>(mesh, mesh.edges.vertices[i][0]) -
             position_in<3>(mesh, mesh.edges.vertices[i][1]));
  return lengths;
}

struct Case {
  AnyMesh mesh;
  std::vector<double> values;
  CutOptions options;
};

template <int Dim>
void expect_origins(const Case& c, const CutMesh& made) {
  const AnyMesh& mesh = made.mesh;
  ASSERT_EQ(made.vertex_origin.size(), mesh.vertex_count());
  ASSERT_EQ(made.value.size(), mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto& [a, b, t] = made.vertex_origin[v];
    ASSERT_LT(std::max(a, b), c.mesh.vertex_count());
    if (v < c.mesh.vertex_count()) ASSERT_EQ(a, v);
    const Vector<Dim> from = position_in<Dim>(c.mesh, a), to = position_in<Dim>(c.mesh, b);
    const Vector<Dim> off = position_in<Dim>(mesh, v) - ((1 - t) * from + t * to);
    ASSERT_LE(norm(off), 1e-14 * (norm(from) + norm(to)));
    if (a != b) ASSERT_EQ(made.value[v], 0);
  }
  const auto& before = elements_in<Dim>(c.mesh).reference;
  const auto& after = elements_in<Dim>(mesh);
  ASSERT_EQ(made.element_origin.size(), after.size());
  for (std::size_t e = 0; e < after.size(); ++e) {
    double least = 0, most = 0;
    for (const VertexId v : after.vertices[e]) {
      least = std::min(least, made.value[v]);
      most = std::max(most, made.value[v]);
    }
    CutMaterial of{0, true, c.options.minus, c.options.plus};
    for (const CutMaterial& m : c.options.materials)
      if (m.reference == before[made.element_origin[e]]) of = m;
    if (!of.split) {
      ASSERT_EQ(after.reference[e], before[made.element_origin[e]]);
      continue;
    }
    ASSERT_EQ(after.reference[e], least < 0 ? of.minus : of.plus);
    ASSERT_TRUE((least < 0) != (most > 0)) << least << ' ' << most;
  }
  const auto& facets = facets_in<Dim>(mesh);
  ASSERT_EQ(made.facet_origin.size(), facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f)
    ASSERT_EQ(
        facets.reference[f],
        made.facet_origin[f] == none ? c.options.interface : facets_in<Dim>(c.mesh).reference[made.facet_origin[f]]);
}

/// Everything that holds for each cut, if materials are manifolds.
template <int Dim>
void expect_good(const Case& c, const CutMesh& made) {
  const Executor executor({.threads = 1});
  EXPECT_EQ(test::joined(check_mesh(executor, made.mesh)), "");
  double before = 0, after = 0;
  for (std::size_t e = 0; e < elements_in<Dim>(c.mesh).size(); ++e)
    before += volume<Dim>(c.mesh, e);
  for (std::size_t e = 0; e < elements_in<Dim>(made.mesh).size(); ++e)
    after += volume<Dim>(made.mesh, e);
  EXPECT_NEAR(after / before, 1, 1e-11);
  const auto sizes = facet_sizes<Dim>(c.mesh, c.options.interface);
  const auto new_sizes = facet_sizes<Dim>(made.mesh, c.options.interface);
  ASSERT_EQ(new_sizes.size(), sizes.size());
  for (const auto& [reference, size] : sizes) EXPECT_NEAR(new_sizes.at(reference) / size, 1, 1e-11);
  const auto lengths = edge_lengths(c.mesh), new_lengths = edge_lengths(made.mesh);
  ASSERT_EQ(new_lengths.size(), lengths.size());
  for (const auto& [kind, length] : lengths) EXPECT_NEAR(new_lengths.at(kind) / length, 1, 1e-11);
  EXPECT_EQ(made.mesh.corners, c.mesh.corners);
  for (const VertexId v : made.mesh.corners) EXPECT_EQ(made.vertex_origin[v].b, v);
  expect_origins<Dim>(c, made);
  std::set<Key> listed, surface;
  for (std::size_t f = 0; f < facets_in<Dim>(made.mesh).size(); ++f) {
    const auto& corners = facets_in<Dim>(made.mesh).vertices[f];
    Key key(corners.begin(), corners.end());
    std::sort(key.begin(), key.end());
    EXPECT_TRUE(listed.insert(key).second) << "listed twice";
    if (made.facet_origin[f] == none) surface.insert(key);
  }
  std::vector<double> level(c.values);
  for (double& x : level) x -= made.report.level;
  const auto check = [&](std::optional<std::int32_t> reference, const CutMaterial& m) {
    const auto facets = facets_between<Dim>(made.mesh, m.minus, m.plus);
    EXPECT_EQ(of_facets<Dim>(facets), of_interpolant<Dim>(c.mesh, level, reference));
    for (const Key& facet : facets) EXPECT_TRUE(listed.contains(facet));
    for (const Key& facet : facets) surface.erase(facet);
  };
  for (const CutMaterial& m : c.options.materials)
    if (m.split) check(m.reference, m);
  if (c.options.materials.empty()) check({}, {0, true, c.options.minus, c.options.plus});
  EXPECT_TRUE(surface.empty()) << "facets on no surface";
}

// ---- Functions and meshes ----

/// A random function of one of seven kinds.
template <int Dim>
std::vector<double> random_values(const AnyMesh& mesh, Random& random, int kind, double h) {
  Vector<Dim> a, b, k;
  for (int i = 0; i < Dim; ++i) {
    a[i] = test::uniform(random, 0.2, 0.8);
    b[i] = test::uniform(random, 0, 1);
    k[i] = test::uniform(random, 2, 12);
  }
  const double r = test::uniform(random, 0.1, 0.4), width = h * test::uniform(random, 0.1, 0.9);
  std::vector<double> values;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vector<Dim> p = position_in<Dim>(mesh, v);
    double waves = test::uniform(random, -1e-3, 1e-3) * (kind == 0);
    for (int i = 0; i < Dim; ++i) waves += std::sin(k[i] * p[i] + b[i]);
    const double ball = norm(p - a) - r, other = norm(p - b) - r;
    values.push_back(kind == 0   ? waves                  // smooth
                     : kind == 1 ? std::min(ball, other)  // kinked
                     : kind == 2 ? std::max(std::abs(p[0] - a[0]), std::abs(p[1] - a[1])) - r
                     : kind == 3 ? std::abs(ball) - width                    // a thin film
                     : kind == 4 ? test::uniform(random, -1, 1)              // noise
                     : kind == 5 ? (test::chance(random, 0.5) ? 1.0 : -1.0)  // checkerboard
                                 : static_cast<double>(test::below(random, 3)) - 1);  // with zeros
  }
  return values;
}

template <int Dim>
AnyMesh random_mesh(Random& random, int n, const std::function<int(const test::Cell&)>& region) {
  test::Grid grid = test::unit_grid(Dim, n);
  grid.region = region;
  grid.seed = test::below(random, 2) == 0 ? 0 : random();
  AnyMesh mesh = test::make_grid(grid);
  if (Dim == 3 && test::chance(random, 0.5)) test::list_ridges(mesh);
  if (test::chance(random, 0.7)) test::jiggle(mesh, random, test::uniform(random, 0, 0.4));
  return mesh;
}

template <int Dim>
Case random_case(std::uint64_t seed) {
  Random random(seed);
  const int n = Dim == 2 ? 9 : 5, kind = static_cast<int>(seed % 7);
  Case c;
  const auto shape = test::below(random, 4);
  c.mesh = random_mesh<Dim>(random, n,
                            shape == 0   ? test::l_shape(n)
                            : shape == 1 ? test::two_halves(n)
                            : shape == 2 ? test::with_hole(n)
                                         : std::function<int(const test::Cell&)>(test::whole));
  c.values = random_values<Dim>(c.mesh, random, kind, 1.0 / n);
  if (test::chance(random, 0.3)) test::place(c.mesh, random, 10, 3);
  if (shape == 1 && test::chance(random, 0.8))
    c.options.materials = {{1, true, 11, 12}, {2, test::chance(random, 0.5), 21, 22}};
  c.options.curved = test::chance(random, 0.7);
  return c;
}

TYPED_TEST(CutRandom, MeshesWithFlatElementsAreCut) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  int tried = 0;
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Case c;
    const int n = Dim == 2 ? 9 : 5;
    c.mesh = random_mesh<Dim>(random, n, test::whole);
    test::make_slivers(c.mesh, random, 20, std::pow(10, -test::uniform(random, 2, 13)));
    if (test::chance(random, 0.3)) test::place(c.mesh, random, 10, 3);
    c.values = random_values<Dim>(c.mesh, random, static_cast<int>(seed % 7), 1.0 / n);
    if (!is_valid<Dim>(c.mesh)) continue;  // rounding has turned flat elements over
    ++tried;
    expect_good<Dim>(c, cut(executor, c.mesh, c.values, c.options));
  }
  EXPECT_GT(tried, 0);
}

TYPED_TEST(CutRandom, FunctionsOfAllKindsGiveManifoldsOfTheInterpolantsTopology) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(70); ++seed) {
    SCOPED_TRACE(seed);
    const Case c = random_case<Dim>(seed);
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    if (testing::Test::HasFailure()) break;
  }
}

template <int Dim>
Case ball_case(int n, double radius = 0.3) {
  Random random(7);
  Case c;
  c.mesh = random_mesh<Dim>(random, n, test::whole);
  Vector<Dim> centre;
  for (int i = 0; i < Dim; ++i) centre[i] = 0.47 + 0.02 * i;
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v)
    c.values.push_back(norm(position_in<Dim>(c.mesh, v) - centre) - radius);
  return c;
}

/// The volume of the elements with a reference.
template <int Dim>
double volume_of(const AnyMesh& mesh, std::int32_t reference) {
  double sum = 0;
  for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e)
    if (elements_in<Dim>(mesh).reference[e] == reference)
      sum += volume<Dim>(mesh, e) / (Dim == 2 ? 2 : 6);
  return sum;
}

template <int Dim>
Vector<Dim> all_ones() {
  Vector<Dim> ones;
  ones.x.fill(1);
  return ones;
}

std::string refusal(const Case& c) {
  try {
    cut(Executor({.threads = 1}), c.mesh, c.values, c.options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TYPED_TEST(CutRandom, UnstructuredMeshesAreCutAndAdapted) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 2});
  for (std::uint64_t seed = test::first_trial(); seed < test::end_of_trials(7); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Case c;
    c.mesh = random_mesh<Dim>(random, Dim == 2 ? 9 : 4, test::two_halves(Dim == 2 ? 9 : 4));
    const double size = Dim == 2 ? 0.07 : 0.2;
    c.mesh = adapt(executor, c.mesh, constant_metric(c.mesh, size)).mesh;
    c.values = random_values<Dim>(c.mesh, random, static_cast<int>(seed % 7), size);
    c.options.materials = {{1, true, 11, 12}, {2, seed % 2 == 0, 21, 22}};
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    AdaptOptions options;
    options.make.hausdorff_tolerance = 0.05 * size;
    const AdaptedMesh after = adapt(executor, made.mesh, constant_metric(made.mesh, size), options);
    EXPECT_EQ(test::joined(check_mesh(executor, after.mesh)), "");
  }
}

TYPED_TEST(Cut, TheSameBytesAtAnyNumberOfThreads) {
  constexpr int Dim = TypeParam::value;
  Case c = ball_case<Dim>(Dim == 2 ? 60 : 16);
  c.options.least_component = 0.001;
  for (const bool keeps_volume : {false, true}) {
    if (keeps_volume) c.options.keep_volume = 0.2;
    const CutMesh expected = cut(Executor({.threads = 1}), c.mesh, c.values, c.options);
    EXPECT_GT(expected.report.moved_vertices, 10U);
    for (const int threads : {2, 3, 4, 8}) {
      const CutMesh made = cut(Executor({.threads = threads}), c.mesh, c.values, c.options);
      EXPECT_TRUE(made.mesh == expected.mesh);
      EXPECT_EQ(test::bits(made.mesh.coordinates), test::bits(expected.mesh.coordinates));
      EXPECT_EQ(test::bits(made.value), test::bits(expected.value));
      EXPECT_EQ(made.vertex_origin, expected.vertex_origin);
      EXPECT_EQ(made.element_origin, expected.element_origin);
      EXPECT_EQ(made.facet_origin, expected.facet_origin);
      EXPECT_EQ(made.report.level, expected.report.level);
      EXPECT_EQ(made.report.minus_volume, expected.report.minus_volume);
    }
  }
}

TYPED_TEST(Cut, PlanesAreExact) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  double farthest = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    Case c;
    c.mesh = random_mesh<Dim>(random, Dim == 2 ? 12 : 6, test::whole);
    Vector<Dim> normal;
    for (int i = 0; i < Dim; ++i) normal[i] = test::uniform(random, -0.2, 0.2);
    normal[static_cast<int>(seed % Dim)] = 1;
    normal *= 1 / norm(normal);
    const double offset = dot(normal, test::uniform(random, 0.4, 0.6) * all_ones<Dim>());
    const auto height = [&](const AnyMesh& mesh, std::size_t v) {
      return dot(normal, position_in<Dim>(mesh, v)) - offset;
    };
    for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v) c.values.push_back(height(c.mesh, v));
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    double most = 0;
    for (std::size_t v = 0; v < made.mesh.vertex_count(); ++v)
      if (made.value[v] == 0) most = std::max(most, std::abs(height(made.mesh, v)));
    farthest = std::max(farthest, most);
  }
  EXPECT_LE(farthest, 1e-12);
}

TYPED_TEST(Cut, ZerosOfQuadraticFunctionsAreExact) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(Dim == 2 ? 20 : 9);
  for (double& x : c.values) x = (x + 0.3) * (x + 0.3) - 0.09;
  for (const bool curved : {false, true}) {
    c.options.curved = curved;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    double sum = 0, most = 0, count = 0;
    for (std::size_t v = 0; v < made.mesh.vertex_count(); ++v) {
      if (made.value[v] != 0) continue;
      Vector<Dim> p = position_in<Dim>(made.mesh, v);
      for (int i = 0; i < Dim; ++i) p[i] -= 0.47 + 0.02 * i;
      sum += std::abs(norm(p) - 0.3);
      most = std::max(most, std::abs(norm(p) - 0.3));
      ++count;
    }
    if (curved)
      EXPECT_LT(most, 1e-8);
    else
      EXPECT_GT(sum / count, 1e-4);
  }
}

TYPED_TEST(Cut, MaterialsKeepTheirInterfaceAndTheirReferences) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const int n = Dim == 2 ? 16 : 8;
  Case c = ball_case<Dim>(n);
  Random random(3);
  c.mesh = random_mesh<Dim>(random, n, test::two_halves(n));
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v)
    c.values[v] = norm(position_in<Dim>(c.mesh, v) - 0.49 * all_ones<Dim>()) - 0.3;
  for (const bool split : {true, false}) {
    c.options.materials = {{1, true, 11, 12}, {2, split, 21, 22}};
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    expect_good<Dim>(c, made);
    for (const std::int32_t side : {21, 22}) EXPECT_EQ(volume_of<Dim>(made.mesh, side) > 0, split);
    EXPECT_EQ(volume_of<Dim>(made.mesh, 2) > 0, !split);
    // The interface is a plane across an axis, and its facets have the reference 11 or more.
    const auto& facets = facets_in<Dim>(made.mesh);
    std::array<std::set<double>, Dim> places;
    for (std::size_t f = 0; f < facets.size(); ++f)
      for (std::size_t i = 0; made.facet_origin[f] != none && facets.reference[f] > 10 && i < Dim;
           ++i)
        for (int k = 0; k < Dim; ++k)
          places[static_cast<std::size_t>(k)].insert(
              position_in<Dim>(made.mesh, facets.vertices[f][i])[k]);
    EXPECT_TRUE(std::ranges::any_of(places, [](const auto& p) { return p.size() == 1; }));
  }
}

/// Cuts again and again: what is left of earlier surfaces is gone, and sides become one domain.
TYPED_TEST(Cut, EarlierSurfacesAreForgotten) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const int n = Dim == 2 ? 16 : 8;
  Random random(5);
  AnyMesh mesh = random_mesh<Dim>(random, n, test::two_halves(n));
  const std::size_t listed = facets_in<Dim>(mesh).size();
  for (const bool has_materials : {false, true})
    for (int step = 0; step < 4; ++step) {
      Case c{mesh, {}, {}};
      if (has_materials) c.options.materials = {{1, true, 11, 12}, {2, true, 21, 22}};
      for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        c.values.push_back(norm(position_in<Dim>(mesh, v) - (0.4 + 0.05 * step) * all_ones<Dim>()) -
                           0.3);
      const CutMesh made = cut(executor, mesh, c.values, c.options);
      EXPECT_EQ(test::joined(check_mesh(executor, made.mesh)), "");
      const auto& references = facets_in<Dim>(made.mesh).reference;
      EXPECT_EQ(std::ranges::count(references, 10),
                std::ssize(made.facet_origin) -
                    std::ranges::count_if(made.facet_origin, [](auto f) { return f != none; }));
      EXPECT_GE(std::ssize(references) - std::ranges::count(references, 10),
                std::ssize(Key(listed)));
      const std::set<std::int32_t> found(elements_in<Dim>(made.mesh).reference.begin(),
                                         elements_in<Dim>(made.mesh).reference.end());
      EXPECT_EQ(found, has_materials ? (std::set<std::int32_t>{11, 12, 21, 22})
                                     : (std::set<std::int32_t>{2, 3}));
      const Topology sphere{Dim == 2 ? 0 : 2, 1};
      if (!has_materials) EXPECT_EQ(of_facets<Dim>(facets_between<Dim>(made.mesh, 2, 3)), sphere);
      mesh = made.mesh;
      if (has_materials && step == 3) break;
      if (!has_materials && step == 3) mesh = random_mesh<Dim>(random, n, test::two_halves(n));
    }
}

TYPED_TEST(Cut, SmallComponentsGoOnBothSides) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(Dim == 2 ? 24 : 12);
  std::size_t small = 0;
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v) {
    const Vector<Dim> p = position_in<Dim>(c.mesh, v);
    const double bubble = norm(p - 0.48 * all_ones<Dim>()) - 0.1;
    const double drop = norm(p - 0.9 * all_ones<Dim>()) - 0.1;
    small += bubble < 0 || drop < 0;
    c.values[v] = std::min(std::max(c.values[v], -bubble), drop);
  }
  ASSERT_GT(small, 4U);
  const CutMesh all = cut(executor, c.mesh, c.values, c.options);
  expect_good<Dim>(c, all);
  EXPECT_EQ(of_facets<Dim>(facets_between<Dim>(all.mesh, 2, 3)).parts, 3U);
  c.options.least_component = 0.05;
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  EXPECT_EQ(made.report.removed_components, 2U);
  EXPECT_GT(made.report.removed_volume, 0);
  EXPECT_EQ(of_facets<Dim>(facets_between<Dim>(made.mesh, 2, 3)), (Topology{Dim == 2 ? 0 : 2, 1}));
}

TYPED_TEST(Cut, TheVolumeIsKept) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(Dim == 2 ? 24 : 10);
  for (const double wanted : {0.03, 0.1, 0.4}) {
    c.options.keep_volume = wanted;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    EXPECT_NEAR(made.report.minus_volume / wanted, 1, 2e-4);
    EXPECT_NEAR(volume_of<Dim>(made.mesh, 3) / made.report.minus_volume, 1, 1e-12);
  }
  c.options.keep_volume = 1.5;
  EXPECT_NE(refusal(c).find("keep_volume: expected one between 0 and"), std::string::npos);
}

TYPED_TEST(Cut, ALevelThatIsMetNowhereGivesOneSide) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(6);
  for (const double level : {-5, 5}) {
    c.options.level = level;
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    ASSERT_EQ(made.report.warnings.size(), 1U);
    EXPECT_NE(made.report.warnings[0].find("met nowhere"), std::string::npos);
    AnyMesh expected = c.mesh;
    std::ranges::fill(elements_in<Dim>(expected).reference, level < 0 ? 2 : 3);
    EXPECT_TRUE(made.mesh == expected);
  }
}

/// The signed distance of the mesh's own boundary is 0 there, which is no surface inside.
TYPED_TEST(Cut, ZerosOnAllOfTheBoundaryAreNoSurface) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  Case c = ball_case<Dim>(6);
  for (const double sign : {-1, 1}) {
    for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v) {
      double distance = 1;
      for (const double x : position_in<Dim>(c.mesh, v).x)
        distance = std::min({distance, x, 1 - x});
      c.values[v] = sign * distance;
    }
    const CutMesh made = cut(executor, c.mesh, c.values, c.options);
    EXPECT_EQ(made.report.cut_elements, 0U);
    EXPECT_EQ(elements_in<Dim>(made.mesh).reference[0], sign < 0 ? 3 : 2);
  }
}

/// Values of -1 and 1, and of -1, 0 and 1, without any order. Any numbers give worse elements.
TYPED_TEST(Cut, ElementsOfCheckerboardsHaveAShape) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    Case c;
    c.mesh = test::make_grid(test::unit_grid(Dim, Dim == 2 ? 12 : 6));
    const int kind = 4 + static_cast<int>(seed % 3);
    c.values = random_values<Dim>(c.mesh, random, kind, 0.1);
    const double least = (Dim == 2 ? 0.1 : 0.02) * (kind == 4 ? 0.25 : 1);
    EXPECT_GT(worst_quality<Dim>(cut(executor, c.mesh, c.values).mesh), least) << seed;
  }
}

TYPED_TEST(Cut, RequiredEntitiesStayOrAreNamed) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const int n = 6;
  Case c = ball_case<Dim>(n);
  auto& required_elements = Dim == 2 ? c.mesh.required_triangles : c.mesh.required_tetrahedra;
  auto& required_facets = Dim == 2 ? c.mesh.required_edges : c.mesh.required_triangles;
  const AnyMesh plain = c.mesh;
  const CutMesh free = cut(executor, c.mesh, c.values, c.options);
  std::vector<int> pieces(elements_in<Dim>(c.mesh).size());
  for (const ElementId e : free.element_origin) ++pieces[e];
  const auto crossed =
      static_cast<std::uint32_t>(std::ranges::max_element(pieces) - pieces.begin());
  required_elements = {crossed};
  EXPECT_NE(refusal(c).find("[" + std::to_string(crossed) + "], which is required"),
            std::string::npos);
  required_elements.clear();
  for (std::uint32_t e = 0; e < pieces.size(); ++e)
    if (std::ranges::none_of(elements_in<Dim>(c.mesh).vertices[e],
                             [&](VertexId v) { return std::abs(c.values[v]) < 0.25; }))
      required_elements.push_back(e);
  ASSERT_FALSE(required_elements.empty());
  for (std::uint32_t f = 0; f < facets_in<Dim>(c.mesh).size(); ++f)
    if (f % 3 == 0) required_facets.push_back(f);
  for (VertexId v = 0; v < c.mesh.vertex_count(); v += 5) c.mesh.required_vertices.push_back(v);
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  expect_good<Dim>(c, made);
  const auto& now = Dim == 2 ? made.mesh.required_triangles : made.mesh.required_tetrahedra;
  ASSERT_EQ(now.size(), required_elements.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    EXPECT_EQ(made.element_origin[now[i]], required_elements[i]);
    EXPECT_EQ(elements_in<Dim>(made.mesh).vertices[now[i]],
              elements_in<Dim>(c.mesh).vertices[required_elements[i]]);
  }
  const auto& facets = Dim == 2 ? made.mesh.required_edges : made.mesh.required_triangles;
  ASSERT_EQ(facets.size(), required_facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
    EXPECT_EQ(made.facet_origin[facets[i]], required_facets[i]);
  for (const VertexId v : c.mesh.required_vertices) EXPECT_EQ(made.vertex_origin[v].b, v);
  c.mesh = plain;
  for (std::size_t v = 0; v < c.values.size(); ++v)
    c.values[v] = position_in<Dim>(c.mesh, v)[0] - 0.43;
  for (std::uint32_t f = 0; f < facets_in<Dim>(c.mesh).size(); ++f) required_facets.push_back(f);
  EXPECT_NE(refusal(c).find("which is required"), std::string::npos);
}

TYPED_TEST(Cut, FieldsAreCarriedAlong) {
  constexpr int Dim = TypeParam::value;
  const Executor executor({.threads = 1});
  const Case c = ball_case<Dim>(8);
  const CutMesh made = cut(executor, c.mesh, c.values, c.options);
  AnyField places{Dim, c.mesh.vertex_count(), {AnyField::Type::vector}, c.mesh.coordinates, ""};
  const AnyField carried = field_at_cut(executor, places, made);
  ASSERT_EQ(carried.values.size(), made.mesh.coordinates.size());
  for (std::size_t i = 0; i < carried.values.size(); ++i)
    ASSERT_NEAR(carried.values[i], made.mesh.coordinates[i], 1e-15);
  std::vector<double> sizes;
  for (std::size_t v = 0; v < c.mesh.vertex_count(); ++v)
    sizes.push_back(std::exp(position_in<Dim>(c.mesh, v)[0]));
  const AnyField metric = metric_of(scalar_field(Dim, sizes), c.mesh);
  const auto tensors = tensors_of<Dim>(executor, metric_at_cut(executor, metric, made));
  for (std::size_t v = 0; v < tensors.size(); ++v)
    ASSERT_NEAR(1 / std::sqrt(tensors[v].m[0]), std::exp(position_in<Dim>(made.mesh, v)[0]), 1e-12);
  EXPECT_THROW(field_at_cut(executor, carried, made), InputError);
}

TYPED_TEST(Cut, WrongInputIsNamed) {
  constexpr int Dim = TypeParam::value;
  const Case good = ball_case<Dim>(4);
  const auto expect = [&](const std::string& message, auto&& spoil) {
    Case c = good;
    spoil(c);
    EXPECT_NE(refusal(c).find(message), std::string::npos) << refusal(c);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect("values[7]", [&](Case& c) { c.values[7] = nan; });
  expect("values[3]", [&](Case& c) { c.values[3] = std::numeric_limits<double>::infinity(); });
  expect("values: expected one for each", [](Case& c) { c.values.pop_back(); });
  expect("level: expected", [&](Case& c) { c.options.level = nan; });
  expect("least_component: expected", [](Case& c) { c.options.least_component = 1; });
  expect("keep_volume: expected", [&](Case& c) { c.options.keep_volume = nan; });
  expect("for both", [](Case& c) { c.options.plus = c.options.minus; });
  expect("materials[1]", [](Case& c) { c.options.materials = {{1, true, 3, 2}, {1, true, 5, 6}}; });
  expect("materials[0]", [](Case& c) { c.options.materials = {{1, true, 3, 3}}; });
  expect("not in the table", [](Case& c) { c.options.materials = {{5, true, 3, 2}}; });
  expect("several materials", [](Case& c) {
    c.options.materials = {{5, true, 1, 2}, {6, true, 1, 3}};
  });
  expect("expected dimension", [](Case& c) { c.mesh.dimension = 4; });
  expect("vertices[2]", [](Case& c) { elements_in<Dim>(c.mesh).vertices[2][0] = 1U << 30U; });
  expect("required", [](Case& c) { c.mesh.required_edges = {1U << 30U}; });
  expect("", [](Case& c) { c.mesh = {}; });
}

}  // namespace
}  // namespace ductile::meshadapt::cut_test
