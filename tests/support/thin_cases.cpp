#include "support/thin_cases.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "core/determinant.hpp"
#include "support/meshes.hpp"

namespace ductile::meshadapt::test {

namespace {

template <int Dim>
Facet<Dim> in_order(Facet<Dim> facet) {
  std::sort(facet.begin(), facet.end());
  return facet;
}

/// Lists the facets that one element has, with reference 1 if they were listed before and otherwise
/// 7, and removes vertices that no element has.
template <int Dim>
void list_boundary(AnyMesh& mesh, const std::set<Facet<Dim>>& old) {
  std::map<Facet<Dim>, std::pair<int, Facet<Dim>>> found;
  for (const Corners<Dim>& corners : elements_in<Dim>(mesh).vertices)
    for (int i = 0; i <= Dim; ++i) {
      const Facet<Dim> facet = facet_of<Dim>(corners, i);
      auto& entry = found[in_order<Dim>(facet)];
      ++entry.first;
      entry.second = facet;
    }
  facets_in<Dim>(mesh) = {};
  for (const auto& [key, entry] : found)
    if (entry.first == 1) facets_in<Dim>(mesh).add(entry.second, old.contains(key) ? 1 : 7);
}

template <int Dim>
void drop_unused(AnyMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertex_count(), none);
  for (const auto& corners : elements_in<Dim>(mesh).vertices)
    for (const std::uint32_t v : corners) number[v] = 0;
  std::uint32_t next = 0;
  std::vector<double> coordinates;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == none) continue;
    number[v] = next++;
    for (std::size_t i = 0; i < Dim; ++i) coordinates.push_back(mesh.coordinates[v * Dim + i]);
  }
  mesh.coordinates = std::move(coordinates);
  mesh.vertex_reference.assign(next, 0);
  for (auto& corners : elements_in<Dim>(mesh).vertices)
    for (std::uint32_t& v : corners) v = number[v];
  for (auto& corners : facets_in<Dim>(mesh).vertices)
    for (std::uint32_t& v : corners) v = number[v];
}

/// Keeps the elements that are not gone.
template <int Dim>
void carve(AnyMesh& mesh, const std::vector<bool>& gone) {
  std::set<Facet<Dim>> old;
  for (const auto& facet : facets_in<Dim>(mesh).vertices) old.insert(in_order<Dim>(facet));
  Cells<Dim + 1> kept;
  const auto& elements = elements_in<Dim>(mesh);
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (!gone[e]) kept.add(elements.vertices[e], elements.reference[e]);
  elements_in<Dim>(mesh) = std::move(kept);
  list_boundary<Dim>(mesh, old);
  drop_unused<Dim>(mesh);
}

/// [element] The elements across its facets.
template <int Dim>
std::vector<std::vector<std::size_t>> neighbours_in(const AnyMesh& mesh) {
  std::vector<std::vector<std::size_t>> result(elements_in<Dim>(mesh).size());
  for (const auto& [facet, owners] : facet_elements<Dim>(mesh))
    if (owners.size() == 2) {
      result[owners[0]].push_back(owners[1]);
      result[owners[1]].push_back(owners[0]);
    }
  return result;
}

/// Marks as gone all elements except the largest part connected by facets.
template <int Dim>
void keep_one_part(const AnyMesh& mesh, std::vector<bool>& gone) {
  const auto next = neighbours_in<Dim>(mesh);
  std::vector<int> part(gone.size(), -1);
  std::vector<std::size_t> size;
  for (std::size_t seed = 0; seed < gone.size(); ++seed) {
    if (gone[seed] || part[seed] >= 0) continue;
    std::vector<std::size_t> front{seed};
    part[seed] = static_cast<int>(size.size());
    size.push_back(0);
    while (!front.empty()) {
      const std::size_t e = front.back();
      front.pop_back();
      ++size.back();
      for (const std::size_t other : next[e])
        if (!gone[other] && part[other] < 0) {
          part[other] = part[e];
          front.push_back(other);
        }
    }
  }
  const auto largest = std::max_element(size.begin(), size.end()) - size.begin();
  for (std::size_t e = 0; e < gone.size(); ++e) gone[e] = gone[e] || part[e] != largest;
}

/// A plate and the thickness of its layers.
struct Plate {
  AnyMesh mesh;
  double layer;
};

Plate random_plate(int dimension, Random& random) {
  Grid grid;
  grid.dimension = dimension;
  grid.region = whole;
  grid.seed = random();
  const int across = dimension == 2 ? 6 + static_cast<int>(below(random, 8))
                                    : 3 + static_cast<int>(below(random, 3));
  const int layers = 2 + static_cast<int>(below(random, 3));
  const double layer = std::pow(10, uniform(random, -2.3, -0.8)) / (dimension == 2 ? 2 : 1);
  for (int axis = 0; axis < dimension; ++axis) {
    const bool thin = axis == dimension - 1;
    for (int i = 0; i <= (thin ? layers : across); ++i)
      grid.lines[static_cast<std::size_t>(axis)].push_back(thin ? layer * i : 1.0 * i / across);
  }
  return {make_grid(grid), layer};
}

/// Splits `count` random elements, one after the other, at an interior point into one element per
/// facet.
template <int Dim>
void divide_elements(AnyMesh& mesh, Random& random, std::size_t count) {
  auto& elements = elements_in<Dim>(mesh);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t e = below(random, elements.size());
    const Corners<Dim> corners = elements.vertices[e];
    const auto vertex = static_cast<std::uint32_t>(mesh.vertex_count());
    Vector<Dim> at;
    double sum = 0;
    for (const std::uint32_t v : corners) {
      const double weight = uniform(random, 0.2, 1);
      at += weight * position_in<Dim>(mesh, v);
      sum += weight;
    }
    for (int axis = 0; axis < Dim; ++axis) mesh.coordinates.push_back(at[axis] / sum);
    mesh.vertex_reference.push_back(0);
    for (std::size_t c = 0; c <= Dim; ++c) {
      Corners<Dim> part = corners;
      part[c] = vertex;
      if (c == 0)
        elements.vertices[e] = part;
      else
        elements.add(part, elements.reference[e]);
    }
  }
}

template <int Dim>
bool is_sound(const AnyMesh& mesh) {
  const auto& elements = elements_in<Dim>(mesh).vertices;
  return std::all_of(elements.begin(), elements.end(), [&](const Corners<Dim>& corners) {
    std::array<Vector<Dim>, Dim + 1> at;
    for (std::size_t i = 0; i <= Dim; ++i) at[i] = position_in<Dim>(mesh, corners[i]);
    return certain_determinant<Dim>(at) > 0;
  });
}

/// Moves vertices along the last axis by height(x, y), unless that inverts an element.
void lift(AnyMesh& mesh, const std::function<double(double, double)>& height) {
  const std::vector<double> flat = mesh.coordinates;
  const auto dimension = static_cast<std::size_t>(mesh.dimension);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    double* at = &mesh.coordinates[v * dimension];
    at[dimension - 1] += height(at[0], dimension == 3 ? at[1] : 0);
  }
  if (!(dimension == 2 ? is_sound<2>(mesh) : is_sound<3>(mesh))) mesh.coordinates = flat;
}

/// A random height function: a cylinder, a cap of a ball, or a wave.
std::function<double(double, double)> random_curve(Random& random) {
  const double radius = uniform(random, 0.8, 4), waves = uniform(random, 2, 7);
  const double amount = uniform(random, 0.1, 0.5) / waves;
  const double x = uniform(random, 0.2, 0.8), y = uniform(random, 0.2, 0.8);
  switch (below(random, 3)) {
    case 0:
      return [=](double u, double) { return std::sqrt(radius * radius - (u - x) * (u - x)); };
    case 1:
      return [=](double u, double v) {
        return std::sqrt(2 * radius * radius - (u - x) * (u - x) - (v - y) * (v - y));
      };
    default:
      return [=](double u, double v) { return amount * std::sin(waves * u + v + x); };
  }
}

template <int Dim>
ThinCase voids(std::uint64_t seed) {
  Random random(seed * 7919 + Dim);
  auto [mesh, layer] = random_plate(Dim, random);
  if (chance(random, 0.8)) divide_elements<Dim>(mesh, random, 10 + below(random, 60));
  const auto next = neighbours_in<Dim>(mesh);
  const auto& elements = elements_in<Dim>(mesh).vertices;
  std::vector<int> used(mesh.vertex_count());  // 1: by the surface, 2: by a void
  for (const auto& facet : facets_in<Dim>(mesh).vertices)
    for (const std::uint32_t v : facet) used[v] = 1;
  std::vector<bool> gone(elements.size());
  const int most_at_surface = std::max(0, static_cast<int>(below(random, 9)) - 5);
  const std::size_t count = 1 + below(random, 6), largest = 1 + below(random, 6);
  for (std::size_t trial = 0, made = 0; trial < 100 && made < count; ++trial) {
    std::set<std::size_t> chosen{below(random, elements.size())};
    for (std::size_t size = 1; size < largest; ++size) {
      auto at = chosen.begin();
      std::advance(at, static_cast<long>(below(random, chosen.size())));
      if (!next[*at].empty()) chosen.insert(next[*at][below(random, next[*at].size())]);
    }
    int at_surface = 0;
    bool touches = false;
    std::set<std::uint32_t> corners;
    for (const std::size_t e : chosen)
      for (const std::uint32_t v : elements[e]) corners.insert(v);
    for (const std::uint32_t v : corners) {
      at_surface += used[v] == 1;
      touches = touches || used[v] == 2;
    }
    const bool opens = std::any_of(chosen.begin(), chosen.end(),
                                   [&](std::size_t e) { return next[e].size() <= Dim; });
    if (touches || opens || at_surface > most_at_surface) continue;
    for (const std::uint32_t v : corners) used[v] = 2;
    for (const std::size_t e : chosen) gone[e] = true;
    ++made;
  }
  carve<Dim>(mesh, gone);
  if (chance(random, 0.4)) lift(mesh, random_curve(random));
  return {std::move(mesh), uniform(random, 0.15, 1.5),
          layer * std::pow(10, uniform(random, -1, 0.7)), "voids"};
}

template <int Dim>
ThinCase joined_voids(std::uint64_t seed) {
  Random random(seed * 6007 + Dim);
  auto [mesh, layer] = random_plate(Dim, random);
  if (chance(random, 0.5)) divide_elements<Dim>(mesh, random, 10 + below(random, 60));
  std::vector<bool> gone(elements_in<Dim>(mesh).size());
  const double share = uniform(random, 0.02, 0.15);
  for (auto&& is_gone : gone) is_gone = chance(random, share);
  keep_one_part<Dim>(mesh, gone);
  carve<Dim>(mesh, gone);
  if (chance(random, 0.4)) lift(mesh, random_curve(random));
  return {std::move(mesh), uniform(random, 0.15, 1.5),
          layer * std::pow(10, uniform(random, -1, 0.7)), "joined voids"};
}

/// Doubles the vertices of facets between layers that satisfy `splits`. The elements above get the
/// new vertices, moved up by the gap.
template <int Dim>
void split(AnyMesh& mesh, double level, const std::function<bool(const Vector<Dim>&)>& splits,
           double gap) {
  std::set<Facet<Dim>> old;
  for (const auto& facet : facets_in<Dim>(mesh).vertices) old.insert(in_order<Dim>(facet));
  std::map<std::uint32_t, std::uint32_t> copy_of;
  auto& elements = elements_in<Dim>(mesh).vertices;
  const auto height = [&](std::uint32_t v) { return mesh.coordinates[v * Dim + Dim - 1]; };
  for (auto& corners : elements) {
    bool above = false;
    for (const std::uint32_t v : corners) above = above || height(v) > level + 1e-6;
    if (!above) continue;
    for (std::uint32_t& v : corners) {
      const auto at = position_in<Dim>(mesh, v);
      if (std::abs(at[Dim - 1] - level) > 1e-6 || !splits(at)) continue;
      const auto [found, fresh] =
          copy_of.try_emplace(v, static_cast<std::uint32_t>(mesh.vertex_count()));
      if (fresh) {
        for (int i = 0; i < Dim; ++i) mesh.coordinates.push_back(at[i] + (i == Dim - 1 ? gap : 0));
        mesh.vertex_reference.push_back(0);
      }
      v = found->second;
    }
  }
  list_boundary<Dim>(mesh, old);
}

struct Block {
  AnyMesh mesh;
  double level;  // of a plane in the middle
  double cell;
};

Block random_block(int dimension, Random& random) {
  const int n = dimension == 2 ? 4 + 2 * static_cast<int>(below(random, 5))
                               : 4 + 2 * static_cast<int>(below(random, 2));
  Grid grid = unit_grid(dimension, n);
  grid.seed = random();
  if (dimension == 3) grid.lines[2] = {0, 0.3, 0.5, 0.7, 1};
  return {make_grid(grid), 0.5, 1.0 / n};
}

void curve(AnyMesh& mesh, Random& random) {
  if (chance(random, 0.3)) {  // around the last axis but one; x is the angle, up is outwards
    const double angle = uniform(random, 0.3, 4);
    const auto dimension = static_cast<std::size_t>(mesh.dimension);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      double& x = mesh.coordinates[v * dimension];
      double& up = mesh.coordinates[v * dimension + dimension - 1];
      const double radius = 1 + up, at = -angle * x;
      x = radius * std::cos(at);
      up = radius * std::sin(at);
    }
  } else {
    lift(mesh, random_curve(random));
  }
}

template <int Dim>
ThinCase crack(std::uint64_t seed) {
  Random random(seed * 104729 + Dim);
  auto [mesh, level, cell] = random_block(Dim, random);
  const double x = uniform(random, 0.3, 0.7), y = uniform(random, 0.3, 0.7);
  const double radius = uniform(random, 1.1 * cell, 0.6);
  const bool round = chance(random, 0.5);
  const auto is_inside = [=](const Vector<Dim>& p) {
    const double u = std::abs(p[0] - x), v = Dim == 3 ? std::abs(p[1] - y) : 0;
    return (round ? std::hypot(u, v) : std::max(u, v)) < radius;
  };
  split<Dim>(mesh, level, is_inside, 0);
  curve(mesh, random);
  return {std::move(mesh), cell * uniform(random, 0.7, 4), std::pow(10, uniform(random, -4, -0.5)),
          "crack"};
}

template <int Dim>
ThinCase contact(std::uint64_t seed) {
  Random random(seed * 15485863 + Dim);
  auto [mesh, level, cell] = random_block(Dim, random);
  const double shared = chance(random, 0.5) ? 0 : uniform(random, 0, 0.3);
  const std::uint64_t salt = random();
  const auto is_split = [=](const Vector<Dim>& p) {
    Random own(salt + static_cast<std::uint64_t>(1e4 * p[0]) * 100003U +
               static_cast<std::uint64_t>(1e4 * p[1]));
    return !chance(own, shared);
  };
  const double gap = chance(random, 0.4) ? 0 : std::pow(10, uniform(random, -15, -9));
  split<Dim>(mesh, level, is_split, gap);
  curve(mesh, random);
  if (chance(random, 0.5)) {
    for (std::size_t e = 0; e < elements_in<Dim>(mesh).size(); ++e)
      elements_in<Dim>(mesh).reference[e] = 1;
  }
  return {std::move(mesh), cell * uniform(random, 0.7, 4), std::pow(10, uniform(random, -4, -0.5)),
          "contact"};
}

ThinCase described(ThinCase made) {
  std::ostringstream text;
  text << made.what << " in " << made.mesh.dimension << "D, size " << made.size << ", tolerance "
       << made.tolerance;
  made.what = text.str();
  made.mesh.name = "test";
  return made;
}

}  // namespace

ThinCase plate_with_voids(int dimension, std::uint64_t seed) {
  return described(dimension == 2 ? voids<2>(seed) : voids<3>(seed));
}
ThinCase plate_with_joined_voids(int dimension, std::uint64_t seed) {
  return described(dimension == 2 ? joined_voids<2>(seed) : joined_voids<3>(seed));
}
ThinCase curved_crack(int dimension, std::uint64_t seed) {
  return described(dimension == 2 ? crack<2>(seed) : crack<3>(seed));
}
ThinCase bodies_in_contact(int dimension, std::uint64_t seed) {
  return described(dimension == 2 ? contact<2>(seed) : contact<3>(seed));
}

}  // namespace ductile::meshadapt::test
