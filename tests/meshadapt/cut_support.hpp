/// @file
/// Cases for tests of cut(), and what holds for each cut: the surface is a manifold with the
/// topology of the zero of the linear interpolant, which is counted here from signs alone.
#pragma once

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
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/level_set.hpp"
#include "support/bits.hpp"
#include "support/meshes.hpp"
#include "support/preserved.hpp"

namespace ductile::meshadapt::cut_test {

using runtime::Executor;
using test::Random;
using Key = std::vector<VertexId>;

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
    if (Dim == 3) {
      EXPECT_EQ(fan.count(), 1U) << "pinched at " << vertex;
    }
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

/// Are all elements thicker than what rounding does to new vertices?
template <int Dim>
bool is_valid(const AnyMesh& mesh) {
  for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e) {
    const auto p = points<Dim>(mesh, e);
    double longest = 0;
    for (const auto& q : p) longest = std::max(longest, norm(q - p[0]));
    if (orientation<Dim>(p) <= 0 || plain_determinant(p) < 1e-13 * std::pow(longest, Dim))
      return false;
  }
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
inline std::map<std::pair<std::int32_t, bool>, double> edge_lengths(const AnyMesh& mesh) {
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
    if (v < c.mesh.vertex_count()) {
      ASSERT_EQ(a, v);
    }
    const Vector<Dim> from = position_in<Dim>(c.mesh, a), to = position_in<Dim>(c.mesh, b);
    const Vector<Dim> off = position_in<Dim>(mesh, v) - ((1 - t) * from + t * to);
    ASSERT_LE(norm(off), 1e-14 * (norm(from) + norm(to)));
    if (a != b) {
      ASSERT_EQ(made.value[v], 0);
    }
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

inline std::string refusal(const Case& c) {
  try {
    cut(Executor({.threads = 1}), c.mesh, c.values, c.options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// Expects the same mesh, values and origins, bit for bit.
inline void expect_same_bytes(const CutMesh& made, const CutMesh& expected) {
  EXPECT_TRUE(made.mesh == expected.mesh);
  EXPECT_EQ(test::bits(made.mesh.coordinates), test::bits(expected.mesh.coordinates));
  EXPECT_EQ(test::bits(made.value), test::bits(expected.value));
  EXPECT_EQ(made.vertex_origin, expected.vertex_origin);
  EXPECT_EQ(made.element_origin, expected.element_origin);
  EXPECT_EQ(made.facet_origin, expected.facet_origin);
}

}  // namespace ductile::meshadapt::cut_test
