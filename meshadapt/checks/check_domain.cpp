#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "checks/faults.hpp"
#include "core/determinant.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "geometry/rounding.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/boundary_surface.hpp"
#include "mesh/indices.hpp"
#include "mesh/scale.hpp"
#include "mesh/sorted_cells.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

namespace {

/// Sums measure_of(i) by reference. A run of equal references is summed before it is added.
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

template <int Dim>
double facet_measure(const AnyMesh& mesh, const Facet<Dim>& facet) {
  return norm(facet_normal(points_in<Dim>(mesh, facet))) / (Dim == 2 ? 1 : 2);
}

/// Measures of the elements and of the listed facets, by reference.
struct Measures {
  std::map<std::int32_t, double> regions, facets;
};

template <int Dim>
Measures measures(const AnyMesh& mesh) {
  const auto& elements = elements_in<Dim>(mesh);
  const auto& facets = facets_in<Dim>(mesh);
  return {sums(elements.reference,
               [&](std::size_t e) {
                 const auto corners = points_in<Dim>(mesh, elements.vertices[e]);
                 return std::abs(plain_determinant(corners)) / (Dim == 2 ? 2 : 6);
               }),
          sums(facets.reference,
               [&](std::size_t f) { return facet_measure<Dim>(mesh, facets.vertices[f]); })};
}

/// Measure of each region's boundary by reference, including interfaces to other regions.
template <int Dim>
std::map<std::int32_t, double> boundary_measures(const AdjacentMesh& mesh) {
  const auto& reference_of = elements_in<Dim>(mesh.mesh()).reference;
  const std::vector<std::uint32_t> region_of(reference_of.begin(), reference_of.end());
  std::map<std::int32_t, double> sum_of;
  for (const BoundarySide<Dim>& side :
       sides_of<Dim>(mesh.executor(), mesh.adjacency<Dim>(), region_of))
    sum_of[static_cast<std::int32_t>(side.region)] += facet_measure<Dim>(mesh.mesh(), side.corners);
  return sum_of;
}

/// Measure of the boundary facets that are not listed.
template <int Dim>
double unlisted_measure(const AdjacentMesh& mesh) {
  const auto listed = sorted_cells(mesh.executor(), facets_in<Dim>(mesh.mesh()).vertices);
  double sum = 0;
  for (const BoundarySide<Dim>& side : sides_of<Dim>(mesh.executor(), mesh.adjacency<Dim>()))
    if (find_cell<Dim>(listed, side.corners) == none)
      sum += facet_measure<Dim>(mesh.mesh(), side.corners);
  return sum;
}

/// Reports a difference that exceeds the allowed one, with enough digits to show it.
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

/// Measures of the facets by reference; a facet listed repeatedly counts once, by its first
/// reference, as in make_mesh.
template <int Dim>
std::map<std::int32_t, double> measures_listed_once(const Executor& executor, const AnyMesh& mesh) {
  const auto& facets = facets_in<Dim>(mesh);
  const auto by_corners = sorted_cells(executor, facets.vertices);
  std::map<std::int32_t, double> sum_of;
  for (std::size_t i = 0; i < by_corners.size(); ++i)
    if (i == 0 || by_corners[i].first != by_corners[i - 1].first)
      sum_of[facets.reference[by_corners[i].second]] +=
          facet_measure<Dim>(mesh, by_corners[i].first);
  return sum_of;
}

/// Excess of the facets' measure over that of their plane if vertices are off it by the roughness.
template <int Dim>
double rough_measure(const AnyMesh& mesh, double roughness) {
  double sum = 0;
  for (const Facet<Dim>& facet : facets_in<Dim>(mesh).vertices) {
    const auto p = points_in<Dim>(mesh, facet);
    double longest = 0;
    for (std::size_t i = 0; i < Dim; ++i)
      longest = std::max(longest, norm(p[(i + 1) % Dim] - p[i]));
    const double measure = facet_measure<Dim>(mesh, facet);
    const double height = Dim == 2 ? measure : 2 * measure / longest;
    if (height > 0) sum += measure * std::min(1.0, std::pow(2 * roughness / height, 2));
  }
  return sum;
}

/// Total length of non-manifold edges, on which more than two boundary facets meet (2D: the number
/// of such vertices). Each counts once per pair of facets beyond the first.
template <int Dim>
double non_manifold_length(const AdjacentMesh& mesh) {
  const BoundarySurface<Dim> surface(mesh.executor(), sides_in<Dim>(mesh));
  double sum = 0;
  surface.each_meeting([&](std::span<const BoundaryJoint> joints) {
    if (joints.size() < 3) return;
    double length = 1;
    if constexpr (Dim == 3)
      length = norm(position_in<3>(mesh.mesh(), joints[0].key & 0xffffffffU) -
                    position_in<3>(mesh.mesh(), joints[0].key >> 32U));
    sum += length * (static_cast<double>(joints.size()) / 2 - 1);
  });
  return sum;
}

template <int Dim>
class DomainChecker {
 public:
  DomainChecker(const AdjacentMesh& before, const AdjacentMesh& after, double hausdorff_tolerance)
      : adjacent_before_(before),
        adjacent_after_(after),
        before_(before.mesh()),
        after_(after.mesh()),
        hausdorff_tolerance_(hausdorff_tolerance),
        old_(measures<Dim>(before_)),
        now_(measures<Dim>(after_)) {}

  /// Checks with the usual tolerances; if that fails and the mesh was written with few digits,
  /// checks again with tolerances that allow for them.
  std::vector<std::string> run() {
    auto faults = faults_if_rough(0);
    if (faults.empty()) return faults;
    const double rough = roughness<Dim>(before_);
    return rough > 0 ? faults_if_rough(rough) : faults;
  }

 private:
  /// Returns the differences if flat parts may be rough by this length.
  std::vector<std::string> faults_if_rough(double roughness) {
    const double domain = total(old_.regions);
    // The larger total counts, because facets not listed before may be listed now.
    const double boundary = std::max(total(old_.facets), total(now_.facets));
    const auto scale = scale_of<Dim>(before_);
    const double slack = scale.slack + 2 * roughness;
    std::vector<std::string> faults;
    const double allowed = 1e-9 * domain + slack * boundary;
    compare("the domain measures ", total(now_.regions), domain,
            allowed + hausdorff_tolerance_ * boundary, faults);
    compare_regions(allowed, faults);
    // Length of the rim of a patch of facets: two points in 2D, a line about as long as the mesh in
    // 3D.
    const double rim = Dim == 2 ? 2 : 4 * scale.extent;
    double rough = 0;
    if (roughness > 0)
      rough = rough_measure<Dim>(before_, roughness) + rough_measure<Dim>(after_, roughness);
    const double of_facets = 1e-9 * boundary + slack * rim + rough;
    auto found = faults_of_facets(old_.facets, of_facets);
    if (!found.empty())
      found = faults_of_facets(measures_listed_once<Dim>(adjacent_before_.executor(), before_),
                               of_facets);
    faults.insert(faults.end(), found.begin(), found.end());
    compare_non_manifold(faults);
    return faults;
  }

  void compare_regions(double allowed, std::vector<std::string>& faults) {
    const bool is_domain = old_.regions.size() == 1 && now_.regions.size() == 1 &&
                           old_.regions.begin()->first == now_.regions.begin()->first;
    if (is_domain) return;
    std::map<std::int32_t, double> boundary_of;
    if (hausdorff_tolerance_ > 0) boundary_of = boundary_measures<Dim>(adjacent_before_);
    std::map<std::int32_t, double> expected = old_.regions;
    for (const auto& [reference, value] : now_.regions) expected.try_emplace(reference, 0.0);
    for (const auto& [reference, value] : expected) {
      const std::string what = "elements of reference " + std::to_string(reference);
      if (value > 0 && !(now_.regions[reference] > 0))
        faults.push_back(what + " are gone");
      else
        compare(what + " measure ", now_.regions[reference], value,
                allowed + hausdorff_tolerance_ * boundary_of[reference], faults);
    }
  }

  /// Facets of each reference must exist if the boundary may move, and otherwise have the same
  /// measure.
  std::vector<std::string> faults_of_facets(const std::map<std::int32_t, double>& expected,
                                            double allowed) {
    std::vector<std::string> faults;
    for (auto [reference, value] : expected) {
      const std::string what = "facets of reference " + std::to_string(reference);
      if (hausdorff_tolerance_ > 0) {
        if (!(now_.facets[reference] > 0)) faults.push_back(what + " are gone");
        continue;
      }
      // Facets that were not listed may be listed now, see MakeMeshOptions::complete_boundary.
      if (reference == 0 && std::abs(now_.facets[0] - value) > allowed)
        value += unlisted_measure<Dim>(adjacent_before_);
      compare(what + " measure ", now_.facets[reference], value, allowed, faults);
    }
    return faults;
  }

  /// Reports non-manifold edges that have become longer than rounding explains. They may become
  /// shorter, and curved ones somewhat longer.
  void compare_non_manifold(std::vector<std::string>& faults) const {
    const double now = non_manifold_length<Dim>(adjacent_after_);
    if (now == 0) return;
    const double expected = non_manifold_length<Dim>(adjacent_before_);
    if (now <= expected * (hausdorff_tolerance_ == 0 ? 1 + 1e-6 : 1.5)) return;
    std::ostringstream text;
    text << "the boundary meets itself " << (Dim == 2 ? "at vertices, " : "along edges, ") << now
         << " in all, expected " << expected;
    faults.push_back(text.str());
  }

  const AdjacentMesh& adjacent_before_;
  const AdjacentMesh& adjacent_after_;
  const AnyMesh& before_;
  const AnyMesh& after_;
  double hausdorff_tolerance_;
  Measures old_, now_;
};

}  // namespace

void expect_comparable(const AnyMesh& before, const AnyMesh& after) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_coordinates(*mesh);
    expect_references(*mesh);
    expect_all_vertices(*mesh);
  }
  if (after.dimension != before.dimension)
    throw InputError(after.name + ": expected dimension " + std::to_string(before.dimension) +
                     ", that of " + before.name + ", found " + std::to_string(after.dimension));
}

std::vector<std::string> domain_faults(const AdjacentMesh& before, const AdjacentMesh& after,
                                       double hausdorff_tolerance) {
  expect_comparable(before.mesh(), after.mesh());
  if (after.mesh().dimension == 2)
    return DomainChecker<2>(before, after, hausdorff_tolerance).run();
  return DomainChecker<3>(before, after, hausdorff_tolerance).run();
}

std::vector<std::string> check_domain(const Executor& executor, const AnyMesh& before,
                                      const AnyMesh& after, double hausdorff_tolerance) {
  return domain_faults({executor, before}, {executor, after}, hausdorff_tolerance);
}

}  // namespace ductile::meshadapt
