/// @file
/// MovingMesh<Dim>: a mesh on its way, and how it changes when a part of it is adapted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/quality.hpp"
#include "ductile/meshadapt/any_mesh.hpp"

namespace ductile::meshadapt {

template <int Dim>
struct MovingMesh {
  AnyMesh any;                         // all but coordinates, which are in site_of
  std::vector<Site<Dim>> site_of;      // [vertex]
  std::vector<Vector<Dim>> start_of;   // [vertex], the place of the input that it was at
  std::vector<Vector<Dim>> speed_of;   // [vertex], of the last step
  std::vector<std::uint32_t> path_of;  // [vertex], see Paths; or none
  std::vector<std::uint8_t> is_rigid;  // [element], moves with a rigid body
  std::vector<std::uint8_t> is_held;   // [element], may not change: rigid or required
  std::vector<double> quality_of;      // [element]
  std::vector<double> made_with;       // [element], quality at first, or when it was made
  std::vector<double> came_with;       // [element], quality at first; 1 if it was not there
};

/// The quality of an element with these corners.
template <int Dim>
double quality_at(const std::vector<Site<Dim>>& site_of, const Corners<Dim>& corners) {
  std::array<const Site<Dim>*, Dim + 1> sites;
  for (std::size_t i = 0; i <= Dim; ++i) sites[i] = &site_of[corners[i]];
  return quality<Dim>(sites);
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
