#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/meshadapt/vector.hpp"
#include "ductile/runtime/hash.hpp"
#include "geometry/roughness.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/indices.hpp"
#include "mesh/pinches.hpp"
#include "mesh/scale.hpp"

namespace ductile::meshadapt {

namespace {

/// Adds up measure_of(i) by reference, for each row of equal ones at once.
template <class MeasureOf>
std::map<std::int32_t, double> sums(const std::vector<std::int32_t>& reference_of,
                                    MeasureOf measure_of) {
  std::map<std::int32_t, double> sum_of;
  for (std::size_t i = 0; i < reference_of.size();) {
    const std::int32_t reference = reference_of[i];
    double sum = 0;
    for (; i < reference_of.size() && reference_of[i] == reference; ++i) sum += measure_of(i);
    sum_of[reference] += sum;
  }
  return sum_of;
}

double total(const std::map<std::int32_t, double>& sum_of) {
  double total = 0;
  for (const auto& [reference, sum] : sum_of) total += sum;
  return total;
}

/// Number by number: what is copied as a whole goes through memory, and takes twice as long.
template <int Dim, std::size_t N>
std::array<Vector<Dim>, N> points(const AnyMesh& mesh,
                                  const std::array<std::uint32_t, N>& corners) {
  std::array<Vector<Dim>, N> at;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t k = 0; k < Dim; ++k)
      at[i].x[k] = mesh.coordinates[corners[i] * std::size_t{Dim} + k];
  return at;
}

template <int Dim>
double facet_measure(const AnyMesh& mesh, const Facet<Dim>& facet) {
  return norm(facet_normal(points<Dim>(mesh, facet))) / (Dim == 2 ? 1 : 2);
}

/// By reference: of the elements, and of the facets that are listed.
struct Measures {
  std::map<std::int32_t, double> regions, facets;
};

template <int Dim>
Measures measures(const AnyMesh& mesh) {
  const auto& elements = elements_in<Dim>(mesh);
  const auto& facets = facets_in<Dim>(mesh);
  return {sums(elements.reference,
               [&](std::size_t e) {
                 const auto corners = points<Dim>(mesh, elements.vertices[e]);
                 return std::abs(plain_determinant(corners)) / (Dim == 2 ? 2 : 6);
               }),
          sums(facets.reference,
               [&](std::size_t f) { return facet_measure<Dim>(mesh, facets.vertices[f]); })};
}

/// One side of a facet: its corners, ascending, and a number of the element's.
template <int Dim>
using Side = std::pair<Facet<Dim>, std::int32_t>;

/// The sides, sorted, of which the other has another number, or no element. Facets between two
/// elements of one number cancel each other in a sum of hashes, so that hardly any others are left
/// to sort.
template <int Dim, class NumberOf>
std::vector<Side<Dim>> single_sides(const AnyMesh& mesh, NumberOf number_of) {
  const auto& elements = elements_in<Dim>(mesh);
  const auto for_each_side = [&](auto visit) {
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (int i = 0; i <= Dim; ++i) {
        Facet<Dim> facet = facet_of<Dim>(elements.vertices[e], i);
        std::sort(facet.begin(), facet.end());
        visit(Side<Dim>{facet, number_of(e)});
      }
  };
  std::vector<std::uint64_t> hashes_at(mesh.vertex_count());  // [lowest corner]
  for_each_side([&](const Side<Dim>& side) {
    auto hash = static_cast<std::uint64_t>(side.second);
    for (const VertexId v : side.first) hash = runtime::mix64(hash ^ v);
    hashes_at[side.first[0]] ^= hash;
  });
  std::vector<Side<Dim>> sides, single;
  for_each_side([&](const Side<Dim>& side) {
    if (hashes_at[side.first[0]] != 0) sides.push_back(side);
  });
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (i + 1 < sides.size() && sides[i] == sides[i + 1])
      ++i;
    else
      single.push_back(sides[i]);
  return single;
}

/// The facets of one element only.
template <int Dim>
std::vector<Facet<Dim>> boundary_facets(const AnyMesh& mesh) {
  std::vector<Facet<Dim>> facets;
  for (const Side<Dim>& side : single_sides<Dim>(mesh, [](std::size_t) { return 0; }))
    facets.push_back(side.first);
  return facets;
}

/// Of each region, by reference, interfaces to others included.
template <int Dim>
std::map<std::int32_t, double> boundary_measures(const AnyMesh& mesh) {
  const auto& reference_of = elements_in<Dim>(mesh).reference;
  std::map<std::int32_t, double> sum_of;
  for (const auto& [facet, reference] :
       single_sides<Dim>(mesh, [&](std::size_t e) { return reference_of[e]; }))
    sum_of[reference] += facet_measure<Dim>(mesh, facet);
  return sum_of;
}

/// Of the boundary that is not listed.
template <int Dim>
double unlisted_measure(const AnyMesh& mesh) {
  std::vector<Facet<Dim>> listed = facets_in<Dim>(mesh).vertices;
  for (Facet<Dim>& facet : listed) std::sort(facet.begin(), facet.end());
  std::sort(listed.begin(), listed.end());
  double sum = 0;
  for (const Facet<Dim>& facet : boundary_facets<Dim>(mesh))
    if (!std::binary_search(listed.begin(), listed.end(), facet))
      sum += facet_measure<Dim>(mesh, facet);
  return sum;
}

/// Says what differs by more than is allowed, with as many digits as show it.
void compare(const std::string& what, double now, double expected, double allowed,
             std::vector<std::string>& faults) {
  if (std::abs(now - expected) <= allowed) return;
  std::ostringstream text;
  text.precision(17);
  text << what << now << ", expected " << expected;
  text.precision(3);
  text << " up to " << allowed;
  faults.push_back(text.str());
}

/// By how much anything may differ, and how much more for each unit of a boundary that may move.
struct Allowance {
  double always, surface_tolerance;
};

template <int Dim>
void compare_regions(const AnyMesh& before, const Measures& old, Measures& now,
                     const Allowance& allowance, std::vector<std::string>& faults) {
  const bool is_domain = old.regions.size() == 1 && now.regions.size() == 1 &&
                         old.regions.begin()->first == now.regions.begin()->first;
  if (is_domain) return;
  std::map<std::int32_t, double> boundary_of;
  if (allowance.surface_tolerance > 0) boundary_of = boundary_measures<Dim>(before);
  std::map<std::int32_t, double> expected = old.regions;
  for (const auto& [reference, value] : now.regions) expected.try_emplace(reference, 0.0);
  for (const auto& [reference, value] : expected) {
    const std::string what = "elements of reference " + std::to_string(reference);
    if (value > 0 && !(now.regions[reference] > 0))
      faults.push_back(what + " are gone");
    else
      compare(what + " measure ", now.regions[reference], value,
              allowance.always + allowance.surface_tolerance * boundary_of[reference], faults);
  }
}

template <int Dim>
void compare_facets(const AnyMesh& before, const Measures& old, Measures& now, double allowed,
                    std::vector<std::string>& faults) {
  for (auto [reference, value] : old.facets) {
    // What was not listed may be by now, see MakeMeshOptions::complete_boundary.
    if (reference == 0 && std::abs(now.facets[0] - value) > allowed)
      value += unlisted_measure<Dim>(before);
    compare("facets of reference " + std::to_string(reference) + " measure ", now.facets[reference],
            value, allowed, faults);
  }
}

/// The facets, each once: of those that are listed again the first counts, as make_mesh has it.
template <int Dim>
std::map<std::int32_t, double> measures_listed_once(const AnyMesh& mesh) {
  const auto& facets = facets_in<Dim>(mesh);
  std::vector<std::pair<Facet<Dim>, std::size_t>> by_corners;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    by_corners.emplace_back(facets.vertices[f], f);
    std::sort(by_corners.back().first.begin(), by_corners.back().first.end());
  }
  std::sort(by_corners.begin(), by_corners.end());
  std::map<std::int32_t, double> sum_of;
  for (std::size_t i = 0; i < by_corners.size(); ++i)
    if (i == 0 || by_corners[i].first != by_corners[i - 1].first)
      sum_of[facets.reference[by_corners[i].second]] +=
          facet_measure<Dim>(mesh, by_corners[i].first);
  return sum_of;
}

void expect_facets(const Measures& old, Measures& now, std::vector<std::string>& faults) {
  for (const auto& [reference, value] : old.facets)
    if (!(now.facets[reference] > 0))
      faults.push_back("facets of reference " + std::to_string(reference) + " are gone");
}

/// Curves along which the boundary met itself before may be shorter now, or end elsewhere by
/// rounding; those that bend may be longer.
template <int Dim>
void compare_pinches(const AnyMesh& before, const AnyMesh& after, double surface_tolerance,
                     std::vector<std::string>& faults) {
  const double now = pinched_length<Dim>(after, listed_facets_at_pinches<Dim>(after));
  if (now == 0) return;
  const double expected = pinched_length<Dim>(before, boundary_facets<Dim>(before));
  if (now <= expected * (surface_tolerance == 0 ? 1 + 1e-6 : 1.5)) return;
  std::ostringstream text;
  text << "the boundary meets itself " << (Dim == 2 ? "at vertices, " : "along edges, ") << now
       << " in all, expected " << expected;
  faults.push_back(text.str());
}

/// By how much facets measure more than the plane that they are in, if it is rough by a length.
template <int Dim>
double rough_measure(const AnyMesh& mesh, double roughness) {
  double sum = 0;
  for (const Facet<Dim>& facet : facets_in<Dim>(mesh).vertices) {
    const auto p = points<Dim>(mesh, facet);
    double longest = 0;
    for (std::size_t i = 0; i < Dim; ++i)
      longest = std::max(longest, norm(p[(i + 1) % Dim] - p[i]));
    const double measure = facet_measure<Dim>(mesh, facet);
    const double height = Dim == 2 ? measure : 2 * measure / longest;
    if (height > 0) sum += measure * std::min(1.0, std::pow(2 * roughness / height, 2));
  }
  return sum;
}

/// What is flat may be rough by a length.
template <int Dim>
std::vector<std::string> check(const AnyMesh& before, const AnyMesh& after,
                               double surface_tolerance, double roughness) {
  const Measures old = measures<Dim>(before);
  Measures now = measures<Dim>(after);
  const double domain = total(old.regions);
  // What was not listed before may be by now.
  const double boundary = std::max(total(old.facets), total(now.facets));
  const auto scale = scale_of<Dim>(before);
  const double slack = scale.slack + 2 * roughness;
  std::vector<std::string> faults;
  const double allowed = 1e-9 * domain + slack * boundary;
  compare("the domain measures ", total(now.regions), domain,
          allowed + surface_tolerance * boundary, faults);
  compare_regions<Dim>(before, old, now, {allowed, surface_tolerance}, faults);
  // The rim of a patch of facets: two points in 2D, in 3D a line about as long as the mesh.
  const double rim = Dim == 2 ? 2 : 4 * scale.extent;
  double rough = 0;
  if (roughness > 0)
    rough = rough_measure<Dim>(before, roughness) + rough_measure<Dim>(after, roughness);
  const auto faults_of_facets = [&](const Measures& expected) {
    std::vector<std::string> found;
    if (surface_tolerance == 0)
      compare_facets<Dim>(before, expected, now, 1e-9 * boundary + slack * rim + rough, found);
    else
      expect_facets(expected, now, found);
    return found;
  };
  auto found = faults_of_facets(old);
  if (!found.empty()) found = faults_of_facets({old.regions, measures_listed_once<Dim>(before)});
  faults.insert(faults.end(), found.begin(), found.end());
  compare_pinches<Dim>(before, after, surface_tolerance, faults);
  return faults;
}

/// What differs by more than usual is looked at again if the mesh was written with few digits.
template <int Dim>
std::vector<std::string> check(const AnyMesh& before, const AnyMesh& after,
                               double surface_tolerance) {
  auto faults = check<Dim>(before, after, surface_tolerance, 0);
  if (faults.empty()) return faults;
  const double rough = roughness<Dim>(before);
  return rough > 0 ? check<Dim>(before, after, surface_tolerance, rough) : faults;
}

}  // namespace

std::vector<std::string> check_domain(const AnyMesh& before, const AnyMesh& after,
                                      double surface_tolerance) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_coordinates(*mesh);
    expect_references(*mesh);
    expect_all_vertices(*mesh);
  }
  if (after.dimension != before.dimension)
    throw InputError(after.name + ": expected dimension " + std::to_string(before.dimension) +
                     ", that of " + before.name + ", found " + std::to_string(after.dimension));
  return before.dimension == 2 ? check<2>(before, after, surface_tolerance)
                               : check<3>(before, after, surface_tolerance);
}

}  // namespace ductile::meshadapt
