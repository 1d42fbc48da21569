#include "mesh/topology.hpp"

#include <algorithm>
#include <set>
#include <span>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/boundary_surface.hpp"

namespace ductile::meshadapt {

namespace {

using runtime::Executor;
using Regions = std::span<const std::uint32_t>;  // [element]; empty: a single region

std::vector<std::int32_t> references_of(const std::vector<std::int32_t>& reference_of) {
  std::set<std::int32_t> found;
  for (std::size_t e = 0; e < reference_of.size(); ++e)
    if (e == 0 || reference_of[e] != reference_of[e - 1]) found.insert(reference_of[e]);
  return {found.begin(), found.end()};
}

/// Counts the connected parts of elements by shared vertices of their region; none of a surface.
template <int Dim>
void count_parts(const AdjacentMesh& mesh, Regions region_of,
                 std::vector<RegionTopology>& regions) {
  const auto count = static_cast<ElementId>(elements_in<Dim>(mesh.mesh()).size());
  if (count == 0) return;
  const VertexElements& lists = mesh.lists<Dim>();
  const auto region = [&](ElementId e) { return region_of.empty() ? 0 : region_of[e]; };
  runtime::DisjointSets parts(mesh.executor(), count);
  runtime::parallel_for(mesh.executor(), mesh.mesh().vertex_count(), [&](std::size_t v) {
    std::vector<ElementId> first_of_each;  // region around the vertex
    for (const ElementId e : lists.elements_of(static_cast<VertexId>(v))) {
      const auto first = std::ranges::find(first_of_each, region(e), region);
      if (first == first_of_each.end())
        first_of_each.push_back(e);
      else
        parts.unite(*first, e);
    }
  });
  for (ElementId e = 0; e < count; ++e) regions[region(e)].parts += parts.lowest(e) == e;
}

template <int Dim>
void count_boundary(BoundarySurface<Dim> surface, std::vector<RegionTopology>& regions) {
  for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
    RegionTopology& region = regions[surface.region_of_vertex(v)];
    ++region.euler;
    region.boundary_parts += surface.part_of_vertex(v) == v;
  }
  for (std::size_t s = 0; s < surface.size(); ++s) {
    RegionTopology& region = regions[surface.side(s).region];
    region.euler += Dim == 2 ? -1 : 1;
    region.euler_of_sheets += Dim == 2 ? -1 : 1;
    region.sheets += surface.sheet_of_side(s) == s;
    for (std::size_t c = Dim * s; c < Dim * (s + 1); ++c)
      region.euler_of_sheets += surface.fan_of_corner(c) == c;
  }
  if constexpr (Dim == 3)
    surface.each_meeting([&](std::span<const BoundaryJoint> joints) {
      RegionTopology& region = regions[joints[0].region];
      --region.euler;
      region.euler_of_sheets -= joints.size() == 2 ? 1 : static_cast<std::int64_t>(joints.size());
    });
}

template <int Dim>
void count(const AdjacentMesh& mesh, Regions region_of, std::vector<RegionTopology>& regions) {
  const Executor& executor = mesh.executor();
  count_parts<Dim>(mesh, region_of, regions);
  count_boundary<Dim>({executor, sides_in<Dim>(mesh, region_of)}, regions);
}

/// Describes the number that differs.
std::string difference(const RegionTopology& now, const RegionTopology& expected) {
  const auto says = [](const char* what, auto is, auto was) {
    return std::string(what) + std::to_string(is) + ", expected " + std::to_string(was);
  };
  if (now.parts != expected.parts)
    return says(": the number of parts is ", now.parts, expected.parts);
  if (now.boundary_parts != expected.boundary_parts)
    return says(": the number of parts of the boundary is ", now.boundary_parts,
                expected.boundary_parts);
  if (now.euler != expected.euler)
    return says(": the Euler characteristic of the boundary is ", now.euler, expected.euler);
  if (now.sheets != expected.sheets)
    return says(": the boundary, cut up where it meets itself, has a number of parts of ",
                now.sheets, expected.sheets);
  return says(": the boundary, cut up where it meets itself, has an Euler characteristic of ",
              now.euler_of_sheets, expected.euler_of_sheets);
}

/// Ignores references that are gone, which another check reports.
std::vector<std::string> differences(const std::vector<RegionTopology>& expected,
                                     const std::vector<RegionTopology>& now) {
  std::vector<std::string> faults;
  for (const RegionTopology& old : expected) {
    const auto at = std::find_if(now.begin(), now.end(), [&](const RegionTopology& region) {
      return region.reference == old.reference;
    });
    if (at == now.end() || *at == old) continue;
    const std::string what =
        old.reference ? "elements of reference " + std::to_string(*old.reference) : "the domain";
    faults.push_back(what + difference(*at, old));
  }
  return faults;
}

/// The topology of all elements and, if there are several references, of those of each.
template <int Dim>
std::vector<RegionTopology> topology_of(const AdjacentMesh& mesh) {
  const Executor& executor = mesh.executor();
  std::vector<RegionTopology> all(1);
  count<Dim>(mesh, {}, all);
  const auto& reference_of = is_surface(mesh.mesh()) ? mesh.mesh().triangles.reference
                                                     : elements_in<Dim>(mesh.mesh()).reference;
  const std::vector<std::int32_t> references = references_of(reference_of);
  if (references.size() < 2) return all;
  auto region_of = runtime::make_unset_vector<std::uint32_t>(executor, reference_of.size());
  runtime::parallel_for(executor, region_of.size(), [&](std::size_t e) {
    region_of[e] = static_cast<std::uint32_t>(
        std::lower_bound(references.begin(), references.end(), reference_of[e]) -
        references.begin());
  });
  std::vector<RegionTopology> regions(references.size());
  for (std::size_t r = 0; r < regions.size(); ++r) regions[r].reference = references[r];
  count<Dim>(mesh, region_of, regions);
  all.insert(all.end(), regions.begin(), regions.end());
  return all;
}

}  // namespace

std::vector<std::string> topology_faults(const AdjacentMesh& before, const AdjacentMesh& after) {
  return after.mesh().dimension == 2 ? differences(topology_of<2>(before), topology_of<2>(after))
                                     : differences(topology_of<3>(before), topology_of<3>(after));
}

}  // namespace ductile::meshadapt
