/// @file
/// ElementsAround: the elements around each vertex of a mesh, in the order of their numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ductile/meshadapt/any_mesh.hpp"
#include "ductile/meshadapt/simplex.hpp"

namespace ductile::petsc {

/// Refers to the mesh.
template <int Dim>
class ElementsAround {
 public:
  explicit ElementsAround(const meshadapt::AnyMesh& mesh)
      : elements_(meshadapt::elements_in<Dim>(mesh).vertices), first_(mesh.vertex_count() + 1, 0) {
    for (const auto& corners : elements_)
      for (const meshadapt::VertexId v : corners) ++first_[v + 1];
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) first_[v + 1] += first_[v];
    around_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t e = 0; e < elements_.size(); ++e)
      for (const meshadapt::VertexId v : elements_[e]) around_[next[v]++] = e;
  }

  std::span<const std::uint32_t> of(meshadapt::VertexId v) const {
    return std::span(around_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

  /// Calls visit(element) for those that have all corners of a facet.
  void visit_beside(const meshadapt::Facet<Dim>& facet, auto&& visit) const {
    for (const std::uint32_t e : of(facet[0])) {
      const auto is_there = [&](meshadapt::VertexId v) {
        return meshadapt::contains(elements_[e], v);
      };
      if (std::all_of(facet.begin(), facet.end(), is_there)) visit(e);
    }
  }

 private:
  const std::vector<meshadapt::Corners<Dim>>& elements_;
  std::vector<std::uint32_t> first_;  // [vertex], into around_, and the end
  std::vector<std::uint32_t> around_;
};

}  // namespace ductile::petsc
