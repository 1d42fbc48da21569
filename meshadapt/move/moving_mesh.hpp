/// @file
/// MovingMesh<Dim>: a mesh on its way, and how it changes when a part of it is adapted.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/quality.hpp"
#include "ductile/meshadapt/adapt.hpp"
#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/fixed_mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct MovingMesh {
  AnyMesh any;                         // all but coordinates, which are in site_of
  std::vector<Site<Dim>> site_of;      // [vertex]
  std::vector<Vector<Dim>> speed_of;   // [vertex], of the last step
  std::vector<std::uint32_t> path_of;  // [vertex], see Paths; or none
  std::vector<std::uint32_t> body_of;  // [element], see Paths; or 0
  std::vector<std::uint8_t> is_held;   // [element], may not change: rigid or required
  std::vector<double> quality_of;      // [element]
  std::vector<double> made_with;       // [element], quality at first, or when it was made
  std::vector<double> came_with;       // [element], quality at first; 1 if it was not there

  double quality(const Corners<Dim>& corners) const {
    std::array<const Site<Dim>*, Dim + 1> sites;
    for (std::size_t i = 0; i <= Dim; ++i) sites[i] = &site_of[corners[i]];
    return meshadapt::quality<Dim>(sites);
  }
};

/// Position and metric of a vertex of an adapted mesh.
template <int Dim>
Site<Dim> site_in(const AdaptedMesh& adapted, VertexId vertex) {
  Metric<Dim> metric;
  std::copy_n(&adapted.metric.values[vertex * metric.m.size()], metric.m.size(), metric.m.begin());
  return make_site(position_in<Dim>(adapted.mesh, vertex), metric);
}

/// For each entity of a mesh of which a part was adapted: the one before that it is, or the one of
/// the adapted part; the other is none.
struct Renewal {
  std::vector<std::uint32_t> old_of, part_of;

  std::size_t size() const { return old_of.size(); }
  void add_old(std::uint32_t old) {
    old_of.push_back(old);
    part_of.push_back(none);
  }
  void add_part(std::uint32_t part) {
    old_of.push_back(none);
    part_of.push_back(part);
  }
};

/// Values of entities: old ones, and make(entity of the part) for those of the part.
template <class Value>
void renew(std::vector<Value>& values, const Renewal& renewal, auto&& make) {
  std::vector<Value> renewed(renewal.size());
  for (std::size_t i = 0; i < renewed.size(); ++i)
    renewed[i] = renewal.old_of[i] != none ? values[renewal.old_of[i]] : make(renewal.part_of[i]);
  values = std::move(renewed);
}

}  // namespace ductile::meshadapt
