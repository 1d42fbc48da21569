#include "mesh/topology.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <utility>

#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "ductile/runtime/sort.hpp"
#include "ductile/runtime/worklist.hpp"
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

/// Connected parts of elements by shared vertices of their region. A vertex represents itself in
/// its region of lowest number; for its other regions, numbers are added.
template <int Dim>
class Parts {
 public:
  Parts(const Executor& executor, const AnyMesh& mesh, Regions region_of)
      : elements_(elements_in<Dim>(mesh).vertices),
        region_of_(region_of),
        lowest_(runtime::make_filled<std::uint32_t>(executor, mesh.vertex_count(), none)),
        sets_(executor, 0) {
    runtime::parallel_for(executor, elements_.size(), [&](std::size_t e) {
      for (const VertexId v : elements_[e]) runtime::atomic_min(lowest_[v], region(e));
    });
    if (!region_of.empty()) find_others(executor);
    sets_ = runtime::DisjointSets(executor, lowest_.size() + others_.size());
    runtime::parallel_for(executor, elements_.size(), [&](std::size_t e) {
      const std::uint32_t first = number_of(elements_[e][0], e);
      for (std::size_t i = 1; i <= Dim; ++i) sets_.unite(first, number_of(elements_[e][i], e));
    });
  }

  void count(std::vector<RegionTopology>& regions) {
    for (std::uint32_t v = 0; v < lowest_.size(); ++v)
      if (lowest_[v] != none && sets_.lowest(v) == v) ++regions[lowest_[v]].parts;
    for (std::size_t i = 0; i < others_.size(); ++i) {
      const auto number = static_cast<std::uint32_t>(lowest_.size() + i);
      if (sets_.lowest(number) == number) ++regions[static_cast<std::uint32_t>(others_[i])].parts;
    }
  }

 private:
  using Other = std::uint64_t;  // a vertex, in the upper half, and a region

  std::uint32_t region(std::size_t e) const { return region_of_.empty() ? 0 : region_of_[e]; }

  void find_others(const Executor& executor) {
    auto all = runtime::parallel_collect<Other>(executor, elements_.size(),
                                                [&](std::size_t e, auto&& append) {
                                                  for (const VertexId v : elements_[e])
                                                    if (lowest_[v] != region(e))
                                                      append(Other{v} << 32U | region(e));
                                                });
    runtime::parallel_sort(executor, std::span(all));
    all.erase(std::unique(all.begin(), all.end()), all.end());
    others_ = std::move(all);
  }

  std::uint32_t number_of(VertexId v, std::size_t e) const {
    if (lowest_[v] == region(e)) return v;
    const auto at = std::lower_bound(others_.begin(), others_.end(), Other{v} << 32U | region(e));
    return static_cast<std::uint32_t>(lowest_.size() +
                                      static_cast<std::size_t>(at - others_.begin()));
  }

  const std::vector<Corners<Dim>>& elements_;
  Regions region_of_;
  runtime::UnsetVector<std::uint32_t> lowest_;  // [vertex], region; none: no element
  runtime::UnsetVector<Other> others_;          // sorted
  runtime::DisjointSets sets_;
};

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
  Parts<Dim>(executor, mesh.mesh(), region_of).count(regions);
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
