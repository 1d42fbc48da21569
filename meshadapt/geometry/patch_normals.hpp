/// @file
/// PatchNormals: the normals of smooth patches at their vertices, and which of their facets are
/// flat for good.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/runtime/arrays.hpp"
#include "geometry/curve_tangents.hpp"
#include "geometry/facet_sides.hpp"
#include "geometry/smooth_model.hpp"

namespace ductile::meshadapt {

class PatchNormals {
 public:
  PatchNormals(const runtime::Executor& executor, const ModelInput<3>& input,
               const CurveTangents<3>& curves);

  /// The edge of a curve that the side of a facet across from a corner is, or no_edge.
  std::uint32_t edge_at(std::size_t facet, std::size_t opposite) const {
    return edge_at_[facet][opposite];
  }
  /// Is a side that is on no curve straight?
  bool is_straight(std::size_t facet, std::size_t opposite) const {
    return straight_[facet][opposite] != 0;
  }
  bool is_flat(std::size_t facet) const { return flat_[facet] != 0; }

  /// At a facet's corner, of unit length, to either side of the facet; 0 if the patch has none.
  const Vector<3>& normal(std::size_t facet, std::size_t corner) const {
    return normal_of_[node_of_[facet][corner]];
  }

  /// Each vertex of a smooth patch. Where the normal is turned by more than 8 degrees against the
  /// mean of the facets there it is that of needles, and the mean counts.
  Samples<3, 3> samples() const;

 private:
  using Node = std::uint32_t;
  using Triple = std::array<std::uint32_t, 3>;
  /// A point close to a node, and how much it counts.
  struct Neighbour {
    Vector<3> offset;
    double weight;
  };
  struct NodeFacet {
    std::uint64_t key;  // patch, then point
    std::uint32_t facet;
    auto operator<=>(const NodeFacet&) const = default;
  };

  void find_edges();
  void find_nodes();
  void find_flat();
  void keep_flat(std::span<const FacetSide> both, std::vector<std::uint8_t>& planes) const;
  void find_straight();
  bool is_crease(std::span<const FacetSide> both) const;
  void find_rims();
  std::span<const NodeFacet> facets_at(Node node) const;
  const Vector<3>& place(Node node) const {
    return input_.points[static_cast<std::uint32_t>(node_facets_[first_of_[node]].key)];
  }
  Vector<3> facet_normal_of(std::uint32_t facet) const;
  Vector<3> mean_normal(Node node) const;
  Vector<3> normal_at(Node node) const;
  std::vector<Neighbour> around(Node node) const;
  Vector<3> along_rims(Node node, const Vector<3>& normal) const;

  const runtime::Executor& executor_;
  const ModelInput<3>& input_;
  const CurveTangents<3>& curves_;
  FacetSides<3> sides_;
  std::vector<Triple> edge_at_;  // [facet][side]
  std::vector<std::array<std::uint8_t, 3>> straight_;
  std::vector<std::uint8_t> flat_;               // [facet]
  runtime::UnsetVector<NodeFacet> node_facets_;  // sorted
  std::vector<std::uint32_t> first_of_;          // [node], among node_facets_; and their number
  std::vector<Triple> node_of_;                  // [facet][corner]
  std::vector<std::uint8_t> creased_;  // [node], it has an edge at which its patch is sharp
  std::vector<std::pair<Node, std::pair<std::uint32_t, std::uint32_t>>> rims_;  // sorted
  std::vector<Vector<3>> normal_of_;                                            // [node]
};

}  // namespace ductile::meshadapt
