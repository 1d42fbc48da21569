/// @file
/// MshCells: collects the elements of a Gmsh file of any version. References are made from their
/// groups when all are known.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "msh_groups.hpp"
#include "number_reader.hpp"
#include "spatial_mesh.hpp"

namespace ductile::meshadapt {

/// Finds the place of a number in a list, because files number nodes and elements freely. It takes
/// memory in proportion to the list.
class NumberIndex {
 public:
  static constexpr std::size_t none = ~std::size_t{0};

  NumberIndex() = default;
  explicit NumberIndex(const std::vector<std::uint64_t>& numbers);

  /// The place of the number, or none. Thread safety: any thread.
  std::size_t find(std::uint64_t number) const;
  /// The place of a number that is in the list twice, or none.
  std::size_t repeated() const { return repeated_; }

 private:
  std::uint64_t first_ = 0;
  bool is_dense_ = true;
  std::size_t repeated_ = none;
  std::vector<std::size_t> place_of_;                          ///< [number - first_], if dense
  std::vector<std::pair<std::uint64_t, std::size_t>> sorted_;  ///< otherwise
};

/// The shape of Gmsh's elements of a type; throws InputError unless it is a point, line, triangle
/// or tetrahedron of first order. 1 to 4 corners.
int msh_corners(const NumberReader& in, std::int64_t type);

/// The groups and the entity of an element, or of a block of elements.
struct MshGroup {
  GroupSet physical;            ///< groups; none is as 0
  std::int32_t elementary = 0;  ///< entity of the geometry
};

class MshCells {
 public:
  /// `index_of` finds the nodes of the mesh, which have reference 0 so far.
  MshCells(const NumberReader& in, SpatialMesh& to, const NumberIndex& index_of)
      : in_(in), to_(to), index_of_(index_of) {}

  /// `nodes` are numbers of `corners` nodes.
  void add(std::uint64_t number, int corners, const std::uint64_t* nodes, const MshGroup& group);
  /// Call it after the last element. It gives references, sorts elements, which files list by
  /// entities, by their numbers, and joins elements that version 2 lists once for each group.
  void finish();
  /// The numbers of the tetrahedra or, if there are none, the triangles.
  const std::vector<std::uint64_t>& numbers() const {
    return numbers_[4].empty() ? numbers_[3] : numbers_[4];
  }

 private:
  std::uint32_t vertex(std::uint64_t node) const;
  template <int Corners>
  void append(Cells<Corners>& cells, const std::uint64_t* nodes, const MshGroup& group);
  void finish(int dimension, std::vector<std::int32_t>& reference);
  /// Keeps the cells at these places, in this order.
  template <int Corners>
  void select(Cells<Corners>& cells, const std::vector<std::size_t>& places);
  template <int Corners>
  void drop_repeated(Cells<Corners>& cells);
  template <int Corners>
  void put_in_order(Cells<Corners>& cells);

  const NumberReader& in_;
  SpatialMesh& to_;
  const NumberIndex& index_of_;
  // [corners][cell of that shape]
  std::array<std::vector<std::uint64_t>, 5> numbers_;  ///< as the file has them
  std::array<std::vector<std::int32_t>, 5> elementary_of_;
  std::array<GroupReferences, 5> groups_;  ///< cells have numbers of sets as references meanwhile
  std::array<bool, 5> repeated_{};         ///< whether an entity is in several sets of groups
  std::array<std::map<std::int32_t, std::int32_t>, 5> set_of_;  ///< [elementary] the first
};

}  // namespace ductile::meshadapt
