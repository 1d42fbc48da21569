/// @file
/// Star: what 3D swapping reads around one vertex.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "operators/cavity.hpp"

namespace ductile::meshadapt {

/// The edges from a vertex to neighbours with a higher number, and what is around each of them,
/// read once for all swaps that are looked for from here. Which neighbours are higher and which are
/// new is a matter of chance, so neither is a branch.
class Star {
 public:
  static constexpr std::size_t most_around = 8;   // places of more elements are not kept
  static constexpr std::size_t most_edges = 384;  // more are left alone

  struct Edge {
    VertexId to;
    std::uint32_t count;  // of elements around it
    float worst_quality;
    std::uint16_t worst;  // of those elements, the first; as in Around
    bool changed;         // is one of them
    /// Exclusive or of the elements' other corners: 0 if each is in two of them, that is, inside.
    VertexId ends;
  };
  /// Places in the vertex's list of elements.
  using Around = std::array<std::uint16_t, most_around>;

  /// Elements that changed after this epoch count as changed.
  Star(const Mesh<3>& mesh, VertexId vertex, std::uint32_t after) {
    const auto ball = mesh.elements_of.of(vertex);
    if (ball.size() > Mesh<3>::largest_ball) return;
    edges_[0] = no_edge;
    std::array<Element, Mesh<3>::largest_ball> elements;
    std::array<Higher, 3 * Mesh<3>::largest_ball + 1> higher;
    std::size_t count = 0;
    for (std::size_t i = 0; i < ball.size(); ++i) {
      const ElementId e = ball[i];
      VertexId others = vertex;
      for (const VertexId v : mesh.corners_of[e]) {
        others ^= v;
        higher[count] = {v, static_cast<std::uint16_t>(i)};
        count += v > vertex;
      }
      elements[i] = {mesh.quality_of[e], others, mesh.changed_at[e] > after};
    }
    for (std::size_t k = 0; k < count; ++k) note(higher[k], elements[higher[k].element]);
  }

  std::size_t size() const { return size_; }
  const Edge& edge(std::size_t i) const { return edges_[i]; }
  const Around& around(std::size_t i) const { return around_[i]; }

 private:
  static constexpr Edge no_edge{none, 0, std::numeric_limits<float>::infinity(), 0, false, 0};

  struct Element {
    float quality;
    VertexId others;  // exclusive or of the corners other than the vertex
    bool changed;
  };
  struct Higher {
    VertexId to;
    std::uint16_t element;
  };

  void note(const Higher& higher, const Element& element) {
    const auto [to, place] = higher;
    std::size_t at = (to * 2654435761U) >> 23U;
    while (number_[at] != 0 && edges_[number_[at] - 1U].to != to) at = (at + 1) % number_.size();
    const bool fresh = number_[at] == 0;
    if (fresh && size_ == most_edges) return;
    const std::size_t i = fresh ? size_ : number_[at] - 1U;
    number_[at] = static_cast<std::uint16_t>(i + 1);
    Edge& edge = edges_[i];
    edge.to = to;
    around_[i][edge.count % most_around] = place;
    ++edge.count;
    edge.worst = element.quality < edge.worst_quality ? place : edge.worst;
    edge.worst_quality = std::min(edge.worst_quality, element.quality);
    edge.changed = edge.changed || element.changed;
    edge.ends ^= element.others ^ to;
    size_ += fresh;
    edges_[size_] = no_edge;
  }

  std::size_t size_ = 0;
  std::array<Edge, most_edges + 1> edges_;  // the one after the last is no_edge
  std::array<Around, most_edges> around_;
  std::array<std::uint16_t, 512> number_{};  // 1 + that of the edge, by a hash of its end; or 0
};

}  // namespace ductile::meshadapt
