/// @file
/// The checks that the boundary of a mesh does not cross itself, and that a mesh is connected
/// wherever its facets meet: no vertex hangs, none is doubled.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "checks/problems.hpp"
#include "core/first_bad.hpp"
#include "ductile/meshadapt/check_mesh.hpp"
#include "ductile/runtime/arrays.hpp"
#include "geometry/crossing_facets.hpp"
#include "mesh/array_lengths.hpp"
#include "mesh/distance.hpp"
#include "mesh/indices.hpp"

namespace ductile::meshadapt {

namespace {

template <int Dim>
std::vector<std::string> crossings_in(const runtime::Executor& executor, const AnyMesh& mesh) {
  const CrossingFacets<Dim> crossing(executor, mesh);
  Problems problems(executor);
  problems.expect_none(
      crossing.size(), [&](std::size_t f) { return crossing.partner_of(f) != no_index; },
      [&](std::size_t f) {
        return entity(facet_name<Dim>(), f) + " crosses " +
               entity(facet_name<Dim>(), crossing.partner_of(f));
      });
  return problems.take();
}

/// The other vertex, or else the facet, that a vertex lies on without being connected to it.
struct LooseContact {
  std::size_t vertex = no_index, facet = no_index;
};

template <int Dim>
class LooseVertices {
 public:
  LooseVertices(const runtime::Executor& executor, const AnyMesh& mesh)
      : mesh_(mesh),
        slack_(scale_of<Dim>(mesh).slack),
        index_(executor, facets_in<Dim>(mesh).size(),
               [&](std::size_t f) { return box_around(points(f)); }) {
    for (const auto& corners : facets_in<Dim>(mesh).vertices)
      vertices_.insert(vertices_.end(), corners.begin(), corners.end());
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  const std::vector<std::uint32_t>& vertices() const { return vertices_; }

  /// The first other vertex at the place of v, or the first facet that v lies on.
  LooseContact contact_of(std::uint32_t v) const {
    const auto at = position_in<Dim>(mesh_, v);
    LooseContact contact;
    index_.each_meeting(grown(Box<Dim>{at, at}, slack_), [&](std::size_t f) {
      const auto& corners = facets_in<Dim>(mesh_).vertices[f];
      if (std::find(corners.begin(), corners.end(), v) != corners.end()) return;
      for (const std::uint32_t corner : corners)
        if (norm(position_in<Dim>(mesh_, corner) - at) <= slack_)
          contact.vertex = std::min(contact.vertex, std::size_t{corner});
      if (norm(closest_point(points(f), at) - at) <= slack_)
        contact.facet = std::min(contact.facet, f);
    });
    return contact;
  }

 private:
  std::array<Vector<Dim>, Dim> points(std::size_t f) const {
    return points_in<Dim>(mesh_, facets_in<Dim>(mesh_).vertices[f]);
  }

  const AnyMesh& mesh_;
  double slack_;
  BoxHierarchy<Dim> index_;
  std::vector<std::uint32_t> vertices_;  // of facets, each once
};

template <int Dim>
std::vector<std::string> loose_in(const runtime::Executor& executor, const AnyMesh& mesh) {
  const LooseVertices<Dim> loose(executor, mesh);
  const auto& vertices = loose.vertices();
  auto contact_of = runtime::make_vector<LooseContact>(executor, vertices.size());
  runtime::parallel_for(executor, vertices.size(),
                        [&](std::size_t i) { contact_of[i] = loose.contact_of(vertices[i]); });
  Problems problems(executor);
  problems.expect_none(
      vertices.size(),
      [&](std::size_t i) {
        return contact_of[i].vertex == no_index && contact_of[i].facet != no_index;
      },
      [&](std::size_t i) {
        return entity("vertex", vertices[i]) + " hangs: it lies on " +
               entity(facet_name<Dim>(), contact_of[i].facet) + " and is no corner of it";
      });
  problems.expect_none(
      vertices.size(),
      [&](std::size_t i) {
        return contact_of[i].vertex != no_index && contact_of[i].vertex < vertices[i];
      },
      [&](std::size_t i) {
        return entity("vertex", vertices[i]) + " is at the place of vertex " +
               std::to_string(contact_of[i].vertex + 1);
      });
  return problems.take();
}

void expect_facets(const AnyMesh& mesh) {
  expect_coordinates(mesh);
  if (mesh.dimension == 2)
    expect_vertices(mesh, mesh.edges, "edges.vertices", "edge");
  else
    expect_vertices(mesh, mesh.triangles, "triangles.vertices", "triangle");
}

}  // namespace

std::vector<std::string> check_boundary(const runtime::Executor& executor, const AnyMesh& mesh) {
  expect_facets(mesh);
  return mesh.dimension == 2 ? crossings_in<2>(executor, mesh) : crossings_in<3>(executor, mesh);
}

std::vector<std::string> check_conformity(const runtime::Executor& executor, const AnyMesh& mesh) {
  expect_facets(mesh);
  return mesh.dimension == 2 ? loose_in<2>(executor, mesh) : loose_in<3>(executor, mesh);
}

}  // namespace ductile::meshadapt
