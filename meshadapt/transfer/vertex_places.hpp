/// @file
/// VertexPlaces: the places of the vertices of a new mesh in the old one, each on its own side
/// of a closed crack. A vertex at the position of an old one is that vertex; among several, the one
/// whose elements point in the direction of its own. Others are found by walking to them from
/// inside one of their own elements.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <span>
#include <utility>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/runtime/arrays.hpp"
#include "ductile/runtime/atomic.hpp"
#include "ductile/runtime/sort.hpp"
#include "mesh/distance.hpp"
#include "transfer/evaluate.hpp"
#include "transfer/locator.hpp"

namespace ductile::meshadapt {

template <int Dim, int Space = Dim>
class VertexPlaces {
 public:
  /// Refers to the locator of the old mesh, and to the new mesh.
  VertexPlaces(const runtime::Executor& executor, const Locator<Dim, Space>& locator,
               const AnyMesh& mesh)
      : executor_(executor),
        locator_(locator),
        old_mesh_(locator.mesh()),
        mesh_(mesh),
        element_at_(runtime::make_filled<ElementId>(executor, mesh.vertex_count(), none)),
        origin_of_(mesh.vertex_count()) {
    find_elements();
    find_origins();
  }

  /// Finds the place of vertex v, starting from old element `near`. Thread safety: any thread.
  Place<Dim> find(VertexId v, ElementId near) const {
    const VertexId origin = origin_of_[v];
    if (origin == none) return locator_.find(position_in<Space>(mesh_, v), start_for(v, near));
    Place<Dim> place{old_mesh_.elements_of(origin)[0], {}, true};
    const int corner = corner_of(old_mesh_.corners_of[place.element], origin);
    place.weight[static_cast<std::size_t>(corner)] = 1;
    return place;
  }

  /// [vertex of the new mesh] The old vertex at the same position, or none. Ends the use of this
  /// object.
  std::vector<VertexId> take_origins() { return std::move(origin_of_); }

 private:
  /// A vertex of the old mesh, ordered by position.
  struct Spot {
    Vector<Space> position;
    VertexId vertex = none;
    friend auto operator<=>(const Spot& a, const Spot& b) {
      if (const auto order = a.position.x <=> b.position.x; order != 0) return order;
      return std::partial_ordering(a.vertex <=> b.vertex);
    }
  };

  /// Finds an element for each vertex of the new mesh.
  void find_elements() {
    const auto& elements = elements_in<Dim>(mesh_).vertices;
    runtime::parallel_for(executor_, elements.size(), [&](std::size_t e) {
      for (const VertexId v : elements[e])
        runtime::atomic_min(element_at_[v], static_cast<ElementId>(e));
    });
  }

  /// A point inside the new mesh near the vertex.
  Vector<Space> inside_near(VertexId v) const {
    if (element_at_[v] == none) return position_in<Space>(mesh_, v);
    Vector<Space> centre;
    for (const VertexId corner : elements_in<Dim>(mesh_).vertices[element_at_[v]])
      centre += (1.0 / (Dim + 1)) * position_in<Space>(mesh_, corner);
    return centre;
  }

  ElementId start_for(VertexId v, ElementId near) const {
    return locator_.find(inside_near(v), Dim < Space ? none : near).element;
  }

  // ---- Vertices, by their positions ----

  void find_origins() {
    std::vector<Spot> spots(old_mesh_.vertex_count());
    runtime::parallel_for(executor_, spots.size(), [&](std::size_t v) {
      spots[v] = {old_mesh_.position_of[v], static_cast<VertexId>(v)};
    });
    std::erase_if(spots,
                  [&](const Spot& spot) { return old_mesh_.elements_of(spot.vertex).empty(); });
    runtime::parallel_sort(executor_, std::span(spots));
    runtime::parallel_for(executor_, mesh_.vertex_count(), [&](std::size_t v) {
      const Vector<Space> position = position_in<Space>(mesh_, v);
      const auto begin = std::lower_bound(spots.begin(), spots.end(), Spot{position, 0});
      const auto end = std::upper_bound(begin, spots.end(), Spot{position, none});
      origin_of_[v] = same_side({begin, end}, static_cast<VertexId>(v));
    });
  }

  /// Among vertices at one position, the one whose elements point in the direction of v's.
  VertexId same_side(std::span<const Spot> spots, VertexId v) const {
    if (spots.empty()) return none;
    if (spots.size() == 1) return spots[0].vertex;
    const Vector<Space> inside = inside_near(v);
    VertexId best = none;
    double best_depth = 0;
    for (const Spot& spot : spots)
      for (const ElementId e : old_mesh_.elements_of(spot.vertex))
        if (const double depth = depth_in_cone(e, spot.vertex, inside);
            best == none || depth > best_depth) {
          best = spot.vertex;
          best_depth = depth;
        }
    return best;
  }

  /// How far a point is inside the infinite cone of an element at one corner: above 0 inside, at
  /// any distance from that corner. On a surface: the less below 0, the closer to the triangle.
  double depth_in_cone(ElementId element, VertexId apex, const Vector<Space>& point) const {
    if constexpr (Dim < Space)
      return -norm(closest_point(old_mesh_.points(element), point) - point);
    const Weights<Dim> weight = barycentric<Dim>(old_mesh_.points(element), point);
    double lowest = 1, sum = 0;
    for (std::size_t i = 0; i <= Dim; ++i) {
      if (old_mesh_.corners_of[element][i] == apex) continue;
      lowest = std::min(lowest, weight[i]);
      sum += std::abs(weight[i]);
    }
    return sum > 0 ? lowest / sum : 0;
  }

  const runtime::Executor& executor_;
  const Locator<Dim, Space>& locator_;
  const FixedMesh<Dim, Space>& old_mesh_;
  const AnyMesh& mesh_;
  runtime::UnsetVector<ElementId> element_at_;  // [vertex], an element around it, or none
  std::vector<VertexId> origin_of_;             // [vertex]
};

/// Evaluates a field at the vertices of another mesh.
template <int Dim, int Space>
Evaluated evaluate_at_vertices(const runtime::Executor& executor,
                               const Locator<Dim, Space>& locator, const Components& field,
                               const AnyMesh& mesh) {
  const VertexPlaces<Dim, Space> places(executor, locator, mesh);
  return evaluate_each(
      executor, locator, field, mesh.vertex_count(),
      [&](std::size_t v, ElementId near) { return places.find(static_cast<VertexId>(v), near); });
}

}  // namespace ductile::meshadapt
