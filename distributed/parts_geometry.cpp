#include "distributed/parts_geometry.hpp"

#include <algorithm>
#include <utility>

#include "distributed/adapt_part.hpp"
#include "distributed/listed.hpp"
#include "distributed/migrate.hpp"

namespace ductile::distributed {

using runtime::Executor;

namespace {

/// Temporary label of unlabelled facets on the boundary or between regions.
constexpr std::int32_t unlabelled_boundary = unlabelled + 1;

/// The elements of a part that touch the boundary, interfaces between regions, or listed edges: all
/// that a Geometry reads.
template <int Dim>
class BoundaryLayer {
 public:
  /// The part must list its boundary.
  BoundaryLayer(const Communicator& comm, const Executor& executor, Part& part)
      : comm_(comm), part_(part), interfaces_(find_interfaces(comm, part)) {
    around_ = comm.on_all([&] { return elements_around<Dim>(executor, part.mesh); });
  }

  /// Removes the other elements, and facets that are only between parts. Collective.
  void keep() {
    mark_facets();
    mark_vertices();
    comm_.on_all([&] { drop_elements(); });
  }

 private:
  std::int32_t region_beside(const meshadapt::Facet<Dim>& facet) const {
    std::int32_t region = unlabelled;
    visit_beside<Dim>(part_.mesh, around_, facet, [&](std::uint32_t e) {
      region = meshadapt::elements_in<Dim>(part_.mesh).reference[e];
    });
    return region;
  }

  /// A shared facet is between regions if the other rank's element has a different reference.
  void mark_facets() {
    auto& facets = meshadapt::facets_in<Dim>(part_.mesh);
    PerRank<std::int32_t> to(static_cast<std::size_t>(comm_.size()));
    comm_.on_all([&] {
      for (const SharedFacet& shared : interfaces_.facets)
        to[static_cast<std::size_t>(shared.rank)].push_back(
            region_beside(facets.vertices[shared.facet]));
    });
    const auto beyond = comm_.exchange(to);
    comm_.on_all([&] {
      std::vector<std::uint8_t> is_inside(facets.size(), 0);
      std::vector<std::size_t> next(to.size(), 0);
      for (const SharedFacet& shared : interfaces_.facets) {
        const auto rank = static_cast<std::size_t>(shared.rank);
        const std::size_t k = next[rank]++;
        is_inside[shared.facet] = beyond.from(shared.rank)[k] == to[rank][k] ? 1 : 0;
      }
      for (std::size_t f = 0; f < facets.size(); ++f)
        if (facets.reference[f] == unlabelled && is_inside[f] == 0)
          facets.reference[f] = unlabelled_boundary;
      drop_unlabelled<Dim>(part_.mesh);
    });
  }

  void mark_vertices() {
    is_touched_.assign(part_.mesh.vertex_count(), 0);
    const auto touch = [&](const auto& cells) {
      for (const auto& corners : cells.vertices)
        for (const VertexId v : corners) is_touched_[v] = 1;
    };
    touch(meshadapt::facets_in<Dim>(part_.mesh));
    touch(part_.mesh.edges);
    std::vector<std::uint8_t> of_shared;
    for (const SharedVertex& shared : interfaces_.vertices)
      of_shared.push_back(is_touched_[shared.vertex]);
    visit_at_vertices(comm_, interfaces_, of_shared,
                      [&](std::size_t i, int, const std::uint8_t* is_touched) {
                        is_touched_[interfaces_.vertices[i].vertex] |= *is_touched;
                      });
  }

  void drop_elements() {
    const auto all = std::exchange(meshadapt::elements_in<Dim>(part_.mesh), {});
    for (std::size_t e = 0; e < all.size(); ++e)
      if (std::any_of(all.vertices[e].begin(), all.vertices[e].end(),
                      [&](VertexId v) { return is_touched_[v] != 0; }))
        meshadapt::elements_in<Dim>(part_.mesh).add(all.vertices[e], all.reference[e]);
  }

  const Communicator& comm_;
  Part& part_;
  const Interfaces interfaces_;
  meshadapt::VertexElements around_;
  std::vector<std::uint8_t> is_touched_;  // [vertex]
};

/// On each rank, the elements of all parts that make the Geometry.
template <int Dim>
Part gathered(const Communicator& comm, const Executor& executor, Part part) {
  BoundaryLayer<Dim>(comm, executor, part).keep();
  Part whole = gather_everywhere(comm, executor, part);
  auto& references = meshadapt::facets_in<Dim>(whole.mesh).reference;
  std::replace(references.begin(), references.end(), unlabelled_boundary, unlabelled);
  return whole;
}

}  // namespace

std::shared_ptr<const meshadapt::Geometry> geometry_of_parts(
    const Communicator& comm, const Executor& executor, const Part& part,
    const meshadapt::MakeMeshOptions& make) {
  Part whole = comm.on_all([&] {
    Part own = part;
    list_boundary(executor, own);
    return own;
  });
  if (comm.size() > 1)
    whole = part.mesh.dimension == 2 ? gathered<2>(comm, executor, std::move(whole))
                                     : gathered<3>(comm, executor, std::move(whole));
  return comm.on_all([&] {
    for (VertexId v = 0; v < whole.mesh.vertex_count(); ++v)
      if (whole.mesh.vertex_reference[v] != unlabelled) whole.mesh.required_vertices.push_back(v);
    return std::make_shared<const meshadapt::Geometry>(
        executor, whole.mesh,
        meshadapt::GeometryOptions{.tolerance = make.hausdorff_tolerance,
                                   .ridge_angle = make.ridge_angle,
                                   .functions = make.functions,
                                   .in_parts = true});
  });
}

bool bounds_curved_sizes(const meshadapt::AdaptOptions& options) {
  return options.make.hausdorff_tolerance > 0 && (options.gradation > 0 || options.curved_sizes);
}

double growth_of(const meshadapt::AdaptOptions& options) {
  constexpr double from_curves = 1.3;
  if (options.curved_sizes && options.gradation == 0) return from_curves;
  return options.gradation > 0 ? options.gradation : 0;
}

}  // namespace ductile::distributed
