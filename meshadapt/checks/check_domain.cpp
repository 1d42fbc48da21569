#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/meshadapt/error.hpp"
#include "ductile/meshadapt/simplex.hpp"
#include "ductile/meshadapt/vector.hpp"
#include "geometry/roughness.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/boundary_surface.hpp"
#include "mesh/indices.hpp"
#include "mesh/scale.hpp"

namespace ductile::meshadapt {

using runtime::Executor;

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

/// Of each region, by reference, interfaces to others included.
template <int Dim>
std::map<std::int32_t, double> boundary_measures(const Executor& executor, const AnyMesh& mesh) {
  const auto& reference_of = elements_in<Dim>(mesh).reference;
  const std::vector<std::uint32_t> region_of(reference_of.begin(), reference_of.end());
  std::map<std::int32_t, double> sum_of;
  for (const BoundarySide<Dim>& side :
       sides_of<Dim>(executor, mesh, BoundaryFrom::elements, region_of))
    sum_of[static_cast<std::int32_t>(side.region)] += facet_measure<Dim>(mesh, side.corners);
  return sum_of;
}

/// Of the boundary that is not listed.
template <int Dim>
double unlisted_measure(const Executor& executor, const AnyMesh& mesh) {
  std::vector<Facet<Dim>> listed = facets_in<Dim>(mesh).vertices;
  for (Facet<Dim>& facet : listed) std::sort(facet.begin(), facet.end());
  std::sort(listed.begin(), listed.end());
  double sum = 0;
  for (const BoundarySide<Dim>& side : sides_of<Dim>(executor, mesh, BoundaryFrom::elements))
    if (!std::binary_search(listed.begin(), listed.end(), side.corners))
      sum += facet_measure<Dim>(mesh, side.corners);
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

/// How long the non-manifold edges are, where more than two facets of the boundary meet, in 2D how
/// many such vertices there are; each as often as there is a pair of facets too many.
template <int Dim>
double non_manifold_length(const Executor& executor, const AnyMesh& mesh, BoundaryFrom from) {
  const BoundarySurface<Dim> surface(executor, sides_of<Dim>(executor, mesh, from));
  double sum = 0;
  surface.each_meeting([&](std::span<const BoundaryJoint> joints) {
    if (joints.size() < 3) return;
    double length = 1;
    if constexpr (Dim == 3)
      length = norm(position_in<3>(mesh, joints[0].key & 0xffffffffU) -
                    position_in<3>(mesh, joints[0].key >> 32U));
    sum += length * (static_cast<double>(joints.size()) / 2 - 1);
  });
  return sum;
}

template <int Dim>
class DomainChecker {
 public:
  DomainChecker(const Executor& executor, const AnyMesh& before, const AnyMesh& after,
                double hausdorff_tolerance)
      : executor_(executor),
        before_(before),
        after_(after),
        hausdorff_tolerance_(hausdorff_tolerance),
        old_(measures<Dim>(before)),
        now_(measures<Dim>(after)) {}

  /// What differs by more than usual is looked at again if the mesh was written with few digits.
  std::vector<std::string> run() {
    auto faults = faults_if_rough(0);
    if (faults.empty()) return faults;
    const double rough = roughness<Dim>(before_);
    return rough > 0 ? faults_if_rough(rough) : faults;
  }

 private:
  /// What is flat may be rough by a length.
  std::vector<std::string> faults_if_rough(double roughness) {
    const double domain = total(old_.regions);
    // What was not listed before may be by now.
    const double boundary = std::max(total(old_.facets), total(now_.facets));
    const auto scale = scale_of<Dim>(before_);
    const double slack = scale.slack + 2 * roughness;
    std::vector<std::string> faults;
    const double allowed = 1e-9 * domain + slack * boundary;
    compare("the domain measures ", total(now_.regions), domain,
            allowed + hausdorff_tolerance_ * boundary, faults);
    compare_regions(allowed, faults);
    // The rim of a patch of facets: two points in 2D, in 3D a line about as long as the mesh.
    const double rim = Dim == 2 ? 2 : 4 * scale.extent;
    double rough = 0;
    if (roughness > 0)
      rough = rough_measure<Dim>(before_, roughness) + rough_measure<Dim>(after_, roughness);
    const double of_facets = 1e-9 * boundary + slack * rim + rough;
    auto found = faults_of_facets(old_.facets, of_facets);
    if (!found.empty()) found = faults_of_facets(measures_listed_once<Dim>(before_), of_facets);
    faults.insert(faults.end(), found.begin(), found.end());
    compare_non_manifold(faults);
    return faults;
  }

  void compare_regions(double allowed, std::vector<std::string>& faults) {
    const bool is_domain = old_.regions.size() == 1 && now_.regions.size() == 1 &&
                           old_.regions.begin()->first == now_.regions.begin()->first;
    if (is_domain) return;
    std::map<std::int32_t, double> boundary_of;
    if (hausdorff_tolerance_ > 0) boundary_of = boundary_measures<Dim>(executor_, before_);
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

  /// Those of a boundary that may move have to be there, the others to measure the same.
  std::vector<std::string> faults_of_facets(const std::map<std::int32_t, double>& expected,
                                            double allowed) {
    std::vector<std::string> faults;
    for (auto [reference, value] : expected) {
      const std::string what = "facets of reference " + std::to_string(reference);
      if (hausdorff_tolerance_ > 0) {
        if (!(now_.facets[reference] > 0)) faults.push_back(what + " are gone");
        continue;
      }
      // What was not listed may be by now, see MakeMeshOptions::complete_boundary.
      if (reference == 0 && std::abs(now_.facets[0] - value) > allowed)
        value += unlisted_measure<Dim>(executor_, before_);
      compare(what + " measure ", now_.facets[reference], value, allowed, faults);
    }
    return faults;
  }

  /// Curves along which the boundary met itself before may be shorter now, or end elsewhere by
  /// rounding; those that bend may be longer.
  void compare_non_manifold(std::vector<std::string>& faults) const {
    const double now = non_manifold_length<Dim>(executor_, after_, BoundaryFrom::listed_facets);
    if (now == 0) return;
    const double expected = non_manifold_length<Dim>(executor_, before_, BoundaryFrom::elements);
    if (now <= expected * (hausdorff_tolerance_ == 0 ? 1 + 1e-6 : 1.5)) return;
    std::ostringstream text;
    text << "the boundary meets itself " << (Dim == 2 ? "at vertices, " : "along edges, ") << now
         << " in all, expected " << expected;
    faults.push_back(text.str());
  }

  const Executor& executor_;
  const AnyMesh& before_;
  const AnyMesh& after_;
  double hausdorff_tolerance_;
  Measures old_, now_;
};

}  // namespace

std::vector<std::string> check_domain(const Executor& executor, const AnyMesh& before,
                                      const AnyMesh& after, double hausdorff_tolerance) {
  for (const AnyMesh* mesh : {&before, &after}) {
    expect_coordinates(*mesh);
    expect_references(*mesh);
    expect_all_vertices(*mesh);
  }
  if (after.dimension != before.dimension)
    throw InputError(after.name + ": expected dimension " + std::to_string(before.dimension) +
                     ", that of " + before.name + ", found " + std::to_string(after.dimension));
  if (before.dimension == 2)
    return DomainChecker<2>(executor, before, after, hausdorff_tolerance).run();
  return DomainChecker<3>(executor, before, after, hausdorff_tolerance).run();
}

}  // namespace ductile::meshadapt
