#include "move/paths.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "ductile/meshadapt/error.hpp"
#include "ductile/runtime/disjoint_sets.hpp"
#include "ductile/runtime/parallel_for.hpp"
#include "mesh/box.hpp"

namespace ductile::meshadapt {

using runtime::DisjointSets;
using runtime::Executor;
using runtime::parallel_for;

namespace {

/// The mesh follows up to this far from a body's box, in units of the box's longest side, and this
/// many times the body's longest edge.
constexpr double reach = 1, reach_in_edges = 4;
/// A displacement is rigid if it differs from a rigid motion by less than this share of itself.
constexpr double rigid_tolerance = 1e-3;

/// Marks the vertices of cells with these references, and the cells in `in`. Throws unless each
/// reference has a cell.
template <int N>
void choose(std::vector<std::uint8_t>& chosen, std::vector<std::uint8_t>& in, const Cells<N>& cells,
            const std::vector<std::int32_t>& references, const std::string& expected) {
  for (const std::int32_t reference : references) {
    bool found = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells.reference[i] != reference) continue;
      found = true;
      in[i] = 1;
      for (const VertexId v : cells.vertices[i]) chosen[v] = 1;
    }
    if (!found)
      throw InputError(expected + ", found " + std::to_string(reference) + ", which none has");
  }
}

}  // namespace

template <int Dim>
Paths<Dim>::Paths(const Executor& executor, const AnyMesh& mesh, const FixedMesh<Dim>& topology,
                  const std::vector<Vector<Dim>>& displacement_of, const MoveOptions& options)
    : path_of_(mesh.vertex_count(), none), in_body_(topology.element_count(), 0) {
  const bool is_named = !options.bodies.empty() || !options.boundaries.empty();
  const std::vector<std::uint8_t> chosen =
      is_named ? choose_named(mesh, options)
               : choose_displaced(executor, mesh, topology, displacement_of);
  for (std::size_t v = 0; v < chosen.size(); ++v)
    if (chosen[v]) {
      path_of_[v] = static_cast<std::uint32_t>(start_.size());
      start_.push_back(topology.position_of[v]);
      end_.push_back(start_.back() + displacement_of[v]);
    }
  rest_.resize(start_.size());
  body_of_.resize(start_.size());
  connect(executor, mesh, topology, chosen);
  for (Body& body : bodies_) fit(body);
}

template <int Dim>
std::vector<std::uint8_t> Paths<Dim>::choose_named(const AnyMesh& mesh,
                                                   const MoveOptions& options) {
  std::vector<std::uint8_t> chosen(mesh.vertex_count(), 0), facets(facets_in<Dim>(mesh).size());
  choose(chosen, in_body_, elements_in<Dim>(mesh), options.bodies,
         "bodies: expected references of elements");
  choose(chosen, facets, facets_in<Dim>(mesh), options.boundaries,
         std::string("boundaries: expected references of ") + (Dim == 2 ? "edges" : "triangles"));
  return chosen;
}

template <int Dim>
std::vector<std::uint8_t> Paths<Dim>::choose_displaced(
    const Executor& executor, const AnyMesh& mesh, const FixedMesh<Dim>& topology,
    const std::vector<Vector<Dim>>& displacement_of) {
  const auto& reference_of = elements_in<Dim>(mesh).reference;
  DisjointSets regions(executor, topology.element_count());
  parallel_for(executor, topology.element_count(), [&](std::size_t e) {
    for (const ElementId other : topology.neighbour_of[e])
      if (other != none && reference_of[other] == reference_of[e])
        regions.unite(static_cast<std::uint32_t>(e), other);
  });
  struct Region {
    bool has_inside = false, moves_inside = false, stays = false;
  };
  std::vector<Region> region_of(topology.element_count());  // [lowest element]
  std::vector<std::uint8_t> chosen(mesh.vertex_count(), 0);
  for (std::size_t v = 0; v < chosen.size(); ++v) {
    const auto around = topology.elements_of(static_cast<VertexId>(v));
    chosen[v] = dot(displacement_of[v], displacement_of[v]) > 0;
    bool inside = !topology.on_boundary[v];
    for (const ElementId e : around) inside = inside && regions.are_together(e, around[0]);
    for (const ElementId e : around) {
      Region& region = region_of[regions.lowest(e)];
      region.stays = region.stays || !chosen[v];
      region.has_inside = region.has_inside || inside;
      region.moves_inside = region.moves_inside || (inside && chosen[v]);
    }
  }
  for (std::size_t e = 0; e < in_body_.size(); ++e) {
    const Region& region = region_of[regions.lowest(static_cast<std::uint32_t>(e))];
    in_body_[e] = region.has_inside ? region.moves_inside : !region.stays;
    if (in_body_[e])
      for (const VertexId v : topology.corners_of[e]) chosen[v] = 1;
  }
  return chosen;
}

/// Numbers connected vertices: corners of an element of a body, or of a chosen facet.
template <int Dim>
void Paths<Dim>::connect(const Executor& executor, const AnyMesh& mesh,
                         const FixedMesh<Dim>& topology, const std::vector<std::uint8_t>& chosen) {
  DisjointSets sets(executor, mesh.vertex_count());
  parallel_for(executor, in_body_.size(), [&](std::size_t e) {
    if (!in_body_[e]) return;
    for (const VertexId v : topology.corners_of[e]) sets.unite(topology.corners_of[e][0], v);
  });
  for (const Facet<Dim>& facet : facets_in<Dim>(mesh).vertices)
    if (std::ranges::all_of(facet, [&](VertexId v) { return chosen[v] != 0; }))
      for (const VertexId v : facet) sets.unite(facet[0], v);
  std::vector<std::uint32_t> body_at(mesh.vertex_count(), none);  // [lowest vertex]
  for (std::size_t v = 0; v < chosen.size(); ++v) {
    if (path_of_[v] == none) continue;
    std::uint32_t& number = body_at[sets.lowest(static_cast<std::uint32_t>(v))];
    if (number == none) {
      number = static_cast<std::uint32_t>(bodies_.size());
      bodies_.emplace_back();
    }
    Body& body = bodies_[number];
    body.paths.push_back(path_of_[v]);
    body_of_[path_of_[v]] = number;
    for (const ElementId e : topology.elements_of(static_cast<VertexId>(v)))
      for (const VertexId w : topology.corners_of[e])
        body.margin = std::max(
            body.margin, reach_in_edges * norm(topology.position_of[w] - topology.position_of[v]));
  }
}

template <int Dim>
std::vector<std::uint8_t> Paths<Dim>::rigid_elements(const FixedMesh<Dim>& topology) const {
  std::vector<std::uint8_t> marks = in_body_;
  for (std::size_t e = 0; e < marks.size(); ++e)
    if (marks[e]) marks[e] = bodies_[body_of_[path_of_[topology.corners_of[e][0]]]].is_rigid;
  return marks;
}

template <int Dim>
void Paths<Dim>::fit(Body& body) {
  std::vector<Vector<Dim>> from, to;
  double largest = 0, error = 0;
  for (const std::uint32_t p : body.paths) {
    from.push_back(start_[p]);
    to.push_back(end_[p]);
    largest = std::max(largest, norm(end_[p] - start_[p]));
  }
  body.moves = largest > 0;
  body.motion = closest_motion(from, to);
  for (const std::uint32_t p : body.paths) {
    rest_[p] = end_[p] - body.motion.moved(start_[p], 1);
    error = std::max(error, norm(rest_[p]));
  }
  body.is_rigid = !body.moves || error < rigid_tolerance * largest;
}

template <int Dim>
Vector<Dim> Paths<Dim>::at(std::uint32_t path, double share) const {
  const Body& body = bodies_[body_of_[path]];
  if (!body.moves || share == 0) return start_[path];
  if (share == 1) return end_[path];
  if (!body.is_rigid) return start_[path] + share * (end_[path] - start_[path]);
  return body.motion.moved(start_[path], share) + share * rest_[path];
}

template <int Dim>
std::optional<Rotation<Dim>> Paths<Dim>::rotation(std::uint32_t path, double share,
                                                  double next) const {
  const Body& body = bodies_[body_of_[path]];
  if (!body.is_rigid) return std::nullopt;
  return body.moves ? body.motion.part(next - share) : Rotation<Dim>{};
}

template <int Dim>
double Paths<Dim>::first_stride() const {
  double turn = std::numbers::pi / 4;
  for (const Body& body : bodies_)
    if (body.is_rigid && body.moves) turn = std::max(turn, std::abs(body.motion.rotation.angle));
  return std::numbers::pi / 4 / turn;
}

template <int Dim>
std::vector<std::uint8_t> Paths<Dim>::within_reach(const Executor& executor,
                                                   const std::vector<Vector<Dim>>& position_of,
                                                   double share, double next) const {
  std::vector<Box<Dim>> boxes;
  for (const Body& body : bodies_) {
    if (!body.moves) continue;
    auto box = Box<Dim>::empty();
    for (const std::uint32_t p : body.paths)
      box = join(box, box_around(std::array{at(p, share), at(p, next)}));
    double side = 0;
    for (int i = 0; i < Dim; ++i) side = std::max(side, box.high[i] - box.low[i]);
    boxes.push_back(grown(box, reach * side + body.margin));
  }
  std::vector<std::uint8_t> near(position_of.size());
  parallel_for(executor, position_of.size(), [&](std::size_t v) {
    const Box<Dim> here{position_of[v], position_of[v]};
    near[v] = std::ranges::any_of(boxes, [&](const Box<Dim>& box) { return meet(box, here); });
  });
  return near;
}

template class Paths<2>;
template class Paths<3>;

}  // namespace ductile::meshadapt
